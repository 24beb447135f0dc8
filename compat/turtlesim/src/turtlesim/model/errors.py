"""What can go wrong; the message says in one line what was wrong, and what would be right."""


class TurtlesimError(Exception):
    """Something that this package cannot do, or will not."""
