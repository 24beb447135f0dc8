"""The window: it listens to topics and draws what they contain."""
