"""What a map holds for a robot, and why parts of it are closed, before any mission."""
