"""Whether what is done over and over leaves something behind each time: files, threads or memory."""

import time

from stress.failure import Failure
from stress.member import Usage

LOOKS, PERIOD = 12, 0.05  # how often to look at what processes hold, and [s] between two looks
# What one time leaves behind, at least, for a leak. Python and the C library keep some memory for later.
LEAST = Usage(fds=0.25, sockets=0.25, threads=0.25, megabytes=0.01)
FLOOR = 0.5  # of a step, in the same units: what many nodes at work gain or lose by chance
STEADY = 0.3  # a leak grows each time: the smallest step is at least so much of the largest


def held(members):
    """What processes hold once all has been closed that is closed at once, by name."""
    looks = []
    for _ in range(LOOKS):
        looks.append({member.name: member.usage() for member in members})
        time.sleep(PERIOD)
    return {name: Usage(*map(min, zip(*(look[name] for look in looks)))) for name in looks[0]}


def check(batches, times, what):
    """Raise if a process holds more after each batch, in steps that are alike.

    Args:
        batches: what was held after each batch, as `held` gives it; the first batch is for what is loaded once.
        times: how often it was done in a batch.
        what: was done, for a person.

    Raises:
        Failure: a process leaks.
    """
    for name in batches[0]:
        for field, least in LEAST._asdict().items():
            series = [getattr(batch[name], field) for batch in batches]
            steps = [after - before for before, after in zip(series, series[1:])]
            if min(steps) >= max(times * least, FLOOR) and min(steps) >= STEADY * max(steps):
                shown = ', '.join(f'{number:.0f}' for number in series)
                raise Failure('growth', name, f'each {times} {what} leave something behind: {field} {shown}')
