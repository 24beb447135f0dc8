"""Spirals over empty rectangles, and which floors are such."""

import math

import numpy as np
import pytest
from floors import knowing
from pytest import approx
from rooms import room

from rumba_cleaning.planning.planner import plan
from rumba_cleaning.planning.rectangle import Rectangle, corners, rectangle, rounded, spiral_over
from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.simulate import paper
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_sim.model.common.geometry import Pose

WIDE, HIGH = 12.0, 9.0  # [m]
MIDDLE, CORNER = Pose(6.0, 4.5, 0.0), Pose(0.5, 0.5, 0.0)


def hall(*walls):
    return room(WIDE, HIGH, 0.05, walls)


def test_a_spiral_meets_the_target_in_little_more_time_than_the_brush_needs():
    context = knowing(hall(), MIDDLE)
    route = plan(context, MIDDLE)
    rehearsal = Rehearsal(context, MIDDLE, dense(route))
    least = context.swept.reachable_area / context.robot.brush.width / context.config.speed
    assert rehearsal.is_complete and rehearsal.swept.coverage >= context.target_coverage
    assert rehearsal.seconds < 1.04 * least


@pytest.mark.parametrize('start, is_outward', [(MIDDLE, True), (CORNER, False)])
def test_it_begins_at_the_end_that_is_nearer(start, is_outward):
    path = spiral_over(knowing(hall(), start), start).waypoints
    from_middle = [math.dist(path[index], MIDDLE[:2]) for index in (1, -1)]
    assert (from_middle[0] < from_middle[1]) == is_outward


def test_less_is_to_be_swept_with_wider_turns():
    context = knowing(hall(), MIDDLE)
    seconds = [Rehearsal(context, MIDDLE, dense(spiral_over(context.with_target(target), MIDDLE))).seconds
               for target in (0.97, 0.98, 0.99)]
    assert seconds == sorted(set(seconds))


@pytest.mark.parametrize('walls', [[(5.0, 4.0, 5.1, 4.1)], [(0.0, 0.0, 1.0, 1.0)], [(8.0, 0.0, 8.1, 8.0)],
                                   [(3.0, 0.0, 3.3, 0.1)]])
def test_a_floor_with_walls_inside_is_no_rectangle(walls):
    assert rectangle(knowing(hall(*walls), MIDDLE)) is None


def test_a_small_room_is_none_for_a_spiral():
    assert rectangle(knowing(room(4.0, 12.0, 0.05), Pose(2.0, 6.0, 0.0))) is None


def test_a_floor_of_which_part_is_swept_is_planned_by_what_was_missed():
    context = knowing(hall(), MIDDLE)
    paper.drive(context.swept, np.array([[6.0, 4.5], [6.5, 4.5]]))
    assert spiral_over(context, MIDDLE) is None


def test_a_plan_that_is_to_end_somewhere_is_no_spiral():
    context = knowing(hall(), MIDDLE)
    assert math.dist(plan(context, MIDDLE, CORNER).waypoints[-1], CORNER[:2]) < 1.0


def test_the_robot_may_be_a_radius_from_each_wall():
    context = knowing(hall(), MIDDLE)
    reach = context.ground.reach
    assert rectangle(context) == approx((reach, reach, WIDE - reach, HIGH - reach), abs=1e-3)


def test_the_lanes_of_a_spiral_are_evenly_apart():
    found = corners(Rectangle(0.0, 0.0, 3.0, 1.0), 0.3)
    levels = np.unique(np.round(found[:, 1], 9))
    assert levels == approx([0.0, 0.25, 0.5, 0.75, 1.0])
    along = np.diff(found, axis=0)
    assert (np.count_nonzero(np.abs(along) > 1e-9, axis=1) == 1).all()  # no leg is aslant, or empty


def test_a_rounded_corner_touches_both_legs_where_its_turn_begins_and_ends():
    path = rounded(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]), 0.2)
    assert path[[0, 1, -2, -1]] == approx(np.array([[0.0, 0.0], [0.8, 0.0], [1.0, 0.2], [1.0, 2.0]]))
    assert np.hypot(*(path[1:-1] - (0.8, 0.2)).T) == approx(0.2)
