"""How often robots fall at edges that no map shows and no laser sees, by what they know of the floor.

`falls.py [--knowledge WHAT ...] [--kinds KIND ...] [--first N] [--last N] [--jobs N]` runs missions of each strategy on
floors drawn from seeds 1 to 10 by default. A robot knows WHAT it has mapped itself (`explored`), a map without the
edges (`unshown`), or nothing (`mapless`).
"""

import argparse
import collections
import concurrent.futures
import functools
import itertools
import statistics
from typing import NamedTuple

from common import figures, hard_floors

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import MAPLESS, SLAM, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World

EXPLORED, UNSHOWN, BLIND = 'explored', 'unshown', 'mapless'
STRATEGIES = {EXPLORED: ('explore_and_clean',), UNSHOWN: ('boustrophedon', 'wander', 'bounce', 'wall_follow'),
              BLIND: ('wander', 'bounce', 'wall_follow', 'spiral')}
KINDS = 'pits', 'cliffs', 'shafts', 'balcony'
RESOLUTION = 0.02  # [m]
TARGET = 0.98  # of the floor that the robot knows
COLUMNS = Outcome.FALLEN, Outcome.BLOCKED, Outcome.INCOMPLETE, Outcome.TIMED_OUT, Outcome.SUCCEEDED
SECONDS = 1500.0  # that a robot cleans whose map lacks the edges


class End(NamedTuple):
    """How a mission ended."""

    outcome: Outcome
    coverage: float  # true share of the reachable floor


def mission(knowledge, kind, strategy, seed):
    """A mission on the floor of a seed."""
    plan = hard_floors.floor(kind, seed, RESOLUTION)
    if knowledge == UNSHOWN:
        return _unshown(plan, strategy, seed)
    conditions = Conditions(pose=SLAM, target=TARGET) if knowledge == EXPLORED else Conditions(pose=MAPLESS)
    trial = Trial(plan, strategy, conditions, seed)
    while not trial.is_over:
        trial.step()
    result = trial.result()
    return End(result.outcome, result.coverage)


def _unshown(plan, strategy, seed):
    """A mission of a robot whose map shows floor where there is none."""
    world = World(plan, RobotConfig(), seed=seed)
    world.spawn(FIRST, brushes_up=True)
    world.step()
    flat = FloorPlan(plan.name, plan.occupancy, plan.resolution, plan.origin, dock=plan.dock, start=plan.start)
    task = Mission(Context(flat, world.config, CleaningConfig(), seed), strategy, TARGET)
    for _ in steps(task, world, seconds=SECONDS):
        if world.robots[FIRST].has_fallen:
            return End(Outcome.FALLEN, world.floor.coverage)
    return End(Outcome.TIMED_OUT if task.status is Status.RUNNING else task.outcome, world.floor.coverage)


def tell(ends):
    """The columns of a line: how many missions ended in each way, and how much of the floor was swept."""
    counts = collections.Counter(end.outcome for end in ends)
    others = len(ends) - sum(counts[outcome] for outcome in COLUMNS)
    coverage = 100.0 * statistics.median(end.coverage for end in ends)
    return ' '.join([*(f'{counts[outcome]:>10}' for outcome in COLUMNS), f'{others:>10} {coverage:>10.1f}'])


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--knowledge', nargs='+', default=list(STRATEGIES), choices=STRATEGIES)
    parser.add_argument('--kinds', nargs='+', default=KINDS, choices=KINDS)
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--last', type=int, default=10)
    parser.add_argument('--jobs', type=int, default=None, help='processes; one for each core by default')
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.last + 1)
    figures.heading(f'Robots near edges that no map shows, seeds {seeds[0]} to {seeds[-1]}')
    print('  missions by their ends, and the median of the true coverage [%]')
    names = [outcome.name.lower() for outcome in COLUMNS]
    print(f'{"":<36}', ' '.join(f'{name:>10}' for name in [*names, 'others', 'coverage']))
    fallen = 0
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        for knowledge, kind in itertools.product(arguments.knowledge, arguments.kinds):
            for strategy in STRATEGIES[knowledge]:
                ends = list(executor.map(functools.partial(mission, knowledge, kind, strategy), seeds))
                print(f'{knowledge:<10} {kind:<9} {strategy:<15}', tell(ends), flush=True)
                fallen += sum(end.outcome is Outcome.FALLEN for end in ends)
    figures.row('fallen, all', fallen, below=1)


if __name__ == '__main__':
    main()
