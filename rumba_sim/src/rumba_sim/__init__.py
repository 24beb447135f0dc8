"""A small, headless-first simulator of a Rumba, a Roomba for ROS 1."""
