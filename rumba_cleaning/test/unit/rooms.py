"""Floor plans and robots for the tests of the model, and exact distances on these plans, computed square by square."""

import functools
import itertools
import math

import numpy as np
from hypothesis import strategies as st

from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

RADIUS = RobotConfig().drive.radius
PILLARS = ((1.2, 0.4, 1.5, 0.9), (2.6, 1.6, 2.9, 2.6), (0.3, 2.0, 0.7, 2.2))


def room(width, height, resolution=0.05, boxes=(), **kwargs):
    """A room [m] with its inner lower left corner at (0, 0), a wall of one cell around it, and boxes in it.

    A box is (left, bottom, right, top) [m]; `cliff` and `carpet` are given as boxes too. A plan never changes, so that
    the same one serves all tests.
    """
    others = tuple((name, tuple(value) if isinstance(value, list) else value) for name, value in kwargs.items())
    return _room(width, height, resolution, tuple(boxes), others)


@functools.lru_cache(maxsize=20)
def _room(width, height, resolution, boxes, others):
    kwargs = dict(others)
    rows, columns = round(height / resolution) + 2, round(width / resolution) + 2
    grid = np.full((rows, columns), OCCUPIED, np.int8)
    grid[1:-1, 1:-1] = FREE
    for box in boxes:
        grid[inside(box, rows, columns, resolution)] = OCCUPIED
    for layer in ('cliff', 'carpet'):
        if layer in kwargs:
            kwargs[layer] = inside(kwargs[layer], rows, columns, resolution)
    return FloorPlan('room', grid, resolution, (-resolution, -resolution), **kwargs)


def inside(box, rows, columns, resolution):
    """The cells of a room whose centres lie in a box: bool (rows, columns)."""
    left, bottom, right, top = box
    x, y = (np.arange(columns) - 0.5) * resolution, (np.arange(rows)[:, np.newaxis] - 0.5) * resolution
    return (x > left) & (x < right) & (y > bottom) & (y < top)


def crooked(resolution=0.05, **kwargs):
    """A room without any symmetry."""
    return room(4.0, 3.0, resolution, PILLARS, **kwargs)


def quiet(**sections):
    """A robot whose wheels and laser have no errors; sections such as `drive={'max_speed': 1.0}` change more."""
    exact = updated(RobotConfig(), {
        'odometry': {'scale_error': 0.0, 'noise': 0.0, 'floor_traction': 1.0}, 'laser': {'noise': 0.0}}, 'quiet')
    return updated(exact, sections, 'test')


@functools.lru_cache(maxsize=None)
def hall():
    """An empty hall of 20 m x 20 m, which takes a third of a second: a plan never changes."""
    return room(20.0, 20.0, 0.1)


def alone(pose=Pose(10.0, 10.0, 0.0), plan=None, step_rate=50, **sections):
    """A world with one quiet robot, in a hall of 20 m x 20 m if no other plan is given."""
    world = World(plan or hall(), quiet(**sections), step_rate)
    return world, world.spawn('rumba', pose)


def drive(world, v, w, ticks, name='rumba'):
    """Command a robot in each tick; yields its true pose after each."""
    robot = world.robots[name]
    for _ in range(ticks):
        robot.command(v, w, world.tick)
        world.step()
        yield robot.pose


def drove(world, v, w, ticks, name='rumba'):
    """The pose after a number of ticks of driving."""
    return list(drive(world, v, w, ticks, name))[-1]


@functools.lru_cache(maxsize=16)
def squares(plan):
    """Lower left corners [m] of all cells that are not free, with a ring around the grid: float64 (any, 2)."""
    blocked = np.pad(~plan.free, 1, mode='constant', constant_values=True)
    return (np.argwhere(blocked)[:, ::-1] - 1) * plan.resolution + plan.origin


def distances(plan, points):
    """Exact distance from each point (any, 2) to the nearest obstacle [m]: float64 (any)."""
    corners = squares(plan)
    result = []
    for point in np.asarray(points, float).reshape(-1, 2):
        away = np.maximum(np.maximum(corners - point, point - corners - plan.resolution), 0.0)
        result.append(math.sqrt(np.min(np.sum(away ** 2, axis=1))))
    return np.array(result)


# --- rooms that are hard to drive in -------------------------------------------------------------------------------

def gaps(resolution):
    """Walls with gaps that are a little wider than a robot, just as wide, and narrower."""
    return room(3.0, 2.4, resolution, [
        (0.9, 0.0, 1.0, 0.6), (0.9, 0.98, 1.0, 1.5), (0.9, 1.86, 1.0, 2.4),
        (1.9, 0.0, 2.2, 0.4), (1.9, 0.75, 2.2, 1.3), (1.9, 1.72, 2.2, 2.4)])


def slanted(resolution):
    """A wall at 30 degrees, one at -60 degrees and a round pillar, drawn on a grid."""
    size = resolution / 2.0
    dots = [(0.4 + 0.866 * along, 1.2 + 0.5 * along) for along in np.arange(0.0, 1.2, size)]
    dots += [(1.8 + 0.5 * along, 1.0 - 0.866 * along) for along in np.arange(0.0, 1.0, size)]
    dots += [(2.5 + reach * math.cos(angle), 1.8 + reach * math.sin(angle))
             for reach, angle in itertools.product(np.arange(0.0, 0.25, size), np.arange(0.0, 6.3, 0.1))]
    return room(3.0, 2.4, resolution, [(x - size, y - size, x + size, y + size) for x, y in dots])


def legs(resolution):
    """Legs of furniture, one cell each."""
    points = np.random.default_rng(8).uniform((0.3, 0.3), (2.7, 2.1), (9, 2))
    size = resolution / 2.0
    return room(3.0, 2.4, resolution, [(x - size, y - size, x + size, y + size) for x, y in points])


PLANS = {(shape.__name__, resolution): shape(resolution) for shape, resolution in itertools.product(
    (crooked, gaps, slanted, legs), (0.02, 0.05, 0.1))}


def positions(plan):
    """Nodes at which a robot fits, with a margin of 1 cm: float64 (any, 2) [m]."""
    nodes = np.argwhere(plan.clearance >= RADIUS + 0.01)[:, ::-1]
    return nodes * plan.resolution + plan.origin


POSITIONS = {name: positions(plan) for name, plan in PLANS.items()}
DENT = Pose(2.0183859793980674, 0.1756949508663332, -0.4420871324757756)  # beside one, in the plan ('slanted', 0.05)
NAMES = st.sampled_from(sorted(PLANS))
STARTS = st.tuples(st.integers(0, 10 ** 6), st.floats(-3.1, 3.1))


def start(name, where):
    """A pose in a plan from an example of STARTS."""
    index, theta = where
    x, y = POSITIONS[name][index % len(POSITIONS[name])]
    return Pose(float(x), float(y), theta)
