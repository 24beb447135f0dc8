"""Single things that a robot can do, from a turn on the spot to the way into the dock."""
