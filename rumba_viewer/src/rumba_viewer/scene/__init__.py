"""What the window shows at one moment, as plain values: neither ROS nor Qt."""
