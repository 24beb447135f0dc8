"""One robot as ROS sees it: its topics, services and frames, whatever moves it."""
