"""What a robot knows of the floor that it works on, and what it remembers of it."""
