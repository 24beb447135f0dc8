"""What there is to show at one moment, as plain values: neither ROS nor Qt."""
