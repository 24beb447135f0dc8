"""How a robot maps, cleans and comes home on a floor that it has never seen, and how exact its map is.

`mapping.py [--seeds N] [--jobs N] [--floors NAME ...] [--strategy NAME]` runs seeds 1 to N, 20 by default, on all
cores; times are simulated, but for the cost.
"""

import argparse
import concurrent.futures
import functools
import math
import statistics
import time
from typing import NamedTuple

import numpy as np
from common import figures, office, ring
from scipy import ndimage

from rumba_cleaning.pose_source import Mapped
from rumba_evaluation.trials.cases import SLAM, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_localisation import compiled_matching
from rumba_localisation.walls import Walls
from rumba_sim.model.common.geometry import compose
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.maps.floor_plan import OCCUPIED
from rumba_sim.model.simulation.world import World

RING, OFFICE = 'ring', 'office'
NAMES = ('studio', 'apartment', RING)
TARGET = 0.98  # of the floor that the robot knows
WANTED = 97  # [%] of the floor that it can truly reach
LAST = 600  # scans: the last minute
STEPS = np.geomspace(0.1, 0.02, 8)  # [m] sigmas of the alignment


class Mission(NamedTuple):
    """A mission on a floor that the robot did not know."""

    coverage: float  # true share of the reachable floor that was swept
    believed: float  # the same by the robot's own account, of the floor that it knows
    multiple: float  # working time to WANTED % of the reachable floor, in multiples of T
    whole: float  # working time of all of it, in multiples of T
    is_home: bool
    error: float  # RMS of the position [m]
    near: float  # share of the wall cells of the map that are within 0.05 m of a wall
    close: float  # the same for 0.10 m
    found: float  # share of the wall cells at the floor, within 0.05 m of which the map has a wall
    cost: float  # CPU time of the mapper per simulated second [s]
    speed: float  # simulated seconds per CPU second, all in all


@functools.lru_cache(maxsize=None)
def floor(name):
    """The plan of a map."""
    return ring.plan() if name == RING else map_file.load(named_maps.path(name))


class Watched:
    """A source of poses, with the errors of all that it told and the CPU time that it took."""

    def __init__(self, source):
        """Watch a source."""
        self.source, self.errors, self.cost = source, [], 0.0

    def __call__(self, world, name):
        """What the source believes."""
        begun = time.process_time()
        belief = self.source(world, name)
        self.cost += time.process_time() - begun
        pose = world.robots[name].pose
        self.errors.append(math.hypot(belief.pose.x - pose.x, belief.pose.y - pose.y))
        return belief


def mission(name, strategy, seed):
    """A mission on a map, which the robot was not shown."""
    begun = time.process_time()
    trial = Trial(floor(name), strategy, Conditions(pose=SLAM, target=TARGET), seed)
    watched = trial.sources['rumba'] = Watched(trial.sources['rumba'])
    while not trial.is_over:
        trial.step()
    result = trial.result()
    spent = time.process_time() - begun
    return Mission(result.coverage, trial.contexts[0].swept.coverage, result.multiple_to(WANTED),
                   trial.working_time / trial.ideal_time, result.docked == 1,
                   math.sqrt(np.mean(np.square(watched.errors))),
                   *compared(watched.source.plan(), floor(name)), watched.cost / result.time, result.time / spent)


def around_the_office(seed):
    """A drive around the loops of an office: errors at the end [m] of the map and of the wheels alone; `compared`."""
    plan = office.plan()
    world = World(plan, seed=seed)
    robot = world.spawn('rumba', office.START)
    source = Mapped(world, 'rumba')
    errors = []
    for _ in office.drive(world):
        pose = source(world, 'rumba').pose
        errors.append(math.hypot(pose.x - robot.pose.x, pose.y - robot.pose.y))
    reckoned = compose(office.START, robot.odometry)
    return (math.sqrt(np.mean(np.square(errors[-LAST:]))),
            math.hypot(reckoned.x - robot.pose.x, reckoned.y - robot.pose.y), *compared(source.plan(), plan))


def compared(plan, truth, near=0.05):
    """Shares of wall cells that agree, after the best rigid alignment: `near`, `close` and `found` of `Mission`.

    `near` is how far a cell of the map may be from a wall to count as such [m].
    """
    walls = Walls(truth)
    cells, pose = centres(plan), np.empty(3)
    compiled_matching.match(np.zeros(3), np.diag([0.5, 0.5, 0.1]) ** 2, cells, np.zeros(len(cells)), walls.distance,
                            *walls.origin, walls.resolution, STEPS, 1.0, pose, np.empty((3, 3)))
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    aligned = cells @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
    away = distances(aligned, edges(truth))
    return np.mean(away <= near), np.mean(away <= 0.10), np.mean(distances(edges(truth), aligned) <= 0.05)


def centres(plan):
    """Centres of the occupied cells of a plan: float64 (any, 2) [m]."""
    return (np.argwhere(plan.occupancy == OCCUPIED)[:, ::-1] + 0.5) * plan.resolution + plan.origin


def edges(plan):
    """Centres of the cells that are not free beside floor that a robot can stand on: float64 (any, 2) [m]."""
    labels, _ = ndimage.label(plan.free)
    free = np.pad(labels == np.argmax(np.bincount(labels.ravel())[1:]) + 1, 1)
    found = ndimage.binary_dilation(free) & ~free
    return (np.argwhere(found)[:, ::-1] - 0.5) * plan.resolution + plan.origin


def distances(points, others):
    """Distance from each point to the nearest of others [m]: float64 (any)."""
    low, size = others.min(axis=0) - 1.0, 0.01
    shape = np.ceil((others.max(axis=0) + 1.0 - low) / size).astype(int)
    is_other = np.zeros(shape, np.bool_)
    is_other[tuple(((others - low) / size).astype(int).T)] = True
    away = ndimage.distance_transform_edt(~is_other) * size
    return away[tuple(np.clip((points - low) / size, 0, shape - 1).astype(int).T)]


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=20)
    parser.add_argument('--jobs', type=int, default=None, help='processes; one for each core by default')
    parser.add_argument('--floors', nargs='+', choices=(*NAMES, OFFICE), default=(*NAMES, OFFICE))
    parser.add_argument('--strategy', default='explore_and_clean')
    arguments = parser.parse_args()
    seeds = range(1, arguments.seeds + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        if OFFICE in arguments.floors:
            figures.heading(f'A drive around the loops of an office of 500 m2, {len(seeds)} seeds')
            show_office(list(executor.map(around_the_office, seeds)))
        for name in (each for each in NAMES if each in arguments.floors):
            figures.heading(f'{arguments.strategy}, {name}, which the robot was not shown, {len(seeds)} seeds')
            run = functools.partial(mission, name, arguments.strategy)
            show_missions(list(executor.map(run, seeds)))


def show_office(told):
    """Print how drives around the office went."""
    ends, wheels, near, close, _ = zip(*told)
    figures.row('RMS error of position in the last minute [m], median', statistics.median(ends))
    figures.row('    the same, worst', max(ends), below=0.10)
    figures.row('error at the end by the wheels alone [m], median', statistics.median(wheels))
    figures.row("wall cells of the map within 0.05 m of a wall, worst drive [%]", 100.0 * min(near), at_least=95)
    figures.row('    within 0.10 m', 100.0 * min(close), at_least=100)


def show_missions(told):
    """Print how missions went."""
    figures.row('coverage, true, median [%]', 100.0 * statistics.median(each.coverage for each in told),
                at_least=WANTED)
    figures.row('    the same, worst [%]', 100.0 * min(each.coverage for each in told))
    figures.row("    the robot's own account is off by, at most [points]",
                100.0 * max(abs(each.believed - each.coverage) for each in told))
    figures.row(f'{WANTED} % swept, median [T]', statistics.median(each.multiple for each in told), below=2.0)
    figures.row('whole mission, median [T]', statistics.median(each.whole for each in told))
    figures.row('home', sum(each.is_home for each in told), at_least=len(told))
    figures.row('RMS error of position [m], worst mission', max(each.error for each in told))
    figures.row('wall cells of the map within 0.05 m of a wall, worst mission [%]',
                100.0 * min(each.near for each in told), at_least=95)
    figures.row('    within 0.10 m', 100.0 * min(each.close for each in told), at_least=100)
    figures.row('walls at the floor that the map has, worst mission [%]', 100.0 * min(each.found for each in told))
    figures.row('CPU time of the mapper at real time [%]', 100.0 * statistics.median(each.cost for each in told),
                below=25.0)
    figures.row('simulated seconds per CPU second, all', statistics.median(each.speed for each in told), at_least=60)


if __name__ == '__main__':
    main()
