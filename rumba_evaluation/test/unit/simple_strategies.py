"""Cleaning strategies for tests; each does one thing."""

import os
import sys

from rumba_cleaning.behaviour import STOP, Behaviour, Command
from rumba_cleaning.strategies import strategy


class Simple(Behaviour):
    """Gives one command without end, and records the observations."""

    COMMAND = STOP

    def __init__(self, context):
        self.seen = []

    def update(self, observation):
        self.seen.append(observation)
        self.message = 'working'
        return self.COMMAND


@strategy('wait')
class Wait(Simple):
    """Stands still."""


@strategy('ahead')
class Ahead(Simple):
    """Drives straight on."""

    COMMAND = Command(0.3, 0.0)


@strategy('turn')
class Turn(Simple):
    """Turns on the spot, brushes up."""

    COMMAND = Command(0.0, -1.0, brushes_up=True)


@strategy('give_up')
class GiveUp(Simple):
    """Fails at once."""

    def update(self, observation):
        return self.fail('no,\nnever')


@strategy('crash')
class Crash(Simple):
    """Raises an exception after a second."""

    def update(self, observation):
        return 1 / 0 if len(self.seen) == 10 else super().update(observation)


@strategy('die')
class Die(Simple):
    """Ends the process that runs it."""

    def update(self, observation):
        os._exit(1)


@strategy('quit')
class Quit(Simple):
    """Ends the program, as a beginner may do it."""

    def update(self, observation):
        sys.exit(3)


@strategy('unmakable')
class Unmakable(Simple):
    """Raises an exception when it is made."""

    def __init__(self, context):
        raise KeyError('nothing')
