"""Definitions of ROS 1 in ROS 2."""
