"""Lays out what cleans a region: rings along the walls, lanes, and what these leave."""
