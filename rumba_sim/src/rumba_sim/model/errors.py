"""Errors of this package; each message says in one line what is wrong, where, and what would be right."""


class RumbaError(Exception):
    """Base class of all errors that this package raises on purpose."""


class ConfigError(RumbaError):
    """A setting is unknown, of the wrong type, or out of its range."""


class MapError(RumbaError):
    """A map cannot be read, or a robot does not fit at a pose on it."""


class CommandError(RumbaError):
    """No robot can follow a command."""


class WorldError(RumbaError):
    """The world cannot do what was requested: a name is taken or unknown, or a position is not free."""


class StrategyError(RumbaError):
    """No cleaning strategy has this name, or more than one would have it."""
