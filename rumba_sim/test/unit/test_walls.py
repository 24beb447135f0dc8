"""The exact distance to the walls, and robots where the interpolated clearance is too small."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import DENT, PLANS, RADIUS, distances, drive, drove, quiet, room
from things import disc

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.floors.constants import constants
from rumba_sim.model.kernel import motion, walls
from rumba_sim.model.kernel.ground import BLOCKED
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.world import World


def inputs(plan):
    """What the kernel has of a plan: constants, clearance and cells."""
    return constants(quiet(), plan, 50)[0], plan.clearance, np.where(plan.free, 0, BLOCKED).astype(np.uint8)


@pytest.mark.parametrize('name', sorted(PLANS))
def test_the_distance_to_walls_is_exact_everywhere(name):
    plan = PLANS[name]
    left, bottom, right, top = plan.bounds
    points = np.random.default_rng(3).uniform((left, bottom), (right, top), (400, 2))
    found = [fast.wall_distance(*inputs(plan), *point) for point in points]
    assert found == approx(distances(plan, points), abs=1e-12)
    assert 0.0 in found and max(found) > 0.2
    plain = [walls.wall_distance(*inputs(plan), *point) for point in points[:20]]
    assert plain == found[:20]


@pytest.mark.parametrize('x, y', [(-0.2, 1.0), (1.0, -0.2), (4.3, 1.0), (1.0, 3.3), (math.nan, 1.0), (1.0, math.inf)])
def test_there_is_no_distance_to_walls_outside_the_map(x, y):
    assert fast.wall_distance(*inputs(room(4.0, 3.0)), x, y) == 0.0


def test_beyond_the_edge_of_the_map_there_is_a_wall():
    plan = FloorPlan('bare', np.zeros((40, 60), np.int8), 0.05, (1.0, -2.0))
    assert fast.wall_distance(*inputs(plan), 1.3, -1.0) == approx(0.3)
    assert fast.wall_distance(*inputs(plan), 2.0, -0.11) == approx(0.11)


@pytest.fixture
def dented():
    """A world in which a robot has backed into a dent of the clearance, which is 0.4 mm too small for it."""
    world = World(PLANS[('slanted', 0.05)], quiet(drive={'acceleration': 1000.0}))
    pose = world.spawn('rumba', DENT).pose
    drove(world, -0.3, 0.0, 1)
    assert moved(pose, world.robots['rumba'].pose) == approx(0.006)
    assert gap(world) < -0.0003
    return world


def moved(before, after):
    """Way from a pose to another [m]."""
    return math.hypot(after.x - before.x, after.y - before.y)


def gap(world):
    """How much more clearance the robot has than it needs [m]."""
    return world.terrain.clearance_at(*world.robots['rumba'].pose[:2]) - world.constants[0]['reach']


@pytest.mark.parametrize('v', [0.02, -0.02, 0.3, -0.3])
def test_in_a_dent_a_robot_goes_as_its_wheels_turn(dented, v):
    before = dented.robots['rumba'].pose
    after = drove(dented, v, 0.0, 1)
    assert (after.x - before.x, after.y - before.y) == approx(
        (0.02 * v * math.cos(DENT.theta), 0.02 * v * math.sin(DENT.theta)))


@pytest.mark.parametrize('kind', ['disc', 'robot'])
def test_through_a_dent_a_robot_drives_into_nothing_else(kind):
    world = World(PLANS[('slanted', 0.05)], quiet(drive={'acceleration': 1000.0}))
    robot = world.spawn('rumba', DENT)
    size = RADIUS if kind == 'robot' else 0.05
    far = RADIUS + size + 0.003
    x, y = DENT.x - far * math.cos(DENT.theta), DENT.y - far * math.sin(DENT.theta)
    if kind == 'robot':
        world.spawn('other', Pose(x, y, 0.0))
    else:
        world.add_obstacle(disc('leg', x, y, size))
    for pose in drive(world, -0.3, 0.0, 25):
        assert math.hypot(pose.x - x, pose.y - y) >= RADIUS + size
    assert robot.distance < 0.02


@pytest.mark.parametrize('theta', np.arange(-3.1, 3.1, 0.5))
def test_a_robot_never_enters_a_wall_from_a_dent_and_can_leave_it_in_the_end(dented, theta):
    dented.robots['rumba'].state['theta'] = theta
    path = [*drive(dented, 0.05, 0.0, 100), *drive(dented, -0.05, 0.0, 1)]
    assert min(distances(dented.plan, [pose[:2] for pose in path])) >= RADIUS
    dented.robots['rumba'].state['theta'] = DENT.theta
    assert moved(path[-1], drove(dented, -0.3, 0.0, 25)) == approx(0.15, abs=0.01)


def test_a_robot_stands_in_a_dent_if_its_wheels_turn_against_each_other_except_for_rounding(dented):
    before, state = dented.robots['rumba'].pose, dented.robots['rumba'].state
    for move in (motion.move, fast.move):
        state['left_speed'], state['right_speed'] = -0.1, np.nextafter(0.1, 1.0)
        move(dented.arrays.robots, 0, dented.constants[0], dented.arrays.obstacles, dented.terrain.clearance,
             dented.floor.cells, 0)
        assert state['theta'] > before.theta and dented.robots['rumba'].pose[:2] == before[:2]
