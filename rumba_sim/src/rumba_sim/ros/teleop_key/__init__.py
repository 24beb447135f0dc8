"""The node teleop_key: a person drives a robot from the keyboard of a terminal."""
