"""The ROS face of the behaviours: the only place in this package that imports rospy."""
