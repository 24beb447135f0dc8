"""The window: it listens to topics and draws what they say. Painting is a function from a snapshot to a picture."""
