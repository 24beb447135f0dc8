"""The node simulator: robots on a map, in real time or faster."""
