"""Blows on what the system gives: a disk that is full, a home that is not there."""

import signal
import time

from stress import oracles
from stress.blows import fresh
from stress.blows.blow import some_member

SIZES = (0, 100, 5000)  # [bytes] that still fit into a file
NOWHERE = '/dev/null/nowhere'  # which nobody can make, not even root
SECONDS = 1.0  # under the trouble


def full_disk(ground, chance, blow):
    """A node is started again on a full disk: no file can grow."""
    size = chance.choice(SIZES)
    _start_under(ground, chance, blow, f'no file above {size} bytes', file_size=size)


def no_home(ground, chance, blow):
    """A node is started again without a home and without a folder for logs."""
    _start_under(ground, chance, blow, 'no home, no folder for logs', HOME=NOWHERE, ROS_LOG_DIR=f'{NOWHERE}/log',
                 XDG_CACHE_HOME=f'{NOWHERE}/cache')


def _start_under(ground, chance, blow, trouble, **options):
    member = some_member(ground, chance)
    blow.say(f'{member.name} with {trouble}', faults=1)
    fresh.ends(member, signal.SIGTERM)
    ground.start(member, **options)
    time.sleep(SECONDS)
    oracles.alive(member)
    oracles.prints(member)
    fresh.ends(member, signal.SIGTERM)
    ground.start(member)
