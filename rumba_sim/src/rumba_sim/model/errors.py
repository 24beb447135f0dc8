"""What can go wrong, by name; each message says in one line what was wrong, where, and what would be right."""


class RumbaError(Exception):
    """Base of every error that this package raises on purpose."""


class ConfigError(RumbaError):
    """A setting is unknown, of the wrong type, or out of its range."""


class MapError(RumbaError):
    """A map cannot be read, or has no room for what was asked of it."""


class CommandError(RumbaError):
    """A command that no robot can follow."""


class WorldError(RumbaError):
    """The world cannot do what was asked of it: a name that is taken or unknown, a place that is not free."""


class StrategyError(RumbaError):
    """No cleaning strategy has this name, or two would."""
