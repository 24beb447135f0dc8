"""Finds out where a robot is, from its odometry and its laser, on a map."""
