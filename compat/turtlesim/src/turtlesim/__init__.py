"""A stand-in for turtlesim: turtles that draw on a field, with or without a window."""
