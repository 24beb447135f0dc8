"""Turtles, their field and their pictures: plain Python and NumPy; the caller decides when time passes."""
