"""The node viewer: it listens to topics and the master, and calls services and actions of robots."""
