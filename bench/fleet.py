"""How much sooner several robots clean a floor that they share, from their docks and from anywhere.

`fleet.py [--seeds N] [--starts START ...] [--poses POSE ...]` runs seeds 1 to N, 20 by default, on all cores; times are
simulated, those of charging left out.
"""

import argparse
import concurrent.futures
import functools
import itertools
import statistics
from typing import NamedTuple

from common import figures

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import ANYWHERE, DOCK, LOCALISED, POSES, TRUTH, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps

MAP = 'apartment_docks'
ROBOTS = (1, 2, 3)
BOUNDS = {2: 0.6, 3: 0.45}  # working time, in multiples of that of one robot


class Mission(NamedTuple):
    """A mission of a team."""

    outcome: Outcome
    time: float  # [s] until all robots were home
    docked: int
    has_penetrated: bool  # a wall


@functools.lru_cache(maxsize=None)
def floor():
    """The plan of the map."""
    return map_file.load(named_maps.path(MAP))


def mission(robots, start, pose, seed):
    """A mission of a number of robots."""
    trial = Trial(floor(), 'boustrophedon', Conditions(start=start, pose=pose), seed, robots)
    while not trial.is_over:
        trial.step()
    result = trial.result()
    return Mission(result.outcome, result.time - result.charging_time, result.docked, result.penetrated)


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=20)
    parser.add_argument('--poses', nargs='+', choices=POSES, default=(TRUTH, LOCALISED))
    parser.add_argument('--starts', nargs='+', choices=(DOCK, ANYWHERE), default=(DOCK, ANYWHERE))
    arguments = parser.parse_args()
    seeds = range(1, arguments.seeds + 1)
    with concurrent.futures.ProcessPoolExecutor() as executor:
        for pose, start in itertools.product(arguments.poses, arguments.starts):
            figures.heading(f'Robots that share the map {MAP} to 99 %: start {start}, pose {pose}, {len(seeds)} seeds')
            found = {robots: list(executor.map(functools.partial(mission, robots, start, pose), seeds))
                     for robots in ROBOTS}
            for robots, missions in found.items():
                show(robots, missions, found[1])


def show(robots, missions, alone):
    """Print how the missions of a number of robots went, and those of one robot."""
    times = [each.time for each in missions]
    share = statistics.median(each.time / one.time for each, one in zip(missions, alone))
    figures.row(f'{robots} robot{"s" if robots > 1 else ""}: working time, median [s]', statistics.median(times))
    figures.row('    longest [s]', max(times))
    if robots in BOUNDS:
        figures.row('    in multiples of that of one robot with the same seed, median', share, below=BOUNDS[robots])
    figures.row('    at the target', sum(each.outcome is Outcome.SUCCEEDED for each in missions),
                at_least=len(missions))
    figures.row('    all robots home', sum(each.docked == robots for each in missions), at_least=len(missions))
    figures.row('    in a wall', sum(each.has_penetrated for each in missions), below=1)


if __name__ == '__main__':
    main()
