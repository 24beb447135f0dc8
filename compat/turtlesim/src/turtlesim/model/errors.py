"""The error of this package; its message says in one line what is wrong and what would be right."""

LONGEST = 300  # [characters] of a message


class TurtlesimError(Exception):
    """A request that this package cannot or will not fulfil."""

    def __init__(self, message: str) -> None:
        """Keep the message as one short line: it may hold names that other nodes sent."""
        line = ''.join(char if char.isprintable() else repr(char)[1:-1] for char in message[:LONGEST])
        super().__init__(line if len(message) <= LONGEST else f'{line}...')
