"""What all kinds of blows have in common."""

from typing import Callable, NamedTuple, Tuple


class Blow:
    """One blow of the schedule, and what it did so far.

    Attributes:
        number: its place in the schedule.
        kind: what kind it is.
        chance: a random generator that nobody else uses, so that the blow is the same whatever came before.
        asked: what was done, for a person; it grows while the blow is struck.
        inputs: hostile inputs so far.
        faults: faults so far.
        waits: how long others waited meanwhile, as `common.page_victim` tells.
    """

    def __init__(self, number, kind, chance):
        """Prepare a blow."""
        self.number, self.kind, self.chance = number, kind, chance
        self.asked, self.inputs, self.faults, self.waits = [], 0, 0, []

    def say(self, text, inputs=0, faults=0):
        """Note what is done, and how much it counts."""
        self.asked.append(text)
        self.inputs += inputs
        self.faults += faults

    def __str__(self):
        return f'{self.kind.name}: {"; ".join(self.asked) or "nothing yet"}'


class Kind(NamedTuple):
    """A kind of blow."""

    name: str
    strike: Callable  # of a ground, a random generator and a Blow, which it tells what it does
    scenarios: Tuple[str, ...]
    weight: int = 2  # how often it comes, compared with others


def some_member(ground, chance):
    """Any of the nodes."""
    return ground.members[chance.choice(sorted(ground.members))]
