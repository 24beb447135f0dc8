"""The trial ground: real nodes under blows, and whether they bear them. `./rumba stress --help` tells how."""
