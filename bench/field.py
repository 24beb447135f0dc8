"""The empty field: working time to 98 % in multiples of T, and the CPU time of the plan.

T is the time that the brush needs for the floor at the cleaning speed, without turns, overlap or transit.
"""

import time

from common import figures

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.planning.planner import plan
from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

COVERAGE = 0.98
SEEDS = range(1, 4)
MOST, PLANNED = 1.01, 0.5  # T, CPU s


def main():
    """Measure and print."""
    floor = map_file.load(named_maps.path('field'))
    figures.heading('The empty field, from its middle, for one robot')
    planned(floor)  # loads the compiled code
    figures.row('planned in [CPU s]', planned(floor), below=PLANNED)
    for target in (0.98, 0.99):
        worst = max(working_time(floor, target, seed) for seed in SEEDS)
        figures.row(f'98 % of a mission for {target:.0%}, worst of {len(SEEDS)} seeds [T]', worst, below=MOST)


def planned(floor):
    """CPU time of a plan [s]."""
    start = World(floor).start
    context = Context(floor, RobotConfig(), CleaningConfig())
    context.swept.begin(start.x, start.y)
    begin = time.process_time()
    plan(context, start)
    return time.process_time() - begin


def working_time(floor, target, seed):
    """Time to COVERAGE in multiples of T."""
    trial = Trial(floor, 'boustrophedon', Conditions(target=target), seed, 1)
    while trial.world.floor.sweep.coverage < COVERAGE and not trial.is_over:
        trial.step()
    rate = CleaningConfig().speed * RobotConfig().brush.width
    return trial.world.time * rate / trial.world.floor.sweep.reachable_area


if __name__ == '__main__':
    main()
