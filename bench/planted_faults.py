"""How long the trial ground takes to find planted faults: one for each kind of blow, and for what oracles look at.

    ./rumba shell python3 bench/planted_faults.py

Each fault is planted into a real node (`bench/common/planted/faults.py`). Its ground is started, and blows of one kind
of `./rumba stress` are struck until an oracle sees something, for five minutes at most. The first row has no fault.
"""

import argparse
import os
import pathlib
import random
import sys
import time
from typing import NamedTuple

BENCH = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(BENCH.parent))

from common import figures  # noqa: E402

from stress import trial  # noqa: E402
from stress.blows import KINDS  # noqa: E402
from stress.blows.blow import Blow  # noqa: E402
from stress.failure import Failure  # noqa: E402
from stress.publishers import Publishers  # noqa: E402
from stress.scenarios import SCENARIOS  # noqa: E402

MOST = 300.0  # [s]


class Planted(NamedTuple):
    """A fault in a program of a ground, and the kind of blow that shows it."""

    fault: str
    program: str
    ground: str
    blow: str


FAULTS = (
    Planted('file_for_each_goal', 'cleaner', 'flat', 'again and again'),
    Planted('memory_for_each_goal', 'cleaner', 'localised', 'again and again'),
    Planted('thread_for_each_robot', 'simulator', 'flat', 'again and again'),
    Planted('socket_for_each_visit', 'page', 'localised', 'again and again'),
    Planted('socket_for_each_caller', 'mapper', 'mapped', 'idle connections'),
    Planted('dies_of_a_broken_handshake', 'viewer', 'flat', 'handshakes'),
    Planted('dies_of_a_broken_request', 'localiser', 'localised', 'xmlrpc'),
    Planted('dies_of_a_broken_frame', 'battery_status_listener', 'flat', 'frames'),
    Planted('dies_of_a_reader_that_goes', 'simulator', 'flat', 'deaf readers'),
    Planted('hangs_after_an_odd_number', 'simulator', 'mapped', 'topic'),
    Planted('coverage_is_lost', 'simulator', 'localised', 'topic'),
    Planted('prints_what_it_gets', 'cleaner', 'flat', 'topic'),
    Planted('prints_too_much', 'mapper', 'mapped', 'topic'),
    Planted('pose_estimate_that_is_no_number', 'localiser', 'localised', 'teleport'),
    Planted('raises_for_an_odd_name', 'simulator', 'flat', 'service'),
    Planted('drops_goals', 'cleaner', 'flat', 'action'),
    Planted('dies_of_a_stop', 'cleaner', 'flat', 'stop'),
    Planted('dies_of_a_silent_master', 'viewer', 'flat', 'stop of the master'),
    Planted('forgets_the_master', 'battery_status_listener', 'flat', 'kill -9 of the master'),
    Planted('page_falls_silent', 'page', 'mapped', 'kill -9'),
    Planted('is_a_twin', 'simulator', 'flat', 'second simulator'),
    Planted('hears_no_signal', 'cleaner', 'localised', 'end'),
    Planted('ends_with_an_error', 'viewer', 'flat', 'end'),
    Planted('ignores_rosnode_kill', 'viewer', 'flat', 'rosnode kill'),
    Planted('leaves_robots_behind', 'simulator', 'flat', 'spawn and kill'),
    Planted('steps_one_too_many', 'simulator', 'flat', 'pause and step'),
    Planted('reset_fails', 'simulator', 'mapped', 'reset'),
    Planted('pose_that_is_no_number', 'simulator', 'flat', 'teleport'),
    Planted('stands_after_odd_speed', 'simulator', 'flat', 'speed'),
    Planted('dies_of_a_full_disk', 'cleaner', 'flat', 'full disk'),
    Planted('dies_without_a_home', 'viewer', 'flat', 'no home'),
    Planted('raises_at_the_end_of_a_test', 'mission_test', 'flat', 'mission test'),
    Planted('forgets_rows', 'evaluate', 'cradle', 'evaluate'),
    Planted('raises_for_a_bad_map', 'simulator', 'cradle', 'map'),
    Planted('charge_below_zero', 'simulator', 'cradle', 'settings'),
    Planted('refuses_in_two_lines', 'simulator', 'cradle', 'settings'),
    Planted('raises_for_an_odd_date', 'page', 'browsed', 'requests to the page'),
    Planted('sleeps_over_what_is_no_number', 'page', 'browsed', 'frames to the page'),
    Planted('repeats_what_is_no_id', 'page_session.py', 'browsed', 'operations of the page'),
    Planted('percentage_below_zero', 'battery_status_publisher', 'cradle', 'arguments'),
)


def main():
    """Plant the faults and print how long each is hidden."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--faults', nargs='+', choices=[each.fault for each in FAULTS], help='some of the faults')
    parser.add_argument('--seed', type=int, default=1, help='of the blows')
    options = parser.parse_args()
    wanted = [each for each in FAULTS if not options.faults or each.fault in options.faults]
    publishers, found = Publishers(), 0
    figures.heading('Planted faults, and how long it takes to find each [s]')
    for planted in wanted:
        seconds, seen = search(planted, options.seed, publishers)
        found += seconds is not None
        print(f'  {planted.fault:34} {planted.program:24} {planted.blow:22} '
              f'{"MISSED" if seconds is None else format(seconds, "6.1f")}  {seen[:150]}', flush=True)
    figures.row('found within five minutes', found, at_least=len(wanted))
    return 0 if found == len(wanted) else 1


def search(planted, seed, publishers):
    """Strike until a fault is found; returns after how many seconds, None if it is not, and what was seen."""
    os.environ.update(RUMBA_PLANTED_FAULT=planted.fault, RUMBA_PLANTED_IN=planted.program)
    path = os.environ.get('PYTHONPATH', '')
    os.environ['PYTHONPATH'] = f'{BENCH / "common" / "planted"}:{path}'
    begin = time.monotonic()
    kind = next(kind for kind in KINDS if kind.name == planted.blow)
    blow = None
    try:
        with trial.ground(SCENARIOS[planted.ground], publishers) as here:
            number = 0
            while time.monotonic() < begin + MOST:
                blow = Blow(number, kind, random.Random(f'{seed} {number}'))
                trial.strike(here, blow)
                number += 1
    except Failure as failure:
        seconds = time.monotonic() - begin
        return (seconds if seconds <= MOST else None), f'{failure}' if blow else f'at the start: {failure}'
    finally:
        os.environ['PYTHONPATH'] = path
        del os.environ['RUMBA_PLANTED_FAULT'], os.environ['RUMBA_PLANTED_IN']
    return None, 'nothing'


if __name__ == '__main__':
    sys.exit(main())
