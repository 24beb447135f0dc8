"""A fresh node that gets what it should refuse: either it says so in one line, or it runs."""

import contextlib
import re
import signal
import time

import psutil

from rumba_msg.msg import SimulatorState
from stress import oracles, wire, world
from stress.failure import Failure
from stress.member import Member
from stress.printed import ESCAPES, TRACEBACK, tail

DECIDES_WITHIN = 60.0  # [s]
TELLS_WITHIN = 3.0  # [s]
MEGABYTES = 1500.0  # of memory, at most
FAILED, REFUSED = 1, 2  # exit codes
GOOD_CODES = (0, -signal.SIGTERM, -signal.SIGINT)  # after a signal
LONGEST = 1000  # [characters] of the line that says why
PERIOD = 0.02  # [s]
VERDICT = 'NOT MET '  # which a mission test prints in any case
INFORMATION = re.compile(r'^(\x1b\[\d*m)*\[ ?(INFO|WARN|DEBUG)')


def judge(ground, role, arguments):
    """Start a node with arguments; returns in a few words what it did.

    Raises:
        Failure: it neither ran nor refused as it should.
    """
    member = Member(role, ground.environment, ground.folder)
    member.start(arguments=arguments)
    try:
        if _has_started(ground, member):
            if role.is_world:
                ground.members[role.name] = member
                ground.read(world.STATE, SimulatorState, member)
                world.check_robots(ground, TELLS_WITHIN)
            elif role.pulse:
                with contextlib.suppress(wire.WireError):  # it may have been asked to tell nothing
                    oracles.PULSES[role.pulse](ground, member, TELLS_WITHIN)
            if ends(member, signal.SIGINT, may_refuse=True) != REFUSED:
                return 'ran'
        check_refusal(member)
        return 'refused'
    finally:
        ground.members.pop(role.name, None)
        member.kill()


def _has_started(ground, member):
    """Wait until it runs or has ended; returns whether it runs."""
    end = time.monotonic() + DECIDES_WITHIN
    while member.is_alive:
        with contextlib.suppress(psutil.Error):
            megabytes = member.usage().megabytes
            if megabytes > MEGABYTES:
                raise Failure('memory', member.name, f'{megabytes:.0f} MB at its start')
        if ground.answers(member):
            return True
        if time.monotonic() > end:
            raise Failure('start', member.name, f'neither runs nor ends after {DECIDES_WITHIN:g} s')
        time.sleep(PERIOD)
    return False


def ends(member, number, may_refuse=False):
    """Send a signal to a node, which must end for it, in time and quietly; returns its exit code.

    If `may_refuse` is true, it may at the same time have found that its input is bad.

    Raises:
        Failure: it does not.
    """
    code = member.end(number)
    name = signal.Signals(number).name
    if code is None:
        raise Failure('end', member.name, f'does not end after {name}')
    if may_refuse and code == REFUSED:
        return code
    oracles.prints(member)
    if code not in GOOD_CODES and not (code == FAILED and member.role.fails_if_ended):
        raise Failure('end', member.name, f'ends with exit code {code} after {name}')
    return code


def check_refusal(member):
    """A node that has ended said why, in one line.

    Raises:
        Failure: it did not.
    """
    member.end()
    code = member.process.returncode
    lines = [line for line in member.printed() if line.strip()]
    if any(TRACEBACK in line for line in lines):
        raise Failure('traceback', member.name, tail(lines))
    said = [line for line in lines if not INFORMATION.match(line) and not line.startswith(VERDICT)]
    if code == 0 and not said:
        return
    if code not in (REFUSED, FAILED) or len(said) != 1:
        raise Failure('refusal', member.name, f'exit code {code}, {len(said)} lines: {tail(said)}')
    if len(said[0]) > LONGEST or ESCAPES.search(said[0]):
        raise Failure('refusal', member.name, f'{len(said[0])} characters: {said[0][:200]!r}')
