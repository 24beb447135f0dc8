"""How missions of boustrophedon go on floors that are hard to clean, each drawn from a seed by `common.hard_floors`.

    python3 bench/floors.py --kinds chairs tiny --seeds 0-2 --resolutions 1 2 5

Figures of the planner are tuned on seeds below 100; those from 100 on are kept aside to check the result.
"""

import argparse
import collections
import concurrent.futures
import itertools
import math
import multiprocessing
import os
import statistics
import time
from typing import NamedTuple

import numpy as np
from common import figures, hard_floors

from rumba_cleaning.planning import planner
from rumba_cleaning.strategies import boustrophedon
from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.errors import RumbaError

RESOLUTIONS = (1.0, 2.0, 5.0, 10.0)  # [cm]
LARGE = ('furnished', 'empty', 'furnished of 1,300 m2', 'office')  # nobody maps a whole storey at 1 cm
FINEST = 2.0  # [cm] for those
THIN = ('thin', 'chairs', 'dining', 'spiral of 0.5 m', 'maze', 'ring corridor', 'winding', 'crossing', 'neck',
        'posts')  # on cells of 10 cm little of these floors is left
COARSEST = 5.0  # [cm] for those
WORST, MEDIAN = 1.7, 1.3  # bounds of the time to 98 % in multiples of T
ROW = '{:<36}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>6}{:>6}{:>6}  {}'


class Mission(NamedTuple):
    """How one mission went."""

    line: str  # about it
    to_98: float = math.inf  # [T]
    is_hurt: bool = False  # whether the robot fell, or was in a wall
    outcome: str = 'refused'


class Stopwatch:
    """The planner, with the CPU time that it takes.

    Attributes:
        seconds: of all calls [s].
        first: of the first call [s].
    """

    def __init__(self):
        """Nothing was planned yet."""
        self.seconds = self.first = 0.0

    def __call__(self, context, *poses):
        """Plan, and measure that."""
        begin = time.process_time()
        route = planner.plan(context, *poses)
        seconds = time.process_time() - begin
        self.first = self.first or seconds
        self.seconds += seconds
        return route


def main():
    """Run all missions, and print."""
    arguments = parsed()
    cases = [case for case in itertools.product(arguments.kinds, arguments.seeds, arguments.resolutions)
             if is_sensible(case[0], case[2])]
    print(ROW.format('floor', 'm2', '% of', 'plan s', 'all s', '98 %', '99 %', 'true %', 'hits', 'falls',
                     'outcome'), flush=True)
    missions = []
    context = multiprocessing.get_context('spawn')
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs, context) as executor:
        conditions = Conditions(start=arguments.start, target=arguments.target)
        for mission in executor.map(run, *zip(*cases), itertools.repeat(conditions)):
            print(mission.line, flush=True)
            missions.append(mission)
    summarise(missions)


def summarise(missions):
    """Print what all missions have in common."""
    figures.heading(f'{len(missions)} missions')
    figures.row('time to 98 %, median [T]', statistics.median(mission.to_98 for mission in missions), below=MEDIAN)
    figures.row('      the same, worst [T]', max(mission.to_98 for mission in missions), below=WORST)
    figures.row('fallen, or in a wall', sum(mission.is_hurt for mission in missions), below=1)
    for outcome, count in collections.Counter(mission.outcome for mission in missions).most_common():
        figures.row(outcome, count)


def parsed():
    """The arguments."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--kinds', nargs='+', default=list(hard_floors.KINDS), choices=list(hard_floors.KINDS))
    parser.add_argument('--seeds', type=span, default=[0], help='0-4: five floors of each kind')
    parser.add_argument('--resolutions', nargs='+', type=float, default=RESOLUTIONS, help='[cm]')
    parser.add_argument('--start', default='dock', choices=('dock', 'anywhere'))
    parser.add_argument('--target', type=float, default=Conditions().target, help='coverage at which a mission ends')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    return parser.parse_args()


def span(text):
    """The seeds of a text such as 3 or 0-4."""
    first, _, last = text.partition('-')
    return list(range(int(first), int(last or first) + 1))


def is_sensible(kind, resolution):
    """Whether a floor of a kind is worth drawing with cells of a resolution [cm]."""
    return not (kind in LARGE and resolution < FINEST) and not (kind in THIN and resolution > COARSEST)


def run(kind, seed, resolution, conditions):
    """One mission."""
    plan = hard_floors.floor(kind, seed, 0.01 * resolution)
    free = float(np.count_nonzero(plan.free)) * plan.resolution ** 2
    try:
        trial = Trial(plan, 'boustrophedon', conditions, seed)
        watch = boustrophedon.plan = Stopwatch()
        while not trial.is_over:
            trial.step()
    except RumbaError as error:
        return Mission(f'{plan.name}: {error}')
    result = trial.result()
    fallen = sum(robot.has_fallen for robot in trial.world.robots.values())
    outcome = result.outcome.name.lower()
    in_wall = ' IN A WALL' if result.penetrated else ''
    times = [result.multiple_to(percent) for percent in (98, 99)]
    line = ROW.format(
        plan.name, f'{result.area:.1f}', f'{100.0 * result.area / free:.1f}', f'{watch.first:.2f}',
        f'{watch.seconds:.2f}', *(f'{multiple:.3f}' if math.isfinite(multiple) else '-' for multiple in times),
        f'{100.0 * result.coverage:.1f}', result.collisions, fallen, f'{outcome}{in_wall}')
    return Mission(line, times[0], fallen > 0 or result.penetrated, outcome)


if __name__ == '__main__':
    main()
