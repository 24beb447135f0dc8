"""Which blow comes when: blow N of a seed is always the same, whatever came before it."""

import random

from stress.blows import KINDS
from stress.blows.blow import Blow
from stress.scenarios import BROWSED, CRADLE, FLAT, LOCALISED, MAPPED, SCENARIOS, TURTLE

ROUND = 30  # blows on one ground, before a new one is made
ROUNDS = (FLAT, LOCALISED, TURTLE, CRADLE, FLAT, MAPPED, BROWSED)


def scenario(number, rounds=ROUNDS):
    """The nodes that blow `number` strikes."""
    return rounds[number // ROUND % len(rounds)]


def blow(seed, number, kinds=KINDS, rounds=ROUNDS):
    """Blow `number` of a seed."""
    fitting = [kind for kind in kinds if scenario(number, rounds).name in kind.scenarios]
    kind = dealt(fitting, random.Random(f'{seed} round {number // ROUND}'))[number % ROUND]
    return Blow(number, kind, random.Random(f'{seed} {number}'))


def dealt(kinds, chance):
    """The kinds of the blows of a round, in their order: each once, and more of those that weigh more."""
    more = chance.choices(kinds, [kind.weight for kind in kinds], k=max(ROUND - len(kinds), 0))
    deck = [*kinds, *more]
    chance.shuffle(deck)
    return deck[:ROUND]


def round_of(number):
    """Numbers of all blows that strike the same ground as blow `number`."""
    first = number // ROUND * ROUND
    return range(first, first + ROUND)


class OneGround:
    """The same for a run in which all rounds are on one ground."""

    def __init__(self, name):
        """Take the name of a scenario."""
        self._rounds = (SCENARIOS[name],)

    def scenario(self, number):
        """The nodes that blow `number` strikes."""
        return scenario(number, self._rounds)

    def blow(self, seed, number):
        """Blow `number` of a seed."""
        return blow(seed, number, rounds=self._rounds)
