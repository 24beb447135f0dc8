"""The node `page`: between the web server and ROS."""
