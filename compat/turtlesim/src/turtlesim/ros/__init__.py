"""The nodes, one module for each, and what they share; only modules of this folder import rospy."""
