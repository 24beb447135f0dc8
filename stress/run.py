"""A run: round after round of blows, each on a fresh ground, until the time is over."""

import itertools

from stress import schedule, shrink, trial
from stress.failure import Failure

SHRINK_SECONDS = 240.0  # for one failure


class Run:
    """Strikes the blows of a seed, and shortens what fails."""

    def __init__(self, seed, report, publishers, make=schedule, ground=trial.ground):
        """Prepare; `make` tells blows and scenarios, `ground` makes a ground."""
        self._seed, self._report, self._publishers = seed, report, publishers
        self._make, self._ground = make, ground
        self._shortened = set()

    def rounds(self):
        """Strike blow after blow while there is time."""
        for first in itertools.count(0, schedule.ROUND):
            numbers = list(schedule.round_of(first))
            while numbers and self._report.seconds_left > 0.0:
                struck = self.strike(numbers)
                numbers = numbers[len(struck):]
            if self._report.seconds_left <= 0.0:
                return

    def only(self, numbers):
        """Strike these blows, each round's on one ground; nothing is shortened."""
        for _, group in itertools.groupby(numbers, lambda number: number // schedule.ROUND):
            self.strike(list(group), is_last=True)

    def strike(self, numbers, is_last=False):
        """Strike blows on a fresh ground until one fails or the time is over; returns the numbers of those struck."""
        struck, blow, here = [], None, None
        try:
            with self._ground(self._make.scenario(numbers[0]), self._publishers) as here:
                for number in numbers:
                    if struck and not is_last and self._report.seconds_left <= 0.0:
                        break
                    blow = self._make.blow(self._seed, number)
                    self._report.progress(blow.kind.name)
                    struck.append(blow)
                    try:
                        trial.strike(here, blow)
                    finally:
                        self._report.count(blow)
        except Failure as failure:
            self._report.failed(failure, blow, here)
            if struck and not is_last:
                self._shorten(failure, struck)
        return struck or numbers

    def _shorten(self, failure, struck):
        sort = failure.signature, struck[-1].kind.name
        if sort in self._shortened:
            self._report.known(failure)
            return
        self._shortened.add(sort)
        numbers, is_sure = shrink.shortest([blow.number for blow in struck], lambda some: self._shows(some, failure),
                                           SHRINK_SECONDS)
        self._report.shortest([blow for blow in struck if blow.number in numbers], is_sure)

    def _shows(self, numbers, failure):
        """Whether blows show a failure of the same sort on a fresh ground."""
        self._report.progress(f'shortening: {len(numbers)} blows')
        try:
            with self._ground(self._make.scenario(numbers[0]), self._publishers) as here:
                for number in numbers:
                    trial.strike(here, self._make.blow(self._seed, number))
        except Failure as other:
            return other.signature == failure.signature
        return False
