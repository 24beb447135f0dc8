"""How well a robot cleans: trials, verdicts and reports. Only the folder ros needs ROS."""
