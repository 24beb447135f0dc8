"""What can go wrong, by name; each message says in one line what was wrong, where, and what would be right."""


class RumbaError(Exception):
    """Base of every error that this package raises on purpose."""


class ConfigError(RumbaError):
    """A setting is unknown, of the wrong type, or out of its range."""
