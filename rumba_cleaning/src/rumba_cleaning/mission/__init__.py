"""A whole mission: decides which behaviour the robot follows, and when it must return to the dock."""
