"""What a robot that is not ours must and may have, and what may be wrong with it: without ROS."""
