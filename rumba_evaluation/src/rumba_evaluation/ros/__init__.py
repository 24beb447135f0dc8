"""The ROS face of the evaluation: finds maps, reads bags, listens to missions."""
