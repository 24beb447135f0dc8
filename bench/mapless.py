"""How far a robot gets without a map and without a laser, as the early Roombas: bumper, odometry, beams of the dock.

`mapless.py [--seeds N] [--jobs N] [--maps NAME ...] [--strategies NAME ...]` runs seeds 1 to N, 20 by default, on all
cores. Each robot cleans for 45 minutes; times are simulated.
"""

import argparse
import concurrent.futures
import functools
import statistics
from typing import NamedTuple

from common import figures

from rumba_cleaning.control import CONTROL_DT
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import MAPLESS, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps

MAPS, STRATEGIES = ('studio', 'apartment', 'field'), ('wander', 'bounce', 'wall_follow', 'spiral')
SHARES = 0.5, 0.95  # of the searches for the dock, by the time that they take


class Mission(NamedTuple):
    """A mission of a robot that knows nothing of the floor."""

    coverage: float  # true share of the reachable floor that was swept
    time: float  # [T] of cleaning
    searches: list  # [s] for the dock, each from its begin to the contacts, or to the end of the mission
    is_home: bool
    has_fallen: bool


def mission(name, strategy, seed):
    """A mission on a map of the package, with a real battery."""
    trial = Trial(map_file.load(named_maps.path(name)), strategy, Conditions(pose=MAPLESS), seed)
    searches, began, cleaned = [], None, 0
    while not trial.is_over:
        trial.step()
        is_seeking = trial.missions[0].state in (State.RETURNING, State.DOCKING)
        cleaned += trial.missions[0].state is State.CLEANING
        if is_seeking and began is None:
            began = trial.world.time
        elif not is_seeking and began is not None:
            searches.append(trial.world.time - began)
            began = None
    result = trial.result()
    return Mission(result.coverage, CONTROL_DT * cleaned / result.ideal_time, searches, result.docked == 1,
                   result.outcome is Outcome.FALLEN)


def show(told):
    """Print how missions went."""
    figures.row('coverage, true, median [%]', 100.0 * statistics.median(each.coverage for each in told))
    figures.row('    the same, worst [%]', 100.0 * min(each.coverage for each in told))
    figures.row('cleaning [T]', statistics.median(each.time for each in told))
    figures.row('home', sum(each.is_home for each in told))
    figures.row('fallen', sum(each.has_fallen for each in told), below=1)
    searches = sorted(time for each in told for time in each.searches)
    if searches:
        for share in SHARES:
            figures.row(f'search for the dock, {100.0 * share:.0f} of 100 within [s]',
                        searches[int(share * (len(searches) - 1))])
        figures.row('    the longest [s]', searches[-1])


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=20)
    parser.add_argument('--jobs', type=int, default=None, help='processes; one for each core by default')
    parser.add_argument('--maps', nargs='+', default=MAPS, help='names of maps of rumba_sim')
    parser.add_argument('--strategies', nargs='+', default=STRATEGIES)
    arguments = parser.parse_args()
    seeds = range(1, arguments.seeds + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        for name in arguments.maps:
            for strategy in arguments.strategies:
                figures.heading(f'{strategy} without map and laser, {name}, {len(seeds)} seeds')
                show(list(executor.map(functools.partial(mission, name, strategy), seeds)))


if __name__ == '__main__':
    main()
