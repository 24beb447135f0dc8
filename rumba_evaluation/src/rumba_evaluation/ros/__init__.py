"""What needs ROS: the nodes and commands of the evaluation."""
