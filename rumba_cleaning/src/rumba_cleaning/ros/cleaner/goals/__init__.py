"""What the cleaner is asked to do: its actions, their runs, and the floor on which they happen."""
