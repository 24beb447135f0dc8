"""Changes a route so that it meets the target in less time."""
