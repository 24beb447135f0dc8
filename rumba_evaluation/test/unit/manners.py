"""Cleaning strategies for tests, each of which does one thing."""

import os

from rumba_cleaning.behaviour import STOP, Behaviour, Command
from rumba_cleaning.strategies import strategy


class Manner(Behaviour):
    """Gives one command without end."""

    COMMAND = STOP

    def __init__(self, context):
        self.seen = []

    def update(self, observation):
        self.seen.append(observation)
        self.message = 'at it'
        return self.COMMAND


@strategy('wait')
class Wait(Manner):
    """Stands still."""


@strategy('ahead')
class Ahead(Manner):
    """Goes straight on."""

    COMMAND = Command(0.3, 0.0)


@strategy('turn')
class Turn(Manner):
    """Turns on the spot, brushes up."""

    COMMAND = Command(0.0, -1.0, brushes_up=True)


@strategy('give_up')
class GiveUp(Manner):
    """Fails at once."""

    def update(self, observation):
        return self.fail('no,\nnever')


@strategy('crash')
class Crash(Manner):
    """Has a bug that shows after a second."""

    def update(self, observation):
        return 1 / 0 if len(self.seen) == 10 else super().update(observation)


@strategy('die')
class Die(Manner):
    """Takes its process along."""

    def update(self, observation):
        os._exit(1)
