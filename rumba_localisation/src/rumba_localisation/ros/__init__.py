"""The ROS face of the localisation: the only place in this package that imports rospy."""
