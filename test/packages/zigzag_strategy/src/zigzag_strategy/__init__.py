"""A cleaning strategy for Rumba."""
