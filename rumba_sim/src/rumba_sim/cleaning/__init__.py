"""What a Rumba does to clean a floor, in plain Python: no ROS, no wall clock."""
