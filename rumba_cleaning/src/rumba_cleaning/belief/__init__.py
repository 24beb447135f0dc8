"""What a robot knows of its place of work, and what it remembers of it."""
