"""The node console: a mission in the terminal."""
