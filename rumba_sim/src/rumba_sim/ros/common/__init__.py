"""What the nodes of all packages share: how a node runs, names, frames, maps, messages, the simulator's state."""
