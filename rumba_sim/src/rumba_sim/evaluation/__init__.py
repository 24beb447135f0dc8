"""How well missions go: whole missions in process, many of them, and what became of them; no ROS, no wall clock."""
