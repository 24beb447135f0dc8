"""How often a robot falls that cleans a floor with pits that no map shows, and that its laser does not see.

`pits.py [--first N] [--last N] [--jobs N]` runs missions of explore_and_clean on floors drawn from seeds 1 to 110.
"""

import argparse
import collections
import concurrent.futures
import math
import statistics

import numpy as np
from common import figures

from rumba_evaluation.trials.cases import SLAM, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.geometry import Pose

RESOLUTION = 0.02  # [m]
WALL = 3  # cells
TARGET = 0.98  # of the floor that the robot knows
DOCK_ROOM = 0.7  # [m] around a place before the dock, without pits


def floor(seed):
    """A room with two to five pits: boxes, angles, discs and pentagons."""
    random = np.random.default_rng(1000 + seed)
    width, height = random.uniform(4.0, 6.5), random.uniform(3.5, 5.0)  # [m]
    rows, columns = int(height / RESOLUTION), int(width / RESOLUTION)
    occupancy = np.full((rows, columns), OCCUPIED, np.int8)
    occupancy[WALL:-WALL, WALL:-WALL] = FREE
    y, x = (np.mgrid[:rows, :columns] + 0.5) * RESOLUTION
    dock = Pose(0.25, 0.5 * height, math.pi)
    before_dock = np.hypot(x - dock.x - 0.4, y - dock.y) <= DOCK_ROOM
    cliff = np.zeros((rows, columns), np.bool_)
    for _ in range(int(random.integers(2, 6))):
        drawn = pit(random, x - random.uniform(1.0, width - 0.4), y - random.uniform(0.4, height - 0.4))
        if not (drawn & before_dock).any():
            cliff |= drawn
    return FloorPlan(f'pits {seed}', occupancy, RESOLUTION, (0.0, 0.0), cliff=cliff, dock=dock)


def pit(random, x, y):
    """Which cells belong to a pit, by their places from its middle [m]: bool (rows, columns)."""
    shape, angle, size = random.integers(4), random.uniform(0.0, math.pi), random.uniform(0.12, 0.6)
    along, across = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
    if shape == 0:
        return (abs(along) < size) & (abs(across) < random.uniform(0.1, 0.5))
    if shape == 1:
        return (abs(along) < size) & (abs(across) < 0.12) | (
            (abs(along - size) < 0.12) & (across > 0.0) & (across < size))
    if shape == 2:
        return np.hypot(along, across) < size
    sides = 2.0 * math.pi / 5.0 * np.arange(5)[:, np.newaxis, np.newaxis]
    return (along * np.cos(sides) + across * np.sin(sides) < size).all(axis=0)


def mission(seed):
    """The result of a mission on the floor of a seed."""
    trial = Trial(floor(seed), 'explore_and_clean', Conditions(pose=SLAM, target=TARGET), seed)
    while not trial.is_over:
        trial.step()
    return trial.result()


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--last', type=int, default=110)
    parser.add_argument('--jobs', type=int, default=None, help='processes; one for each core by default')
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.last + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        results = list(executor.map(mission, seeds))
    figures.heading(f'explore_and_clean among pits that no map shows, seeds {seeds[0]} to {seeds[-1]}')
    counts = collections.Counter(result.outcome.name.lower() for result in results)
    figures.row('fallen', counts.pop('fallen', 0), below=1)
    for name, count in sorted(counts.items()):
        figures.row(name, count)
    figures.row('coverage, true, median [%]', 100.0 * statistics.median(result.coverage for result in results))


if __name__ == '__main__':
    main()
