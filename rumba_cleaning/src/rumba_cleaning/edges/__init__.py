"""Keeps the wheels of a robot on the floor: what it knows of edges, what a command leads to, and what it may do."""
