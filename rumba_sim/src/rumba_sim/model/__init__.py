"""The robot and its world in plain Python: no ROS, no wall clock, the caller owns time."""
