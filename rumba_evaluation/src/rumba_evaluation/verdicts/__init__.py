"""What is asked of a mission, and whether it was met."""
