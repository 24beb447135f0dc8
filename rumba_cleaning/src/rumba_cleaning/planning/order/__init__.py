"""Finds in which order to drive stretches, and the ways between them."""
