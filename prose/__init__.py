"""Checks the prose of this repository: `python3 -m prose`, a part of ./rumba lint."""
