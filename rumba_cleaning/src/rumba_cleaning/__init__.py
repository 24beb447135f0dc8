"""What a robot does to clean a floor: plain Python without ROS and without a clock, but for the folder ros."""
