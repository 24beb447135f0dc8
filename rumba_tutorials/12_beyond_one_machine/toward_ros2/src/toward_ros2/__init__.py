"""The way of definitions from ROS 1 to ROS 2."""
