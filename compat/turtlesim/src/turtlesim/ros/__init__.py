"""The nodes: the only place that imports rospy."""
