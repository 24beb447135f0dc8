"""What a robot can do, from a turn on the spot to a whole mission."""
