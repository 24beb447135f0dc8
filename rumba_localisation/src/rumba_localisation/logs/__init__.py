"""Logs of lasers and odometry, and how good a trajectory is."""
