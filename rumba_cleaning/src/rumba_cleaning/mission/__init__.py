"""A whole mission: which behaviour comes when, and when the robot must go home."""
