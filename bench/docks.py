"""Whether robots come home if docks stand at random walls, several of them in sight of each other.

`docks.py [--pairs N] [--sizes N ...] [--kinds KIND ...]` draws ten floors with places for docks. A robot looks for the
first dock of a pair from a random place between both; 200 ordered pairs by default. Fleets of 2, 3, 5 and 8 robots
clean each floor to 98 %, each robot from a dock of its own.
"""

import argparse
import concurrent.futures
import functools
import itertools
import math
import os
import statistics
from typing import NamedTuple

import numpy as np
from common import figures, hard_floors
from scipy import ndimage

from rumba_cleaning import control
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import Parts
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

KINDS = ('furnished', 'empty', 'dining', 'islands', 'jagged', 'slanted', 'tiny', 'round', 'pits', 'cliffs')
RESOLUTION = 0.02  # [m]
PLACES = 32  # for docks on a floor, of which fleets use the first
OPEN = 0.98  # of the floor is still one part if a robot stands at a dock: nobody has it close a door
SIZES = (2, 3, 5, 8)  # of fleets
PLATE, STRAIGHT, ASTRIDE, BEFORE = 0.03, 0.02, 0.15, 0.5  # [m]: to the wall; how even it is, so far to both sides; free
APART = 0.6  # [m] from dock to dock, at least
SIGHT = 3.0  # [m] from one dock of a pair to the other, at most
LIMIT = 600.0  # [s] for one robot to come home
LATE = 180.0  # [s] after 98 % were swept: our choice
RADIUS = RobotConfig().drive.radius
TARGET = 0.98


class Return(NamedTuple):
    """How a robot came home, or a fleet."""

    name: str
    is_home: bool
    seconds: float  # [s] until then; of a fleet, since 98 % were swept
    message: str


@functools.lru_cache(maxsize=None)
def floor(kind):
    """A floor, and places for docks on it in a random order."""
    plan = hard_floors.floor(kind, 3, RESOLUTION)
    bare = FloorPlan(plan.name, plan.occupancy, plan.resolution, plan.origin, cliff=plan.cliff)
    generator = np.random.default_rng([*kind.encode()])
    found = []
    largest = largest_part(bare)
    for pose in generator.permutation(places(bare, largest)):
        if len(found) < PLACES and all(math.hypot(*(pose[:2] - other[:2])) >= APART for other in found) and (
                not closes(bare, largest, pose)):
            found.append(pose)
    return bare, as_poses(found)


def as_poses(places):
    """Poses of docks from arrays."""
    return [Pose(*(round(value, 4) for value in place.tolist())) for place in places]


def largest_part(plan):
    """The nodes of the largest part of a floor: bool (rows + 1, columns + 1)."""
    return Parts(plan, clearance_needed(RADIUS, plan.resolution)).labels[::2, ::2] == 1


def closes(plan, largest, pose):
    """Whether a robot at a dock closes a door to others."""
    y, x = (low + plan.resolution * index for low, index in zip(plan.origin[::-1], np.indices(largest.shape)))
    left = largest & (np.hypot(x - pose[0], y - pose[1]) > 2.0 * RADIUS + PLATE)
    sizes = np.bincount(ndimage.label(left)[0].ravel())[1:]
    return sizes.max() < OPEN * np.count_nonzero(left)


def places(plan, largest):
    """Poses against walls that are even, with space before them, near nodes of the largest part: float64 (any, 3)."""
    clearance = plan.safe_clearance
    away = RADIUS + PLATE
    near = largest & (clearance >= away) & (clearance < away + plan.resolution)
    up, right = np.gradient(clearance)
    rows, columns = np.nonzero(near)
    theta = np.arctan2(-up[rows, columns], -right[rows, columns])
    cos, sin = np.cos(theta), np.sin(theta)
    x, y = plan.origin[0] + columns * plan.resolution, plan.origin[1] + rows * plan.resolution
    excess = clearance[rows, columns] - away
    x, y = x + excess * cos, y + excess * sin

    def at(ahead, left):
        index = ((y + ahead * sin + left * cos - plan.origin[1]) / plan.resolution,
                 (x + ahead * cos - left * sin - plan.origin[0]) / plan.resolution)
        return ndimage.map_coordinates(clearance, index, order=1)
    good = np.ones(len(x), bool)
    for left in (-ASTRIDE, ASTRIDE):
        good &= np.abs(at(0.0, left) - away) < STRAIGHT
    for behind in np.arange(0.05, BEFORE + 0.01, 0.05):
        good &= at(-behind, 0.0) >= away
    return np.stack([x, y, theta], axis=1)[good]


def with_docks(plan, docks):
    """The same floor with docks."""
    return FloorPlan(plan.name, plan.occupancy, plan.resolution, plan.origin, cliff=plan.cliff, dock=docks[0],
                     further_docks=tuple(docks[1:]))


def is_in_sight(plan, one, other):
    """Whether nothing stands between two docks, and they are near to each other."""
    if math.hypot(one.x - other.x, one.y - other.y) > SIGHT:
        return False
    along = np.linspace(0.0, 1.0, 100)[:, np.newaxis]
    points = np.array(one[:2]) + along * (np.array(other[:2]) - one[:2])
    return all(plan.safe_clearance_at(x, y) > 0.05 for x, y in points.tolist())


# --- pairs ------------------------------------------------------------------------------------------------------------

def pairs(kinds, count):
    """Kinds of floors with the numbers of two docks in sight of each other, as many of each floor as possible."""
    of_floors = []
    for kind in kinds:
        plan, docks = floor(kind)
        found = [(kind, i, j) for i, j in itertools.permutations(range(len(docks)), 2)
                 if is_in_sight(plan, docks[i], docks[j])]
        generator = np.random.default_rng(len(found))
        of_floors.append([found[index] for index in generator.permutation(len(found))])
    mixed = [pair for row in itertools.zip_longest(*of_floors) for pair in row if pair is not None]
    return mixed[:count]


def come_home(case):
    """One robot comes home to the first dock of a pair."""
    kind, first, second = case
    plan, docks = floor(kind)
    world = World(with_docks(plan, [docks[first], docks[second]]), step_rate=control.STEP_RATE, seed=first)
    start = between(world, docks[first], docks[second], np.random.default_rng([first, second]))
    world.spawn('rumba', start, brushes_up=True)
    world.step()
    behaviour = Dock(Context(world.plan, world.config, CleaningConfig(), world.seed))
    for _ in control.steps(behaviour, world, seconds=LIMIT):
        pass
    turned = math.degrees(abs(docks[first].theta - docks[second].theta)) % 360.0
    name = f'{kind}, docks {first} and {second}, turned by {min(turned, 360.0 - turned):.0f} degrees'
    return Return(name, world.robots['rumba'].is_docked, world.time, behaviour.message)


def between(world, one, other, generator):
    """A free pose near the middle of two docks."""
    sweep, spread = world.reachable_plan, 0.6
    while True:
        x, y = generator.normal(0.5 * (np.array(one[:2]) + other[:2]), spread).tolist()
        spread *= 1.02
        left, bottom, right, top = sweep.bounds
        if left < x < right and bottom < y < top and sweep.safe_clearance_at(x, y) > RADIUS + 0.02 and all(
                math.hypot(x - dock.x, y - dock.y) > 0.3 for dock in (one, other)):
            return Pose(x, y, float(generator.uniform(-math.pi, math.pi)))


# --- fleets -----------------------------------------------------------------------------------------------------------

def clean(case):
    """A fleet cleans a floor, each robot from a dock of its own."""
    kind, size = case
    plan, docks = floor(kind)
    trial = Trial(with_docks(plan, docks[:size]), 'boustrophedon', Conditions(target=TARGET), 1, size)
    while not trial.is_over:
        trial.step()
    result = trial.result()
    is_home = result.docked == size and result.outcome is Outcome.SUCCEEDED and not result.penetrated
    return Return(f'{kind}, {size} robots, {result.area:.0f} m2', is_home, result.time - result.time_to(98),
                  f'{result.outcome.name}, {result.docked} docked, {result.coverage:.1%}: {result.message}')


# --- all of it --------------------------------------------------------------------------------------------------------

def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--pairs', type=int, default=200)
    parser.add_argument('--sizes', nargs='*', type=int, default=SIZES, help='of fleets; one of each on each floor')
    parser.add_argument('--kinds', nargs='+', choices=KINDS, default=KINDS, help='of floors')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        cases = pairs(arguments.kinds, arguments.pairs)
        if cases:
            figures.heading(f'{len(cases)} ordered pairs of docks in sight of each other, '
                            f'{len(arguments.kinds)} floors')
            show(executor.map(come_home, cases), LIMIT)
        cases = list(itertools.product(arguments.kinds, arguments.sizes))
        if cases:
            figures.heading(f'{len(cases)} fleets of {", ".join(map(str, arguments.sizes))} robots, docks at random '
                            'walls, to 98 %')
            show(executor.map(clean, cases), LATE)


def show(returns, late):
    """Print how robots came home, and a line for each that did not, or late [s]."""
    found = []
    for each in returns:
        found.append(each)
        if not each.is_home or each.seconds > late:
            print(f'  {each.name}: home {each.is_home}, {each.seconds:.0f} s, {each.message}', flush=True)
    figures.row('home', sum(each.is_home for each in found), at_least=len(found))
    figures.row('    median time [s]', statistics.median(each.seconds for each in found))
    figures.row('    longest time [s]', max(each.seconds for each in found), below=late)


if __name__ == '__main__':
    main()
