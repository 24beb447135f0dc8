"""The ROS face of the model: the only place that imports rospy, one module a node."""
