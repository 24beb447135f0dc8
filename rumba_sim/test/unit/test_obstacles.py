"""Obstacles that the map does not show: what touches them, what sees them, and which floor they take."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import PLANS, RADIUS, crooked, distances, drive, drove, positions, quiet, room
from things import HIGH, LOW, box, clutter, corners, disc, gaps, to_segment, walker

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import RECORD
from rumba_sim.model.kernel.records import OBSTACLE, ROBOT, TALLY
from rumba_sim.model.simulation.obstacle import LASER_HEIGHT, Obstacle
from rumba_sim.model.simulation.world import World

LEFT, RIGHT, BOTH, NONE = (True, False), (False, True), (True, True), (False, False)
EXACT = 1e-6  # [m]
HALL = room(6.0, 5.0)


def among(*obstacles, pose=Pose(1.0, 2.0, 0.0), plan=HALL, step_rate=50, **sections):
    """A world with obstacles and one robot without errors."""
    world = World(plan, quiet(**sections), step_rate, obstacles=obstacles)
    return world, world.spawn('rumba', pose)


# --- collisions ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('height', [HIGH, LOW])
def test_a_robot_stops_at_a_disc_ahead(height):
    world, robot = among(disc('leg', 2.0, 2.0, 0.05, height))
    drove(world, 0.3, 0.0, 400)
    assert robot.pose.x == approx(2.0 - 0.05 - RADIUS, abs=0.001) and robot.pose.y == approx(2.0)
    assert robot.bumper == BOTH and robot.bumps == 1 and robot.contact_angle == approx(0.0)


@pytest.mark.parametrize('beside, pressed', [(0.03, BOTH), (-0.03, BOTH), (0.1, LEFT), (-0.1, RIGHT)])
@pytest.mark.parametrize('theta', [0.0, 2.2, -1.0])
def test_a_disc_presses_the_side_on_which_it_is_at_the_angle_of_the_contact(beside, pressed, theta):
    ahead = 0.6
    x, y = 3.0 + ahead * math.cos(theta) - beside * math.sin(theta), 2.5 + ahead * math.sin(theta) + beside * math.cos(
        theta)
    world, robot = among(disc('leg', x, y, 0.04), pose=Pose(3.0, 2.5, theta))
    for _ in drive(world, 0.1, 0.0, 400):
        if robot.contact_angle is not None:
            break
    assert robot.contact_angle == approx(math.asin(beside / (RADIUS + 0.04)), abs=0.02)
    assert robot.bumper == pressed and robot.bumps == 1


def test_a_robot_slides_along_a_turned_box_with_the_component_of_its_speed():
    yaw = 0.6
    world, robot = among(box('sofa', 3.0, 3.0, yaw, 3.0, 0.4), pose=Pose(2.2, 1.6, math.pi / 2.0), drive={
        'acceleration': 1000.0})
    drove(world, 0.2, 0.0, 250)
    before = robot.pose
    after = drove(world, 0.2, 0.0, 50)
    assert math.atan2(after.y - before.y, after.x - before.x) == approx(yaw, abs=1e-6)
    assert math.hypot(after.x - before.x, after.y - before.y) == approx(0.2 * math.sin(yaw), abs=1e-6)
    assert robot.contact_angle == approx(yaw, abs=1e-6) and robot.bumper == LEFT
    assert min(gaps(world)) == approx(0.0, abs=0.001)


def test_the_corner_of_a_box_is_met_where_it_is():
    crate = box('crate', 3.0, 2.3, math.radians(45.0), 0.4, 0.4)
    world, robot = among(crate, pose=Pose(2.0, 2.3, 0.0))
    drove(world, 0.3, 0.0, 400)
    assert robot.pose.x == approx(3.0 - 0.2 * math.sqrt(2.0) - RADIUS, abs=0.001) and robot.bumper == BOTH


def test_a_contact_behind_presses_nothing():
    world, robot = among(disc('leg', 0.5, 2.05, 0.05))
    drove(world, -0.2, 0.0, 300)
    assert abs(robot.contact_angle) > 2.8 and robot.bumper == NONE and robot.bumps == 0


def test_a_robot_gets_between_two_discs_that_are_a_little_farther_apart_and_not_if_they_are_nearer():
    for apart, passes in ((2.0 * RADIUS + 0.004, True), (2.0 * RADIUS - 0.004, False)):
        y = 0.5 * apart + 0.05
        world, robot = among(disc('a', 2.0, 2.0 + y, 0.05), disc('b', 2.0, 2.0 - y, 0.05))
        drove(world, 0.3, 0.0, 500)
        assert (robot.pose.x > 2.5) is passes
        assert robot.bumper == (NONE if passes else BOTH)


@pytest.mark.thorough
@settings(max_examples=250, deadline=None)
@given(st.sampled_from(sorted(PLANS)), clutter(), st.sampled_from([10, 50]),
       st.lists(st.tuples(st.integers(0, 10 ** 6), st.floats(-3.1, 3.1), st.floats(-1.0, 1.0)), min_size=1, max_size=4))
def test_no_robot_ever_overlaps_an_obstacle_or_a_wall_or_is_moved_by_one(plan, obstacles, step_rate, drivers):
    world, speeds = World(PLANS[plan], quiet(drive={'acceleration': 1000.0}), step_rate), {}
    places = positions(PLANS[plan])
    for number, (where, theta, v) in enumerate(drivers):
        x, y = places[where % len(places)]
        try:
            world.spawn(f'r{number}', Pose(float(x), float(y), theta))
            speeds[f'r{number}'] = 0.4 * v if number else v  # the first may be beyond its limit
        except WorldError:
            continue
    for obstacle in obstacles:
        try:
            world.add_obstacle(obstacle)
        except WorldError:  # a robot stands there, or the mover is too fast for this step rate
            continue
    assume(world.obstacles.items and speeds)
    for tick in range(3 * step_rate):
        before = [robot.pose for robot in world.robots.values()]
        for name, v in speeds.items():
            still = tick > 2 * step_rate  # then only movers move
            world.robots[name].command(0.0 if still else v, 0.0 if still else 2.0 * v, world.tick)
        world.step()
        now = [robot.pose for robot in world.robots.values()]
        assert min(gaps(world)) >= -EXACT
        assert min(distances(world.plan, [pose[:2] for pose in now])) >= RADIUS - EXACT
        if tick > 2 * step_rate + 1:
            assert now == before


# --- the laser ----------------------------------------------------------------------------------------------------

def scan(*obstacles, pose=Pose(2.0, 2.0, 0.0), beams=360):
    """Ranges of a laser among obstacles, and in the same hall without them."""
    world, _ = among(*obstacles, pose=pose, laser={'beams': beams})
    bare, _ = among(pose=pose, laser={'beams': beams})
    return world.scan('rumba'), bare.scan('rumba')


def along(pose, beams, beam):
    """The direction of a beam: a unit vector in the map frame."""
    angle = pose.theta - math.pi + beam * 2.0 * math.pi / beams
    return math.cos(angle), math.sin(angle)


def to_disc(pose, ray, obstacle):
    """Distance along a ray to a disc, from the equation of its circle."""
    dx, dy = obstacle.pose.x - pose.x, obstacle.pose.y - pose.y
    ahead, aside = dx * ray[0] + dy * ray[1], dy * ray[0] - dx * ray[1]
    return ahead - math.sqrt(obstacle.radius ** 2 - aside ** 2) if ahead > 0.0 and abs(aside) < obstacle.radius else (
        math.inf)


def to_box(pose, ray, obstacle):
    """Distance along a ray to the nearest side of a box, by solving for the crossing with each of them."""
    points, found = corners(obstacle.pose, obstacle), math.inf
    for start, end in zip(points, np.roll(points, -1, axis=0)):
        matrix = np.array([ray, start - end]).T
        if abs(np.linalg.det(matrix)) > 1e-12:
            ahead, share = np.linalg.solve(matrix, start - pose[:2])
            if ahead > 0.0 and 0.0 <= share <= 1.0:
                found = min(found, float(ahead))
    return found


def test_ranges_to_a_disc_and_to_a_turned_box_at_known_angles():
    ranges, _ = scan(disc('leg', 3.0, 2.0, 0.1), box('crate', 2.0, 3.2, math.radians(45.0), 0.4, 0.4), beams=8)
    assert ranges[4] == approx(0.9)  # straight ahead
    assert ranges[6] == approx(1.2 - 0.2 * math.sqrt(2.0))  # to the left, the corner of the box
    assert ranges[2] == approx(2.0) and ranges[0] == approx(2.0)


@pytest.mark.parametrize('pose', [Pose(2.0, 2.0, 0.0), Pose(2.4, 3.1, 2.5), Pose(4.9, 1.1, -1.3)])
def test_every_beam_sees_the_nearest_of_wall_disc_and_box(pose):
    things = [disc('leg', 3.0, 2.3, 0.02), disc('bin', 1.1, 2.7, 0.3), box('crate', 3.6, 1.4, 0.5, 0.9, 0.2),
              box('shelf', 4.0, 4.0, -0.2, 0.3, 1.1)]
    ranges, bare = scan(*things, pose=pose)
    wanted = []
    for beam in range(360):
        rays = [min([bare[beam], *((to_disc if one.radius else to_box)(pose, along(pose, 360, beam + off), one)
                                   for one in things)]) for off in (-0.01, 0.0, 0.01)]
        wanted.append((rays[1], max(rays) - min(rays) > 0.05))
    errors = [abs(seen - far) for seen, (far, grazes) in zip(ranges, wanted) if not grazes]
    assert len(errors) > 340 and max(errors) < 1e-6
    assert sum(seen < far - 0.01 for seen, far in zip(ranges, bare)) > 40


def test_what_is_lower_than_the_laser_is_not_seen():
    ranges, bare = scan(disc('low', 3.0, 2.0, 0.1, LASER_HEIGHT), box('book', 2.0, 3.0, 0.2, 0.4, 0.3, LOW))
    assert ranges == approx(bare)
    ranges, bare = scan(disc('high', 3.0, 2.0, 0.1, LASER_HEIGHT + 0.001))
    assert ranges[180] == approx(0.9) and bare[180] == approx(4.0, abs=1e-5)


def test_walls_hide_obstacles_and_obstacles_beyond_the_range_are_not_seen():
    plan = room(6.0, 5.0, boxes=[(2.5, 0.0, 2.6, 5.0)])
    world, _ = among(disc('leg', 3.0, 2.0, 0.2), plan=plan)
    bare, _ = among(plan=plan)
    assert list(world.scan('rumba')) == list(bare.scan('rumba'))
    world, _ = among(box('crate', 4.0, 2.0, 0.3, 0.5, 0.5), laser={'range_max': 2.5})
    assert not np.isfinite(world.scan('rumba')[170:190]).any()


# --- the floor ----------------------------------------------------------------------------------------------------

def test_an_obstacle_from_the_start_takes_the_floor_that_it_makes_unreachable_as_a_wall_does():
    crate = box('crate', 3.0, 2.0, 0.0, 1.0, 0.5)
    areas = [World(plan, quiet(), obstacles=things).floor.reachable_area for plan, things in (
        (HALL, []), (HALL, [crate]), (room(6.0, 5.0, boxes=[(2.5, 1.75, 3.5, 2.25)]), []))]
    assert areas[0] - areas[1] > 0.7 and areas[1] == approx(areas[2], rel=0.001)


def test_obstacles_that_move_or_come_later_do_not_change_the_reachable_floor():
    world, _ = among(walker('cat', [(3.0, 1.0), (3.0, 4.0)]))
    bare, _ = among()
    area = bare.floor.reachable_area
    assert world.floor.reachable_area == area
    bare.add_obstacle(box('crate', 3.0, 2.0, 0.0, 1.0, 0.5))
    assert bare.floor.reachable_area == area
    bare.reset()
    assert bare.floor.reachable_area == area


def test_a_robot_sweeps_all_of_the_floor_around_an_obstacle_but_not_beneath_it():
    world, robot = among(disc('bin', 0.5, 0.5, 0.25), plan=room(1.0, 1.0), pose=Pose(0.18, 0.18, 0.0))
    for tick in range(5000):
        robot.command(0.3, 0.8 if robot.bumper != NONE else -0.4, world.tick)
        world.step()
    assert world.swept()[world.plan.cell(0.5, 0.5)] == -1 and world.floor.reachable_area < 0.6


# --- adding and removing ------------------------------------------------------------------------------------------

def test_obstacles_come_and_go_while_robots_drive():
    world, robot = among(pose=Pose(1.0, 2.0, 0.0))
    drove(world, 0.3, 0.0, 50)
    world.add_obstacle(disc('leg', 2.0, 2.0, 0.05))
    assert drove(world, 0.3, 0.0, 300).x < 2.0
    world.remove_obstacle('leg')
    assert drove(world, 0.3, 0.0, 100).x > 2.0 and robot.bumper == NONE


@pytest.mark.parametrize('obstacles', [[], [disc('leg', 2.0, 2.0, 0.05)]])
def test_records_keep_the_types_that_numba_knows_since_it_takes_long_to_compare_copies_of_them(obstacles):
    world, _ = among(*obstacles)
    for change in (world.reset, lambda: world.add_obstacle(disc('bin', 4.0, 2.0, 0.1)),
                   lambda: world.remove_obstacle('bin'), lambda: world.spawn('other'), lambda: world.kill('rumba')):
        restored = World.restored(world.state(), world.plan, world.config, obstacles=obstacles)
        for arrays in (world.arrays, restored.arrays):
            kept = arrays.robots, arrays.constants, arrays.obstacles, arrays.tally
            assert all(array.dtype is kind for array, kind in zip(kept, (ROBOT, RECORD, OBSTACLE, TALLY)))
        change()


@pytest.mark.parametrize('act, message', [
    (lambda world: world.add_obstacle(disc('leg', 4.0, 2.0, 0.1)), r"^'leg' is taken: obstacles are leg, crate$"),
    (lambda world: world.add_obstacle(disc('a leg', 4.0, 2.0, 0.1)),
     r"^'a leg' is not a valid name: must be 1 to 64 letters, digits and _, beginning with a letter$"),
    (lambda world: world.add_obstacle(disc('bin', 1.2, 2.0, 0.1)),
     r"^bin at \(1\.20, 2\.00\) m: 'rumba' stands there$"),
    (lambda world: world.add_obstacle(box('rug', 1.5, 2.0, 0.0, 0.8, 0.1)), r"'rumba' stands there$"),
    (lambda world: world.add_obstacle(disc('bin', 7.0, 2.0, 0.1)),
     r'^bin at \(7\.00, 2\.00\) m lies outside the map \(x -0\.05 to 6\.05 m, y -0\.05 to 5\.05 m\)$'),
    (lambda world: world.add_obstacle(disc('bin', math.nan, 2.0, 0.1)), r'^bin at \(nan, 2\.00\) m lies outside'),
    (lambda world: world.add_obstacle(walker('cat', [(3.0, 4.0), (3.0, 9.0)])), r'^cat at \(3\.00, 9\.00\) m lies'),
    (lambda world: world.add_obstacle(walker('car', [(3.0, 4.0), (5.0, 4.0)], 9.0)),
     r'^car moves too fast: at 50 ticks a second, must move by at most 8\.71\d* m/s, a radius of a robot in a tick$'),
    (lambda world: world.remove_obstacle('lamp'), r"^there is no obstacle 'lamp': obstacles are leg, crate$"),
    (lambda world: world.spawn('other', Pose(3.0, 2.0, 0.0)), r"^\(3\.00, 2\.00\) m: the obstacle 'crate' stands"),
    (lambda world: world.teleport('rumba', Pose(3.3, 2.0, 0.0)), r"m: the obstacle 'crate' stands there$")])
def test_what_makes_no_sense_is_refused_and_changes_nothing(act, message):
    world, _ = among(disc('leg', 2.0, 3.0, 0.05), box('crate', 3.0, 2.0, 0.3, 0.6, 0.4))
    before = world.digest()
    with pytest.raises(WorldError, match=message):
        act(world)
    assert world.digest() == before and list(world.obstacles.items) == ['leg', 'crate']


def test_what_moves_is_still_met_after_an_obstacle_was_refused():
    """A cat walks into the way of the robot, which stands in the way of a bin."""
    tried, alone = (among(walker('cat', [(2.0, 3.5), (2.0, 2.0)], pause=(60.0, 60.0))) for _ in range(2))
    drove(tried[0], 0.0, 0.0, 1)
    drove(alone[0], 0.0, 0.0, 1)
    with pytest.raises(WorldError, match='stands there$'):
        tried[0].add_obstacle(disc('bin', 1.2, 2.0, 0.1))
    for world, robot in (tried, alone):
        drove(world, 0.0, 0.0, 3200)
        drove(world, 0.3, 0.0, 200)
        assert robot.bumps == 1
    assert tried[0].digest() == alone[0].digest()


def test_there_are_at_most_so_many_obstacles(monkeypatch):
    monkeypatch.setattr('rumba_sim.model.simulation.obstacles.MOST', 2)
    world, _ = among(disc('a', 3.0, 3.0, 0.1), disc('b', 3.0, 4.0, 0.1))
    with pytest.raises(WorldError, match='^there are 2 obstacles already: remove one first$'):
        world.add_obstacle(disc('c', 4.0, 4.0, 0.1))


@pytest.mark.parametrize('where, what', [((3.5, 1.0), 'dock'), ((3.3, 1.0), 'dock'), ((0.5, 0.5), 'start')])
def test_an_obstacle_at_the_dock_or_at_the_start_is_refused(where, what):
    plan = crooked(dock=Pose(3.8, 1.0, 0.0), start=Pose(0.6, 0.6, 0.0))
    with pytest.raises(WorldError, match=rf"^'bin' stands at the {what}, \(\d\.\d0, \d\.\d0\) m: no robot fits there$"):
        World(plan, quiet(), obstacles=[disc('bin', *where, 0.35)])


def test_without_a_start_on_the_map_a_robot_begins_beside_the_obstacles():
    middle = World(HALL, quiet()).start
    crate = Obstacle('crate', middle, HIGH, length=1.0, width=1.0)
    world = World(HALL, quiet(), obstacles=[crate])
    robots = [world.spawn(str(number)) for number in range(3)]
    assert min(gaps(world)) > 0.0
    assert min(to_segment(robot.pose[:2], middle[:2], np.add(middle[:2], 0.01)) for robot in robots) > 0.6


def test_a_robot_whose_start_is_taken_by_an_obstacle_begins_beside_it_after_a_reset():
    world, robot = among(pose=Pose(1.0, 2.0, 0.0))
    drove(world, 0.3, 0.0, 200)
    world.add_obstacle(disc('bin', 1.0, 2.0, 0.2))
    world.reset()
    assert min(gaps(world)) >= 0.0 and list(world.obstacles.items) == ['bin']
