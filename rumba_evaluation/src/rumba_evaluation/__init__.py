"""How well a robot cleans: trials, verdicts and reports; plain Python without ROS, but for the folder ros."""
