"""The error of this package; its message says in one line what is wrong and what would be right."""


class TurtlesimError(Exception):
    """A request that this package cannot or will not fulfil."""
