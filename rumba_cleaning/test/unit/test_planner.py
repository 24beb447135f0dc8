"""Whole plans, driven on paper and in the world: what they sweep, how long they are, and where they lead."""

import itertools
import math
import pathlib

import numpy as np
import pytest
from floors import BRUSH, along, knowing, length, tilted, two_rooms, wiped, wiped_but
from pytest import approx
from rooms import crooked, distances, quiet, room

from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.planning.planner import plan
from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.simulate import paper
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.simulation.world import World

MAPS = pathlib.Path(__file__).resolve().parents[3] / 'rumba_sim' / 'maps'
START = Pose(0.5, 0.5, 0.3)
FLOORS = {
    'crooked, 2 cm': lambda: crooked(0.02), 'crooked, 5 cm': crooked, 'crooked, 10 cm': lambda: crooked(0.1),
    'two doors': lambda: room(6.0, 2.4, 0.05, [(1.9, 0.0, 2.0, 0.3), (1.9, 1.0, 2.0, 2.4),
                                               (4.0, 0.0, 4.1, 1.5), (4.0, 2.2, 4.1, 2.4)]),
    'apartment': lambda: map_file.load(MAPS / 'apartment.yaml'), 'studio': lambda: map_file.load(MAPS / 'studio.yaml'),
    'field': lambda: map_file.load(MAPS / 'field.yaml'),
}


def driven(context, route):
    """The memory after a route was driven on paper."""
    swept = context.swept.copy()
    paper.drive(swept, route.waypoints)
    return swept


# --- whole floors --------------------------------------------------------------------------------------------------

def planned(context, pose, rounds=1):
    """The routes of several rounds, each driven on paper, and the memory after them."""
    context = context.with_target(context.target_coverage)
    context.swept, routes = context.swept.copy(), []
    for _ in range(rounds):
        route = plan(context, pose)
        if route is None or context.swept.coverage >= context.target_coverage:
            break
        paper.drive(context.swept, route.waypoints)
        pose = Pose(*route.waypoints[-1], 0.0)
        routes.append(route)
    return routes, context.swept


@pytest.mark.thorough(except_for=['end0-0.0-1.9'])
@pytest.mark.parametrize('end, left, right', [(Pose(0.5, 0.5, 0.0), 0.0, 1.9), (Pose(5.5, 0.5, 0.0), 4.1, 6.0)])
def test_a_plan_ends_near_where_it_should(end, left, right):
    start = Pose(3.0, 1.2, 0.0)
    context = knowing(FLOORS['two doors'](), start)
    route, anywhere = plan(context, start, end), plan(context, start)
    assert left < route.waypoints[-1][0] < right
    assert driven(context, route).coverage == approx(driven(context, anywhere).coverage, abs=0.01)


@pytest.mark.thorough
def test_within_a_room_too_a_plan_ends_near_where_it_should():
    start, corners = Pose(0.3, 0.3, 0.0), [Pose(0.3, 2.2, 0.0), Pose(3.7, 2.2, 0.0)]
    context = knowing(room(4.0, 2.5, 0.05, [(1.9, 1.1, 2.1, 1.3)]), start)
    ends = [plan(context, start, corner).waypoints[-1] for corner in corners]
    for corner, mine, other in zip(corners, ends, ends[::-1]):
        assert math.dist(mine, corner[:2]) < math.dist(other, corner[:2])


@pytest.mark.thorough(except_for=['two doors'])
@pytest.mark.parametrize('name', list(FLOORS))
def test_plans_reach_the_target_by_short_routes_that_keep_off_walls(name):
    floor_plan = FLOORS[name]()
    pose = floor_plan.start or floor_plan.dock or START
    context = knowing(floor_plan, pose)
    routes, swept = planned(context, pose, 4)
    assert tuple(routes[0].waypoints[0]) == pose[:2] and len(routes[0].speeds) == len(routes[0].waypoints) - 1
    assert swept.coverage >= context.config.target_coverage
    for route in routes:
        assert min(distances(floor_plan, route.waypoints)) >= context.robot.drive.radius - 0.01
        assert set(route.speeds) <= {context.config.speed, context.config.transit_speed}
    assert length(routes[0].waypoints) < 1.5 * context.swept.reachable_area / BRUSH
    assert sum(length(route.waypoints) for route in routes) < 1.9 * context.swept.reachable_area / BRUSH
    assert context.swept.coverage == 0.0  # to plan sweeps nothing


def test_a_robot_in_the_world_drives_along_a_plan_and_sweeps_what_it_promises():
    floor_plan = crooked()
    world = World(floor_plan, quiet())
    robot = world.spawn('rumba', START)
    context = knowing(floor_plan, START)
    route = plan(context, START)
    follower = Follower(route, world.config.drive)
    while not follower.is_done:
        command = follower.velocity(robot.pose, 0.1)
        robot.command(*command, world.tick)
        world.step(5)
        assert world.time < 350.0 and not follower.is_lost
    assert world.floor.coverage >= driven(context, route).coverage - 0.04


@pytest.mark.thorough(except_for=['crooked, 5 cm'])
@pytest.mark.parametrize('name', ['crooked, 5 cm', 'two doors', 'studio'])
def test_two_plans_for_the_same_floor_are_equal(name):
    routes = []
    for _ in range(2):
        floor_plan = FLOORS[name]()
        pose = floor_plan.dock or START
        routes.append(plan(knowing(floor_plan, pose), pose))
    assert (routes[0].waypoints == routes[1].waypoints).all() and (routes[0].speeds == routes[1].speeds).all()


@pytest.mark.thorough
def test_a_turned_floor_is_swept_by_as_short_a_route_as_a_straight_one():
    box, lengths = (1.2, 1.0, 1.5, 1.4), []
    for floor_plan in (tilted(4.0, 3.0, math.radians(25.0), 0.05, box), room(4.0, 3.0, 0.05, [box])):
        pose = floor_plan.most_open_pose()
        routes, swept = planned(knowing(floor_plan, pose), pose, 3)
        assert swept.coverage >= 0.99
        lengths.append(sum(length(route.waypoints) for route in routes) / swept.reachable_area)
    assert lengths[0] < 1.3 * lengths[1]


def test_a_plan_that_is_not_rehearsed_keeps_to_one_room_before_it_goes_to_the_next():
    floor_plan = FLOORS['two doors']()
    route = plan(knowing(floor_plan, START, planning_rounds=0), START)
    dense = along(route.waypoints, 0.05)
    rooms = np.digitize(dense[:, 0], [1.95, 4.05])
    inside = np.min(abs(dense[:, :1] - [1.95, 4.05]), axis=1) > 0.3
    changes = np.count_nonzero(np.diff(rooms[inside]))
    assert changes == 2 and rooms[inside][0] == 0 and rooms[inside][-1] == 2


@pytest.mark.parametrize('start', [Pose(2.0, 0.35, 0.0), Pose(5.0, 0.35, 0.0)])
def test_the_middle_of_a_corridor_in_which_a_second_ring_would_almost_touch_itself_is_driven_once(start):
    context = knowing(room(10.0, 0.7, 0.05), start, planning_rounds=0, target_coverage=0.95)
    route = plan(context, start)
    assert driven(context, route).coverage > 0.95
    assert length(route.waypoints) < 3.0 * 10.0 + 9.0  # both walls and the middle, and the way to an end


def test_a_wide_corridor_around_a_round_core_is_cleaned_in_rings():
    x, y = np.meshgrid(*[0.05 * np.arange(-36, 37)] * 2)
    away = np.hypot(x, y)
    floor_plan = FloorPlan('ring', np.where((away < 1.7) & (away > 0.7), FREE, OCCUPIED), 0.05, (-1.825, -1.825))
    start = Pose(1.2, 0.0, 0.5 * math.pi)
    context = knowing(floor_plan, start, target_coverage=0.98)
    rehearsal = Rehearsal(context, start, dense(plan(context, start)))
    assert rehearsal.swept.coverage >= 0.98
    assert rehearsal.seconds < 1.25 * context.swept.reachable_area / (BRUSH * context.config.speed)


@pytest.mark.parametrize('outer, width, most', [(1.53, 0.55, 1.6), (2.0, 0.55, 1.6), (1.53, 0.87, 1.15)])
def test_a_ring_corridor_that_its_rings_do_not_quite_fill_takes_one_more_pass_or_wider_ones(outer, width, most):
    """Two rings leave a broken line in the middle of the narrow; the wide one needs one less if they overlap less."""
    x, y = np.meshgrid(*[0.02 * np.arange(-110, 111)] * 2)
    away = np.hypot(x - 0.007, y - 0.004)
    floor_plan = FloorPlan('ring', np.where((away < outer) & (away > outer - width), FREE, OCCUPIED), 0.02,
                           (-2.21, -2.21))
    start = Pose(outer - 0.5 * width, 0.0, 0.5 * math.pi)
    context = knowing(floor_plan, start, target_coverage=0.98)
    rehearsal = Rehearsal(context, start, dense(plan(context, start)))
    assert rehearsal.swept.coverage >= 0.98
    assert rehearsal.seconds < most * context.swept.reachable_area / (BRUSH * context.config.speed)


def test_a_plan_is_driven_faster_between_its_lanes():
    floor_plan = FLOORS['two doors']()
    context = knowing(floor_plan, START, speed=0.2, transit_speed=0.4)
    route = plan(context, START)
    lengths = np.hypot(*np.diff(route.waypoints, axis=0).T)
    assert set(route.speeds) == {0.2, 0.4}
    assert 0.0 < lengths[route.speeds == 0.4].sum() < 0.15 * lengths.sum()


def test_a_plan_leads_around_obstacles_that_were_met():
    context = knowing(room(4.0, 3.0), START)
    post = np.array([2.0, 1.5])
    context.ground.mark(*post, 0.1)
    route = plan(context, START)
    assert min(np.hypot(*(along(route.waypoints) - post).T)) >= context.ground.reach + 0.1 - 0.01
    missed = np.argwhere(driven(context, route).missed())
    x, y = context.plan.centre(*missed.T.astype(float))
    near = np.hypot(x - post[0], y - post[1]) < 0.3
    assert near.any() and np.count_nonzero(~near) < 0.04 * context.swept.reachable_area / context.plan.resolution ** 2


def test_a_plan_for_the_last_spots_visits_only_as_many_as_the_target_needs():
    boxes = [(0.8, 0.8, 0.95, 0.9), (3.0, 0.8, 3.1, 0.9), (2.0, 2.2, 2.15, 2.3), (0.8, 2.2, 0.9, 2.3)]
    counts = []
    for target in (0.9999, 0.997, 0.9955, 0.99):
        context = wiped_but(knowing(room(4.0, 3.0, 0.02), START, target_coverage=target), *boxes)
        route = plan(context, START)
        near = along(route.waypoints) if route is not None else np.zeros((0, 2))
        counts.append(sum(any(np.hypot(*(near - [0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])]).T) < 0.05)
                          for box in boxes))
    assert counts[0] == 4 and counts == sorted(counts, reverse=True) and 0 < counts[2] < 4


# --- what was missed -----------------------------------------------------------------------------------------------

def test_a_plan_covers_only_what_was_missed():
    whole = plan(knowing(room(4.0, 3.0), START), START)
    context = wiped(knowing(room(4.0, 3.0), START), (2.0, 0.0, 4.0, 3.0))
    route = plan(context, START)
    assert length(route.waypoints) == approx(0.5 * length(whole.waypoints), rel=0.2)
    assert route.waypoints[:, 0].max() < 2.3
    assert driven(context, route).coverage >= 0.97


def test_after_a_part_of_a_plan_was_driven_a_new_plan_covers_the_rest():
    context = knowing(crooked(), START)
    whole = plan(context, START)
    half = whole.waypoints[:int(0.6 * len(whole.waypoints))]
    paper.drive(context.swept, half)
    before = context.swept.coverage
    assert 0.3 < before < 0.9
    pose = Pose(*half[-1], 0.0)
    route = plan(context, pose)
    assert tuple(route.waypoints[0]) == tuple(half[-1]) and driven(context, route).coverage >= 0.96
    assert length(route.waypoints) < 1.35 * length(whole.waypoints[len(half) - 1:])


def test_floor_that_cannot_be_reached_is_left_out():
    floor_plan = room(5.0, 2.4, 0.05, [(2.8, 0.0, 2.9, 2.4)])
    context = knowing(floor_plan, Pose(4.0, 1.0, 0.0))
    assert plan(context, START) is None  # all cells to clean lie beyond the wall
    route = plan(context, Pose(4.0, 1.0, 0.0))
    assert route.waypoints[:, 0].min() > 2.9 and driven(context, route).coverage >= 0.96


def test_a_crumb_is_visited_although_most_of_what_was_missed_cannot_be_reached():
    context = knowing(two_rooms(0.02), START, target_coverage=1.0)
    wiped(wiped(wiped(wiped(context, (0.0, 0.0, 2.8, 1.1)), (0.0, 1.3, 2.8, 2.4)), (0.0, 1.1, 1.4, 1.3)),
          (1.6, 1.1, 2.8, 1.3))
    context.ground.mark(2.85, 0.65, 0.25)  # somebody has closed the door
    route = plan(context, START)
    assert np.hypot(*(along(route.waypoints) - (1.5, 1.2)).T).min() < 0.05 and route.waypoints[:, 0].max() < 2.8


def test_a_patch_is_cleaned_in_lanes_although_most_of_what_was_missed_lies_under_an_obstacle():
    patch = (0.8, 1.0, 1.6, 1.8)
    context = wiped_but(knowing(room(4.0, 3.0, 0.02), START), patch, (2.4, 1.0, 3.6, 1.8))
    for x, y in itertools.product((2.5, 2.75, 3.0, 3.25, 3.5), (1.1, 1.4, 1.7)):
        context.ground.mark(x, y, 0.15, stays=True)
    missed = driven(context, plan(context, START)).missed()
    x, y = context.plan.centre(*np.argwhere(missed).T.astype(float))
    left, bottom, right, top = patch
    left_over = np.count_nonzero((x > left) & (x < right) & (y > bottom) & (y < top)) * context.plan.resolution ** 2
    assert left_over < 0.1 * (right - left) * (top - bottom)


def test_what_obstacles_enclose_keeps_no_plan_from_the_rest():
    """A way that the tour takes to be open leads into a pocket from which no path leads out."""
    context = wiped_but(knowing(room(4.0, 3.0, 0.02), START, target_coverage=1.0), (3.0, 1.0, 3.2, 1.2),
                        (3.5, 1.0, 3.7, 1.2))
    context.ground.mark(3.55, 0.85, 0.2, stays=True)
    context.ground.mark(3.55, 1.45, 0.2, stays=True)
    route = plan(context, START)
    assert np.hypot(*(along(route.waypoints) - (3.1, 1.1)).T).min() < 0.05


def test_there_is_no_plan_if_nothing_was_missed():
    assert plan(wiped(knowing(crooked(), START), (0.0, 0.0, 4.0, 3.0)), START) is None
