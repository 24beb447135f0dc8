"""How a node of any package runs: its start and end, the master, time, its connections and its terminal."""
