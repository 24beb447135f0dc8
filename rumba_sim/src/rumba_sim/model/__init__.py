"""The robot and its world in plain Python: no ROS and no wall clock; the caller decides how much time passes."""
