"""Crumbs, which lanes and paths along walls leave: their size, the paths past them, and the detours to them."""

import numpy as np
import pytest
from floors import along, ground, knowing, length, off, part_of, wiped_but
from pytest import approx
from rooms import crooked, distances, quiet, room

from rumba_cleaning.behaviours.follower import Follower, Route
from rumba_cleaning.planning.crumbs import crumbs, drive, with_crumbs
from rumba_cleaning.planning.planner import plan
from rumba_sim.model import kernel
from rumba_sim.model.geometry import Pose
from rumba_sim.model.world import World

START = Pose(0.5, 0.5, 0.0)
SPECKS = [(0.8, 0.8, 1.1, 0.86), (3.2, 0.8, 3.26, 0.86), (2.0, 2.2, 2.06, 2.5)]


def missed_alone(floor_plan, *boxes, **config):
    """The context of a robot that has swept everything except what lies in boxes."""
    context = wiped_but(knowing(floor_plan, START, **config), *boxes)
    x, y, _ = START
    reachable = floor_plan.reachable(x, y, quiet().drive.radius, quiet().brush.width)
    missed = context.swept.missed()
    assert missed.any() and (missed == (part_of(floor_plan, *boxes) & reachable)).all()
    return context


def driven(context, route):
    """The memory of a robot in the world after it drove along a route, with what was swept before."""
    world = World(context.plan, quiet())
    robot = world.spawn('rumba', START)
    follower, swept = Follower(route, world.config.drive), context.swept.copy()
    while not follower.is_done:
        robot.command(*follower.velocity(robot.pose, 0.1), world.tick)
        for _ in range(5):
            world.step()
            swept.follow(robot.pose, False)
        assert world.time < 120.0
    return swept


# --- on paper ------------------------------------------------------------------------------------------------------

def test_a_drive_on_paper_sweeps_what_the_brush_passes():
    context = knowing(room(4.0, 3.0, 0.02), START)
    path = np.array([[0.5, 0.5], [2.0, 0.5], [2.0, 1.5]])
    drive(context.swept, path)
    swept = context.swept.cells & kernel.SWEPT > 0
    rows, columns = np.indices(swept.shape)
    middles = np.stack([(columns.ravel() - 0.5) * 0.02, (rows.ravel() - 0.5) * 0.02], axis=1)
    away = np.min([off(middles, *ends) for ends in (path[:2], path[1:])], axis=0).reshape(swept.shape)
    inner = (middles[:, 0].reshape(swept.shape) > 0.52) & (middles[:, 1].reshape(swept.shape) < 1.48)
    assert swept[(away < 0.07) & inner].all() and not swept[away > 0.105].any()


def test_a_sharp_turn_on_paper_sweeps_the_disc_of_the_brush():
    context = knowing(room(4.0, 3.0, 0.02), START)
    drive(context.swept, np.array([[1.0, 1.5], [2.0, 1.5], [1.0, 1.5]]))
    beyond = (context.swept.cells & kernel.SWEPT > 0) & part_of(context.plan, (2.02, 1.3, 2.2, 1.7))
    assert 0.6 * np.pi / 2.0 * 0.085 ** 2 < np.count_nonzero(beyond) * 0.02 ** 2 < 1.2 * np.pi / 2.0 * 0.085 ** 2


def test_a_turn_on_the_spot_on_paper_sweeps_a_disc():
    context = knowing(room(4.0, 3.0, 0.02), START)
    drive(context.swept, np.array([[1.0, 1.5], [1.03, 1.5], [1.0, 1.5]]))
    area = np.count_nonzero(context.swept.cells & kernel.SWEPT) * 0.02 ** 2
    assert 0.6 * np.pi * 0.085 ** 2 < area < 1.6 * np.pi * 0.085 ** 2


# --- crumbs --------------------------------------------------------------------------------------------------------

def test_crumbs_are_as_large_as_their_cells_and_the_largest_comes_first():
    floor_plan = room(4.0, 3.0, 0.02)
    missed = part_of(floor_plan, (3.0, 2.0, 3.1, 2.1), (1.0, 1.0, 1.4, 1.06), (2.0, 0.5, 2.06, 0.56))
    found = crumbs(ground(floor_plan), missed)
    assert [crumb.area for crumb in found] == approx([0.024, 0.01, 0.0036])
    assert [crumb.waypoints[0].round(1).tolist() for crumb in found] == [[1.0, 1.0], [3.0, 2.0], [2.0, 0.5]]
    assert crumbs(ground(floor_plan), np.zeros_like(missed)) == []


def test_crumbs_near_each_other_are_one_and_others_are_not():
    floor_plan = room(4.0, 3.0, 0.02)
    floor = ground(floor_plan)
    for gap, count in ((0.06, 1), (0.2, 2)):
        missed = part_of(floor_plan, (1.0, 1.0, 1.1, 1.06), (1.1 + gap, 1.0, 1.2 + gap, 1.06))
        assert len(crumbs(floor, missed)) == count
        assert sum(crumb.area for crumb in crumbs(floor, missed)) == approx(0.012)


@pytest.mark.parametrize('box, axis', [((1.0, 1.0, 1.8, 1.06), 0), ((1.0, 1.0, 1.06, 1.8), 1)])
def test_the_path_past_a_long_crumb_is_a_line_along_it(box, axis):
    floor_plan = room(4.0, 3.0, 0.02)
    crumb, = crumbs(ground(floor_plan), part_of(floor_plan, box))
    assert len(crumb.waypoints) == 2 and sorted(crumb.waypoints[:, axis]) == approx([1.0, 1.8], abs=0.07)
    assert crumb.waypoints[:, 1 - axis] == approx(1.03, abs=0.04)


def test_the_path_past_a_crumb_around_a_corner_bends():
    floor_plan = room(4.0, 3.0, 0.02)
    floor = ground(floor_plan)
    missed = part_of(floor_plan, (1.0, 1.0, 1.5, 1.06), (1.0, 1.06, 1.06, 1.5))
    points = np.concatenate([crumb.waypoints for crumb in crumbs(floor, missed)])
    for corner in ((1.5, 1.0), (1.0, 1.5), (1.0, 1.0)):
        assert min(np.hypot(*(points - corner).T)) < 0.12


def test_the_robot_turns_on_the_spot_at_a_speck():
    floor_plan = room(4.0, 3.0, 0.02)
    crumb, = crumbs(ground(floor_plan), part_of(floor_plan, (1.0, 1.0, 1.04, 1.04)))
    assert (crumb.waypoints[0] == crumb.waypoints[-1]).all() and 0.02 < length(crumb.waypoints) < 0.1
    assert max(np.hypot(*(crumb.waypoints - (1.02, 1.02)).T)) < 0.06


def test_the_path_past_a_crumb_beside_a_wall_keeps_off_the_wall():
    floor_plan = crooked(0.02)
    floor = ground(floor_plan)
    missed = part_of(floor_plan, (0.8, 0.0, 1.1, 0.13), (1.52, 0.5, 1.62, 0.8)) & floor.within(0.085)
    found = crumbs(floor, missed)
    assert len(found) == 2
    for crumb in found:
        assert min(distances(floor_plan, along(crumb.waypoints))) >= floor.reach


def test_a_crumb_on_both_sides_of_a_wall_has_a_path_on_each_side():
    floor_plan = room(4.0, 3.0, 0.02, [(1.0, 1.5, 3.0, 1.52)])
    floor = ground(floor_plan)
    missed = np.zeros(floor_plan.occupancy.shape, bool)
    missed[70:84, 95:105] = True
    found = crumbs(floor, missed & floor_plan.free)
    assert sorted(crumb.waypoints[:, 1].mean() > 1.5 for crumb in found) == [False, True]
    for crumb in found:
        assert min(distances(floor_plan, along(crumb.waypoints))) >= floor.reach
        assert crumb.area == approx(0.5 * 0.02 ** 2 * np.count_nonzero(missed & floor_plan.free))


# --- plans for crumbs ----------------------------------------------------------------------------------------------

@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_if_only_specks_were_missed_a_robot_that_follows_the_plan_sweeps_them(resolution):
    floor_plan = room(4.0, 3.0, resolution)
    boxes = [tuple(round(edge / resolution) * resolution for edge in box) for box in SPECKS]
    context = missed_alone(floor_plan, *boxes)
    route = plan(context, START)
    assert not driven(context, route).missed().any()
    assert length(route.waypoints) < 6.0 and min(distances(floor_plan, along(route.waypoints))) >= context.ground.reach


FIELD = (0.6, 0.4, 3.4, 0.9)  # worth lanes; and crumbs near enough to their ends for a detour
CRUMBS = [(0.5, 1.2, 0.7, 1.26), (0.94, 1.2, 1.04, 1.26), (3.1, 1.2, 3.4, 1.26)]


@pytest.mark.parametrize('wanted, passed', [(0.0, []), (0.010, [2]), (0.025, [0, 2]), (0.034, [0, 1, 2])])
def test_a_route_makes_detours_to_as_many_of_the_largest_crumbs_as_the_target_needs(wanted, passed):
    """`wanted` is the area [m^2] that the target leaves to the crumbs."""
    floor_plan = room(4.0, 3.0, 0.02)
    area = knowing(floor_plan, START).swept.reachable_area
    target = 1.0 - (0.036 - wanted) / area - 0.002  # so much more is planned
    context = missed_alone(floor_plan, FIELD, *CRUMBS, target_coverage=target)
    route = plan(context, START)
    missed = driven(context, route).missed()
    assert [index for index, box in enumerate(CRUMBS) if not (missed & part_of(floor_plan, box)).any()] == passed
    assert len(route.speeds) == len(route.waypoints) - 1
    assert set(route.speeds) <= {context.config.speed, context.config.transit_speed}


def test_a_detour_comes_back_to_its_route_and_leaves_the_rest_of_it_as_it_was():
    context = missed_alone(room(4.0, 3.0, 0.02), *CRUMBS, target_coverage=1.0)
    lane = Route(np.array([[0.6, 0.8], [1.2, 0.8], [2.0, 0.8], [2.8, 0.8], [3.4, 0.8]]), np.array([0.1, 0.2, 0.3, 0.4]))
    route = with_crumbs(context, lane)
    at = [int(np.flatnonzero((route.waypoints == waypoint).all(axis=1))[-1]) for waypoint in lane.waypoints]
    assert at == sorted(at) and at[-1] == len(route.waypoints) - 1 == len(route.speeds)
    assert (route.waypoints[:, 1] != 0.8).any() and length(route.waypoints) < length(lane.waypoints) + 4.0
    on_lane = (route.waypoints[:-1, 1] == 0.8) & (route.waypoints[1:, 1] == 0.8)
    middles = 0.5 * (route.waypoints[:-1, 0] + route.waypoints[1:, 0])
    legs = np.searchsorted(lane.waypoints[:, 0], middles) - 1
    assert (route.speeds == lane.speeds[legs])[on_lane].all()


def test_a_crumb_that_is_far_from_the_route_or_behind_a_wall_gets_no_detour():
    far, behind = (2.0, 2.4, 2.3, 2.46), (2.0, 1.34, 2.3, 1.4)
    lane = Route(np.array([[0.6, 0.8], [2.1, 0.8], [3.4, 0.8]]), np.array([0.3, 0.3]))
    for plan_of, box in ((room(4.0, 3.0, 0.02), far), (room(4.0, 3.0, 0.02, [(1.0, 1.06, 3.0, 1.1)]), behind)):
        context = missed_alone(plan_of, box, target_coverage=1.0)
        route = with_crumbs(context, lane)
        assert (route.waypoints[:, 1] == 0.8).all() and (np.diff(route.waypoints[:, 0]) > 0.0).all()
    assert with_crumbs(context, None) is None


def test_the_target_of_a_mission_counts_and_not_that_of_the_settings():
    context = missed_alone(room(4.0, 3.0, 0.02), *CRUMBS, target_coverage=1.0)
    lane = Route(np.array([[0.6, 0.8], [3.4, 0.8]]), np.array([0.2]))
    many, none = (with_crumbs(context.with_target(target), lane) for target in (1.0, 0.9))
    assert (many.waypoints[:, 1] != 0.8).any() and (none.waypoints[:, 1] == 0.8).all()


def test_a_crumb_beside_the_middle_of_a_long_lane_is_visited():
    context = missed_alone(room(4.0, 3.0, 0.02), (1.9, 1.2, 2.2, 1.26), target_coverage=1.0)
    lane = Route(np.array([[0.5, 0.8], [3.5, 0.8]]), np.array([0.2]))
    missed = driven(context, with_crumbs(context, lane)).missed()
    assert np.count_nonzero(missed) < 0.1 * np.count_nonzero(context.swept.missed())
