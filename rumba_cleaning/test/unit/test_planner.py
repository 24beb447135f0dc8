"""Whole plans, driven on paper and in the world: what they sweep, how long they are, and where they lead."""

import math
import pathlib

import numpy as np
import pytest
from floors import BRUSH, along, knowing, length, tilted, wiped
from pytest import approx
from rooms import crooked, distances, quiet, room

from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.planning import crumbs, planner
from rumba_cleaning.planning.planner import plan
from rumba_cleaning.planning.tour import tour
from rumba_sim.model import kernel, map_file
from rumba_sim.model.geometry import Pose
from rumba_sim.model.world import World

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
    crumbs.drive(swept, route.waypoints)
    return swept


# --- whole floors --------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('name', list(FLOORS))
def test_a_plan_reaches_the_target_by_a_short_route_that_keeps_off_walls(name):
    floor_plan = FLOORS[name]()
    pose = floor_plan.start or floor_plan.dock or START
    context = knowing(floor_plan, pose)
    route = plan(context, pose)
    assert tuple(route.waypoints[0]) == pose[:2] and len(route.speeds) == len(route.waypoints) - 1
    assert driven(context, route).coverage >= context.config.target_coverage
    assert min(distances(floor_plan, route.waypoints)) >= context.ground.reach - 0.01
    assert length(route.waypoints) < 1.6 * context.swept.reachable_area / BRUSH
    assert set(route.speeds) == {context.config.speed, context.config.transit_speed}
    assert context.swept.coverage == 0.0  # to plan sweeps nothing


def test_a_robot_in_the_world_drives_along_a_plan_and_sweeps_what_it_promises():
    floor_plan = crooked()
    world = World(floor_plan, quiet())
    robot = world.spawn('rumba', START)
    follower = Follower(plan(knowing(floor_plan, START), START), world.config.drive)
    while not follower.is_done:
        command = follower.velocity(robot.pose, 0.1)
        robot.command(*command, world.tick)
        world.step(5)
        assert world.time < 350.0 and not follower.is_lost
    assert world.floor.coverage >= 0.99


@pytest.mark.parametrize('name', ['crooked, 5 cm', 'two doors', 'studio'])
def test_two_plans_for_the_same_floor_are_equal(name):
    routes = []
    for _ in range(2):
        floor_plan = FLOORS[name]()
        pose = floor_plan.dock or START
        routes.append(plan(knowing(floor_plan, pose), pose))
    assert (routes[0].waypoints == routes[1].waypoints).all() and (routes[0].speeds == routes[1].speeds).all()


def test_a_turned_floor_is_planned_along_its_own_walls():
    angle = math.radians(25.0)
    floor_plan = tilted(4.0, 3.0, angle, 0.05, (1.2, 1.0, 1.5, 1.4))
    pose = floor_plan.most_open_pose()
    context = knowing(floor_plan, pose)
    route = plan(context, pose)
    assert driven(context, route).coverage >= 0.99
    assert length(route.waypoints) < 1.6 * context.swept.reachable_area / BRUSH
    steps = np.diff(route.waypoints, axis=0)
    lengths = np.hypot(*steps.T)
    turned = (np.arctan2(steps[:, 1], steps[:, 0]) - angle + math.pi / 4.0) % (math.pi / 2.0) - math.pi / 4.0
    assert lengths[abs(turned) < 0.05].sum() > 0.7 * lengths.sum()


def test_a_plan_keeps_to_one_room_before_it_goes_to_the_next():
    floor_plan = FLOORS['two doors']()
    route = plan(knowing(floor_plan, START), START)
    dense = along(route.waypoints, 0.05)
    rooms = np.digitize(dense[:, 0], [1.95, 4.05])
    inside = np.min(abs(dense[:, :1] - [1.95, 4.05]), axis=1) > 0.3
    changes = np.count_nonzero(np.diff(rooms[inside]))
    assert changes == 2 and rooms[inside][0] == 0 and rooms[inside][-1] == 2


def test_a_plan_leaves_each_room_near_the_next_one_and_goes_on_from_there(monkeypatch):
    calls, entries = [], []

    def spy(floor, start, stretches, end=None):
        calls.append((start, end))
        entries.append([len({tuple(variant[0]) for variant in stretch.variants}) for stretch in stretches])
        return tour(floor, start, stretches, end)

    monkeypatch.setattr(planner, 'tour', spy)
    route = plan(knowing(FLOORS['two doors'](), START), START)
    order, *rooms = calls
    assert len(rooms) == 3 and tuple(order[0]) == tuple(rooms[0][0]) == START[:2]
    for (start, _), edges in zip(rooms[1:], ((0.0, 2.3), (2.0, 4.4))):  # in the room before, doors included
        assert edges[0] < start[0] < edges[1] and tuple(start) in set(map(tuple, route.waypoints.tolist()))
    for (_, end), edges in zip(rooms, ((1.7, 4.4), (3.7, 6.0))):
        assert edges[0] < end[0] < edges[1]
    assert rooms[2][1] is None
    assert min(min(counts) for counts in entries[1:]) >= 2  # each stretch can be begun from either end


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
    missed = driven(context, route).missed()
    rows, columns = np.nonzero(missed)
    near = np.hypot((columns - 0.5) * 0.05 - 2.0, (rows - 0.5) * 0.05 - 1.5) < 0.3
    assert near.any() and np.count_nonzero(~near) < 0.01 * context.swept.reachable_area / 0.05 ** 2


# --- what was missed -----------------------------------------------------------------------------------------------

def test_a_plan_covers_only_what_was_missed():
    whole = plan(knowing(room(4.0, 3.0), START), START)
    context = wiped(knowing(room(4.0, 3.0), START), (2.0, 0.0, 4.0, 3.0))
    route = plan(context, START)
    assert length(route.waypoints) == approx(0.5 * length(whole.waypoints), rel=0.12)
    assert route.waypoints[:, 0].max() < 2.2
    assert driven(context, route).coverage >= 0.99


def test_after_a_part_of_a_plan_was_driven_a_new_plan_covers_the_rest():
    context = knowing(crooked(), START)
    whole = plan(context, START)
    half = whole.waypoints[:int(0.6 * len(whole.waypoints))]
    crumbs.drive(context.swept, half)
    before = context.swept.coverage
    assert 0.3 < before < 0.9
    pose = Pose(*half[-1], 0.0)
    route = plan(context, pose)
    assert tuple(route.waypoints[0]) == tuple(half[-1]) and driven(context, route).coverage >= 0.99
    assert length(route.waypoints) < 1.35 * length(whole.waypoints[len(half) - 1:])


def test_floor_that_cannot_be_reached_is_left_out():
    floor_plan = room(5.0, 2.4, 0.05, [(2.8, 0.0, 2.9, 2.4)])
    context = knowing(floor_plan, Pose(4.0, 1.0, 0.0))
    assert plan(context, START) is None  # all cells to clean lie beyond the wall
    route = plan(context, Pose(4.0, 1.0, 0.0))
    assert route.waypoints[:, 0].min() > 2.9 and driven(context, route).coverage >= 0.99


def test_there_is_no_plan_if_nothing_was_missed():
    context = knowing(crooked(), START)
    context.swept.cells[context.swept.cells & kernel.REACHABLE > 0] |= kernel.SWEPT
    assert plan(context, START) is None
