"""How a node takes part in a simulation: its map, its services, lockstep, and the channel of an examination."""
