"""The laser against an independent, slow and simple ray caster."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import PILLARS, RADIUS, alone, crooked, drove, quiet, room, squares

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import constants
from rumba_sim.model.kernel.sensors import beams
from rumba_sim.model.kernel.sensors.beams import NUDGE
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.simulation.world import World

POSES = [Pose(0.5, 0.5, 0.0), Pose(2.1, 1.3, 0.7), Pose(3.6, 2.7, -2.0), Pose(1.83, 2.41, math.pi),
         Pose(2.0, 0.4, math.pi / 2.0), Pose(0.4, 1.0, -math.pi / 2.0)]
GRAZE = 1e-4  # [rad] a beam that passes a corner within this angle may see either side of it
RANGE = 8.0


def ray(plan, x, y, angle):
    """Distance along a ray to the nearest square that is not free, by the slab method."""
    low = squares(plan) - (x, y)
    along = np.array([math.cos(angle), math.sin(angle)])
    with np.errstate(divide='ignore', invalid='ignore'):
        one, two = low / along, (low + plan.resolution) / along
    enter, leave = np.fmin(one, two).max(axis=1), np.fmax(one, two).min(axis=1)
    return float(np.min(enter[(enter <= leave) & (leave >= 0.0)], initial=math.inf))


def disc(x, y, angle, other):
    """Distance along a ray to another robot, from the equation of its circle."""
    dx, dy = other.x - x, other.y - y
    along, across = dx * math.cos(angle) + dy * math.sin(angle), dy * math.cos(angle) - dx * math.sin(angle)
    if along < 0.0 or abs(across) > RADIUS:
        return math.inf
    return along - math.sqrt(RADIUS ** 2 - across ** 2)


def expected(plan, pose, beams=360, others=()):
    """What each beam sees: (range, whether a beam at the angle GRAZE to it would see something else)."""
    result = []
    for beam in range(beams):
        angle = pose.theta - math.pi + beam * 2.0 * math.pi / beams
        ranges = [min([ray(plan, pose.x, pose.y, angle + off), *(disc(pose.x, pose.y, angle + off, other)
                                                                 for other in others)])
                  for off in (-GRAZE, 0.0, GRAZE)]
        result.append((ranges[1], max(ranges) - min(ranges) > 0.01))
    return result


def differences(scan, wanted, range_max=RANGE):
    """Errors of a scan [m], without the beams that graze a corner."""
    pairs = [(seen, far) for seen, (far, grazes) in zip(scan, wanted) if not grazes]
    return [0.0 if seen == math.inf and far >= range_max - 1e-6 else abs(seen - far) for seen, far in pairs]


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
@pytest.mark.parametrize('pose', POSES)
def test_every_beam_sees_the_wall_where_it_is(pose, resolution):
    plan = crooked(resolution)
    world, _ = alone(pose, plan)
    wanted = expected(plan, pose)
    off = differences(world.scan('rumba'), wanted)
    assert len(off) > 330
    assert max(off) < 2e-8


def test_a_mirrored_laser_or_a_flipped_map_is_noticed():
    plan = crooked()
    for pose in POSES[:3]:
        scan = alone(pose, plan)[0].scan('rumba')
        wanted = expected(plan, pose)
        for wrong in (np.roll(scan[::-1], 1), np.roll(scan, 1), np.roll(scan, 180)):
            assert max(differences(wrong, wanted)) > 0.1
        flipped = FloorPlan('flipped', plan.occupancy[::-1], plan.resolution, plan.origin)
        assert max(differences(scan, expected(flipped, pose))) > 0.1


def test_beams_go_counter_clockwise_from_straight_back():
    plan = room(6.0, 4.0)
    world, _ = alone(Pose(1.0, 1.5, 0.0), plan, laser={'beams': 4})
    assert list(world.scan('rumba')) == approx([1.0, 1.5, 5.0, 2.5], abs=1e-6)
    world.teleport('rumba', Pose(1.0, 1.5, math.pi / 2.0))
    assert list(world.scan('rumba')) == approx([1.5, 5.0, 2.5, 1.0], abs=1e-6)


@pytest.mark.parametrize('beams', [1, 2, 7, 360, 1000])
def test_a_scan_has_as_many_beams_as_it_is_set_to(beams):
    plan = crooked()
    world, _ = alone(POSES[1], plan, laser={'beams': beams})
    scan = world.scan('rumba')
    assert scan.shape == (beams,) and scan.dtype == np.float64
    assert max(differences(scan, expected(plan, POSES[1], beams)), default=0.0) < 2e-8
    world.config = quiet(laser={'beams': 16})
    assert max(differences(world.scan('rumba'), expected(plan, POSES[1], 16)), default=0.0) < 2e-8


def test_too_far_is_plus_infinity_and_too_near_minus_infinity():
    world, _ = alone(Pose(0.5, 2.0, 0.0), room(6.0, 4.0), laser={'beams': 4, 'range_min': 0.6, 'range_max': 3.0})
    assert list(world.scan('rumba')) == approx([-math.inf, 2.0, math.inf, 2.0], abs=1e-6)


@pytest.mark.parametrize('theta', [0.0, 1.0, 3.0, -2.2])
@pytest.mark.parametrize('bearing', [0.0, 1.6, math.pi, -3.1, -0.9])
@pytest.mark.parametrize('away', [2.0 * RADIUS + 0.001, 0.6, 1.5])
def test_another_robot_is_seen_as_its_circle(theta, bearing, away):
    plan = room(6.0, 5.0)
    pose = Pose(2.5, 2.2, theta)
    world, robot = alone(pose, plan)
    other = Pose(2.5 + away * math.cos(theta + bearing), 2.2 + away * math.sin(theta + bearing), 0.3)
    world.spawn('other', other)
    scan = world.scan('rumba')
    wanted = expected(plan, robot.pose, others=[other])
    assert max(differences(scan, wanted)) < 2e-8
    assert min(scan) == approx(away - RADIUS, abs=0.02)
    assert sum(far < 2.0 and not grazes for far, grazes in wanted) > 10


def test_walls_hide_robots_and_a_robot_does_not_see_itself():
    plan = room(4.0, 2.0, boxes=[(1.9, 0.0, 2.0, 1.5)])
    world, robot = alone(Pose(1.0, 0.5, 0.2), plan)
    without = world.scan('rumba')
    world.spawn('other', Pose(3.0, 0.5, 0.0))
    assert list(world.scan('rumba')) == list(without)
    assert min(without) == approx(0.5, abs=0.001)


def test_a_robot_beyond_the_range_is_not_seen_but_its_near_side_is():
    limits = {'beams': 4, 'range_max': 2.0}
    world, _ = alone(Pose(5.0, 10.0, 0.0), laser=limits)
    world.spawn('other', Pose(7.0 + RADIUS + 0.01, 10.0, 0.0))
    assert math.isinf(world.scan('rumba')[2])
    world.teleport('other', Pose(7.0 + RADIUS - 0.01, 10.0, 0.0))
    assert world.scan('rumba')[2] == approx(1.99)


def test_noise_has_its_deviation_its_seed_and_no_bias():
    scans = []
    for seed in (1, 1, 2):
        world = World(room(4.0, 4.0), quiet(laser={'noise': 0.02}), seed=seed)
        world.spawn('rumba', Pose(1.5, 2.2, 0.4))
        scans.append(np.array([world.scan('rumba') for _ in range(20)]))
    assert (scans[0] == scans[1]).all() and (scans[0] != scans[2]).all()
    exact = alone(Pose(1.5, 2.2, 0.4), room(4.0, 4.0))[0].scan('rumba')
    errors = scans[0] - exact
    assert np.std(errors) == approx(0.02, rel=0.05) and np.mean(errors) == approx(0.0, abs=0.001)
    assert abs(np.corrcoef(errors[0], errors[1])[0, 1]) < 0.2


def test_a_range_with_noise_is_within_its_limits_or_infinite():
    far = World(room(9.0, 9.0, start=Pose(1.002, 4.5, 0.0)), seed=4)  # 7.998 m from the wall ahead
    far.spawn('rumba')
    ranges = np.concatenate([far.scan('rumba') for _ in range(300)])
    near = ranges[np.isfinite(ranges)]
    assert 7.99 < near.max() < 8.0 and near.min() >= 0.12 and np.isposinf(ranges).sum() > 300


@pytest.mark.parametrize('resolution', [0.02, 0.0625, 0.05])
def test_beams_along_the_borders_of_cells_are_exact_and_take_no_more_steps_than_there_are_cells(
        resolution, monkeypatch):
    grid = np.full((80, 80), OCCUPIED, np.int8)
    grid[1:-1, 1:-1] = FREE
    plan = FloorPlan('borders', grid, resolution, (0.0, 0.0))
    k = constants(quiet(), plan, 50)[0]
    steps = []
    to_border = beams.to_border
    monkeypatch.setattr(beams, 'to_border', lambda *args: steps.append(args) or to_border(*args))
    for node in range(12, 68, 4):
        for turn in range(4):
            angle = (turn - 2) * math.pi / 2.0  # its sine or cosine is nearly 0
            x, y = node * resolution, (80 - node) * resolution
            steps.clear()
            distance = beams.cast(k, plan.skips, x, y, math.cos(angle), math.sin(angle), RANGE)
            assert distance == approx(ray(plan, x, y, angle + 1e-5), abs=1e-4)
            assert len(steps) < 200


@pytest.mark.parametrize('resolution, origin', [(0.02, (0.0, 0.0)), (0.05, (-1.3, 2.7)), (0.1, (4.1, -7.3))])
@pytest.mark.parametrize('mirrors', [(1, 1), (1, -1), (-1, 1), (-1, -1)])
@pytest.mark.parametrize('columns, rows', [(1, 0), (4, 0), (9, 0), (0, 1), (0, 7), (3, 4), (4, 3), (12, 5), (8, 15)])
def test_a_beam_whose_skip_ends_at_the_border_of_a_wall_meets_it_there(resolution, origin, mirrors, columns, rows):
    """The nearest corner of the wall is a whole number of cells away from a node, in all four directions."""
    grid = np.full((50, 60), FREE, np.int8)
    grid[20 + rows:, 21 + columns:] = OCCUPIED
    plan = FloorPlan('wall', grid[::mirrors[1], ::mirrors[0]], resolution, origin)
    node = [21 if mirrors[0] > 0 else 60 - 21, 20 if mirrors[1] > 0 else 50 - 20]
    x, y = (start + number * resolution for start, number in zip(origin, node))
    cells = math.hypot(columns, rows)
    along_x, along_y = mirrors[0] * columns / cells, mirrors[1] * rows / cells
    # Beams along an axis start in the middle of a border, so that they do not run along the edge of the wall.
    x, y = x + mirrors[0] * 0.5 * resolution * (columns == 0), y + mirrors[1] * 0.5 * resolution * (rows == 0)
    distance = beams.cast(constants(quiet(), plan, 50)[0], plan.skips, x, y, along_x, along_y, RANGE)
    assert distance == approx(cells * resolution, abs=2.0 * NUDGE * resolution)


def test_a_scan_does_not_change_the_world():
    world, robot = alone(POSES[1], crooked())
    before = world.digest()
    world.scan('rumba')
    assert world.digest() == before


def test_a_robot_that_moved_scans_from_its_new_pose():
    plan = room(4.0, 3.0, boxes=PILLARS)
    world, robot = alone(POSES[0], plan)
    drove(world, 0.3, 0.3, 60)
    assert max(differences(world.scan('rumba'), expected(plan, robot.pose))) < 2e-8
