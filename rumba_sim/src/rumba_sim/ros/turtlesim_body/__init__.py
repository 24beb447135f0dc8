"""The node turtlesim_body: a turtle of turtlesim is the body of a robot."""
