"""The node viewer: what topics and the master tell, and what the window asks of the robot."""
