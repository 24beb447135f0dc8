"""The nodes: the only place that imports rospy, one module a node."""
