"""Speed of the learning environment: 1,024 robots, each in a world of its own, in CPU time of one core.

A step is 0.1 s of simulated time: five ticks of the world with battery, drift, bumper and coverage, then the scan of 24
beams, cliffs, the beams of the dock, and the reward. Every robot sweeps, and turns away from what it meets.
"""

import time

from common import figures

from rumba_evaluation.learning.baselines import Bouncing
from rumba_evaluation.learning.coverage_task import CoverageTask
from rumba_evaluation.learning.rooms import rooms
from rumba_evaluation.learning.task_config import TaskConfig

ROBOTS = 1024
STEPS, WITH_MAPS = 62_000, 20_000  # environment steps in a CPU second; the lower bounds
ROOMS = 100
WARM = 20  # steps before the measurement


def main():
    """Measure and print."""
    floors = rooms(0, ROOMS)
    figures.heading(f'Environment: {ROBOTS} robots in {ROOMS} furnished rooms, 24 beams; figures for one CPU second')
    measure(floors, TaskConfig(), 'environment steps', STEPS)
    measure(floors, TaskConfig(maps=2), 'environment steps with two egocentric maps of 32 x 32', WITH_MAPS)
    figures.heading('The same with one robot, as in gymnasium.make')
    measure(floors, TaskConfig(), 'environment steps', None, 1)


def measure(floors, config, name, bound, robots=ROBOTS):
    """Print steps in a CPU second, and what it takes to begin an episode."""
    task = CoverageTask(floors, robots, config)
    task.reset(range(robots))
    before, begin = figures.resident_megabytes(), time.process_time()
    task.reset([None] * robots)
    reset = (time.process_time() - begin) / robots
    driver = Bouncing(robots)
    seen = task.look()
    actions = [driver.act(seen)]
    for _ in range(WARM):
        task.step(actions[-1])
        actions.append(driver.act(task.look()))
    turn = iter(range(10 ** 9))

    def step():
        task.step(actions[next(turn) % len(actions)])
        task.look()
    figure = figures.per_cpu_second(step, robots, 1.0, 5)
    figures.row(name, figure, at_least=bound)
    figures.row('    beginning an episode [CPU ms]', 1e3 * reset)
    share = 1.0 / (1.0 / figure + reset / config.most_steps)
    figures.row(f'    environment steps, with an episode begun every {config.time_limit:g} s', share)
    if robots > 1:
        figures.row('    memory of the process [MB]', max(before, figures.resident_megabytes()))


if __name__ == '__main__':
    main()
