"""The page for browsers: rosbridge's protocol, who may do what, and a web server; without ROS."""
