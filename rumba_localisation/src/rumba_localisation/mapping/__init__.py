"""Simultaneous localisation and mapping: a robot makes the map by which it finds out where it is."""
