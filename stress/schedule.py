"""Which blow comes when: blow N of a seed is always the same, whatever came before it."""

import random

from stress.blows import KINDS
from stress.blows.blow import Blow
from stress.scenarios import CRADLE, FLAT, TURTLE

ROUND = 30  # blows on one ground, before a new one is made
ROUNDS = (FLAT, TURTLE, FLAT, CRADLE)


def scenario(number):
    """The nodes that blow `number` strikes."""
    return ROUNDS[number // ROUND % len(ROUNDS)]


def blow(seed, number, kinds=KINDS):
    """Blow `number` of a seed."""
    chance = random.Random(f'{seed} {number}')
    fitting = [kind for kind in kinds if scenario(number).name in kind.scenarios]
    kind = chance.choices(fitting, [kind.weight for kind in fitting])[0]
    return Blow(number, kind, chance)


def round_of(number):
    """Numbers of all blows that strike the same ground as blow `number`."""
    first = number // ROUND * ROUND
    return range(first, first + ROUND)
