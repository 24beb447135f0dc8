"""Blows on tools that work beside the nodes: the mission test, and evaluate."""

import signal
import time

import psutil
from common.ros_session import wait_until

from stress import oracles, printed
from stress.failure import Failure
from stress.member import Member, Role

ENDS_WITHIN = 90.0  # [s]
MISSION_TEST = Role('/mission_test', 'rumba_evaluation', 'mission_test',
                    arguments=('_time_limit:=5', '_collisions:=1000', '_battery:=1'))
EVALUATE = Role('evaluate', 'rumba_evaluation', 'evaluate', arguments=(
    '--maps', 'studio', '--strategies', 'bounce', '--seeds', '2', '--bound', '0.02', '--jobs', '2', '--no-plots'))
RESULTS = 'evaluation/results.csv'


def mission_test(ground, chance, blow):
    """A mission test beside the world ends with a verdict, or by a signal."""
    member = Member(MISSION_TEST, ground.environment, ground.folder)
    number = chance.choice((None, signal.SIGTERM, signal.SIGINT, signal.SIGKILL))
    blow.say('a mission test' + (f' ended by {signal.Signals(number).name}' if number else ''), faults=1)
    member.start()
    try:
        if number is not None:
            wait_until(lambda: not member.is_alive or ground.answers(member))
            time.sleep(chance.uniform(0.0, 2.0))
            member.end(number)
        elif _code(member) not in (0, 1):
            raise Failure('end', member.name, f'exit code {member.process.returncode}: '
                          + printed.tail(member.printed()))
        oracles.prints(member)
    finally:
        member.kill()


def evaluate(ground, chance, blow):
    """evaluate is killed, and goes on where it was."""
    seconds = chance.uniform(0.0, 6.0)
    blow.say(f'evaluate killed after {seconds:.1f} s and started again', faults=1)
    for is_killed in (True, False):
        member = Member(EVALUATE, ground.environment, ground.folder)
        member.start()
        try:
            if is_killed:
                time.sleep(seconds)
                member.kill()
            elif _code(member) != 0:
                raise Failure('end', member.name, f'exit code {member.process.returncode}: '
                              + printed.tail(member.printed()))
        finally:
            member.kill()
    rows = (ground.folder / RESULTS).read_text().splitlines()[1:]
    if len(rows) != 2 or len({row.count(',') for row in rows}) != 1:
        raise Failure('lost', 'evaluate', f'{len(rows)} rows of 2 in {RESULTS}: {rows}')
    (ground.folder / RESULTS).unlink()


def _code(member):
    """The exit code of a tool that ends by itself."""
    try:
        return member.process.wait(ENDS_WITHIN)
    except psutil.TimeoutExpired:
        raise Failure('end', member.name, f'runs for more than {ENDS_WITHIN:g} s') from None
