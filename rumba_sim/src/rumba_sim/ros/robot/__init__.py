"""One robot as ROS sees it: its topics, services and frames, and whose command it follows."""
