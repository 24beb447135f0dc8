"""What an oracle or a blow raises if something was lost, hangs, or ended as it must not."""


class Failure(Exception):
    """Something is wrong.

    Attributes:
        oracle: which question was answered wrongly, in one word.
        who: name of the node, or `world`.
        seen: what was seen, for a person.
    """

    def __init__(self, oracle, who, seen):
        super().__init__(f'{oracle}: {who}: {seen}')
        self.oracle, self.who, self.seen = oracle, who, seen

    @property
    def signature(self):
        """What two failures have in common if they are likely to be one fault."""
        return self.oracle, self.who
