"""Obstacles that the robot has met: the clearance beside them, and the paths around them."""

import itertools
import math

import numpy as np
import pytest
from floors import along, ground, length, off, standing_points, wall_with_gap
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import PLANS, RADIUS, crooked, room

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.ground import INFLATION
from rumba_cleaning.belief.met import GROWTH, LARGEST, NOTHING_SEEN, SEEN, Seen
from rumba_sim.model.floors.reachability import SLACK
from rumba_sim.model.maps.floor_plan import FloorPlan


def exact_clearance(floor, marks):
    """Distance of each node to walls and round obstacles [m]."""
    rows, columns = np.indices(floor.plan.safe_clearance.shape)
    points = floor.points(np.stack([rows.ravel(), columns.ravel()], axis=1))
    away = [np.maximum(np.hypot(*(points - mark[:2]).T) - mark[2], 0.0) for mark in marks]
    return np.min([floor.plan.safe_clearance.ravel(), *away], axis=0).reshape(rows.shape)


@settings(max_examples=30)
@given(st.sampled_from([0.02, 0.05, 0.1]),
       st.lists(st.tuples(st.floats(-0.3, 4.3), st.floats(-0.3, 3.3), st.floats(0.02, 0.2)), min_size=1, max_size=3))
def test_near_obstacles_that_were_met_the_clearance_is_the_distance_to_them(resolution, marks):
    floor = ground(PLANS['crooked', resolution])
    apart = [mark for index, mark in enumerate(marks) if all(
        math.hypot(mark[0] - other[0], mark[1] - other[1]) > mark[2] + other[2] for other in marks[:index])]
    for mark in apart:
        floor.mark(*mark)
    exact = exact_clearance(floor, apart)
    limit = floor.reach + INFLATION
    assert np.minimum(floor.clearance, limit) == approx(np.minimum(exact, limit))
    assert (floor.clearance <= floor.plan.safe_clearance).all()
    assert (floor.fits == (floor.clearance >= floor.reach + SLACK)).all()


def test_a_path_leads_around_an_obstacle_that_was_met_until_it_is_forgotten():
    floor = ground(room(4.0, 3.0))
    start, end, post = np.array([0.5, 1.4]), np.array([3.5, 1.4]), np.array([2.0, 1.5])
    assert not floor.has_marks and (paths.between(floor, start, end) == [start, end]).all()
    floor.mark(*post, 0.05)
    path = paths.between(floor, start, end)
    assert floor.has_marks and min(np.hypot(*(along(path) - post).T)) >= floor.reach + 0.05
    assert max(off(path, start, end)) < 0.3 and min(path[:, 1]) < 1.3  # past it on its nearer side
    floor.forget()
    assert not floor.has_marks and (paths.between(floor, start, end) == [start, end]).all()
    assert (floor.clearance == floor.plan.safe_clearance).all()


def test_a_copy_of_the_ground_and_the_original_change_independently():
    floor = ground(room(4.0, 3.0))
    floor.mark(1.0, 1.5, 0.05)
    copy, clearance, fits = floor.copy(), floor.clearance.copy(), floor.fits.copy()
    floor.mark(3.0, 1.5, 0.05)
    assert copy.has_marks and (copy.clearance == clearance).all() and (copy.fits == fits).all()
    assert (floor.clearance != clearance).any()
    assert copy.is_straight(np.array([3.0, 0.5]), np.array([3.0, 2.5]))
    copy.mark(3.0, 1.5, 0.05)
    assert radius_at(copy, 3.0, 1.5) == approx(0.05)  # it does not know that the original met this one
    clearance = floor.clearance.copy()
    copy.mark(1.0, 1.5, 0.05)  # met again: with the memory of the first touch
    assert radius_at(copy, 1.0, 1.5) == approx(0.05 + GROWTH) and (floor.clearance == clearance).all()
    copy.forget()
    assert floor.has_marks and not copy.has_marks and (floor.clearance == clearance).all()


def test_obstacles_in_a_door_close_it():
    floor = ground(wall_with_gap())
    start, end = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    floor.mark(2.0, 2.6, 0.05)
    for is_open in (False, True):
        assert (paths.between(floor, start, end) is not None) == is_open
        assert np.isfinite(paths.lengths_to(floor, *end)[floor.node(*start)]) == is_open
        floor.forget()


def radius_at(floor, x, y):
    """Radius of the obstacle around a point, from the clearance beside it [m]."""
    return 0.4 - float(floor.clearance[floor.node(x + 0.4, y)])


def test_an_obstacle_that_is_met_again_grows_up_to_a_limit_and_others_do_not():
    floor = ground(room(6.0, 4.0))
    floor.mark(4.0, 2.0, 0.05)
    for times in range(14):
        floor.mark(2.0, 2.0, 0.05)
        if times == 0:
            assert radius_at(floor, 2.0, 2.0) == approx(0.05)
        if times == 2:
            assert radius_at(floor, 2.0, 2.0) == approx(0.05 + 2.0 * GROWTH)
    assert radius_at(floor, 2.0, 2.0) == approx(LARGEST) and radius_at(floor, 4.0, 2.0) == approx(0.05)
    floor.mark(4.05, 2.0, 0.05)  # overlaps the other: met again a little farther on
    assert radius_at(floor, 4.05, 2.0) == approx(0.05 + GROWTH)
    floor.forget()
    floor.mark(2.0, 2.0, 0.05)
    assert radius_at(floor, 2.0, 2.0) == approx(0.05)


def test_lines_through_an_obstacle_that_was_met_are_marked_and_lines_through_walls_are_not():
    floor = ground(room(4.0, 3.0, boxes=[(1.0, 0.0, 1.2, 1.0)]))
    through = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    assert not floor.is_straight(*through) and not floor.is_marked(*through)
    floor.mark(2.5, 1.5, 0.05)
    for (start, end), is_marked in [(((0.5, 1.5), (3.5, 1.5)), True), (((2.5, 0.5), (2.5, 2.5)), True),
                                    (((0.5, 1.25), (3.5, 1.25)), False), (((0.5, 1.75), (3.5, 1.8)), False),
                                    (((0.5, 1.3), (3.5, 1.3)), True), (((2.4, 1.5), (2.4, 1.5)), True),
                                    (((0.5, 1.5), (2.2, 1.5)), False), (((0.5, 0.5), (3.5, 0.5)), False)]:
        assert floor.is_marked(np.array(start), np.array(end)) == is_marked, (start, end)
    floor.forget()
    assert not floor.is_marked(np.array([0.5, 1.5]), np.array([3.5, 1.5]))


def test_every_point_among_obstacles_has_a_path_if_its_path_length_is_finite():
    floor = ground(crooked())
    for mark in ((2.0, 1.0, 0.1), (1.5, 1.5, 0.1), (2.0, 2.5, 0.1)):
        floor.mark(*mark)
    lengths = paths.lengths_to(floor, 0.5, 0.5)
    points = standing_points(floor)
    end = np.array([0.5, 0.5])
    for start in itertools.islice(points, 0, None, max(len(points) // 60, 1)):
        path = paths.between(floor, start, end)
        expected = lengths[floor.node(*start)]
        assert (path is None) == np.isinf(expected)
        if path is not None:
            assert math.hypot(*(start - end)) - 1e-9 <= length(path) <= 1.3 * expected + 0.1


def test_what_is_met_again_after_it_was_forgotten_stays_and_what_is_not_goes():
    floor = ground(room(6.0, 4.0))
    for x in (2.0, 2.08, 4.0):
        floor.mark(x, 2.0, 0.05)
    assert floor.has_marks and not floor.has_lasting
    floor.forget_doubtful()
    assert not floor.has_marks and (floor.clearance == floor.plan.safe_clearance).all()
    floor.mark(2.05, 2.0, 0.05)  # where the first two were: both are back
    assert floor.has_lasting and floor.clearance[floor.node(2.15, 2.0)] == approx(0.02)
    assert floor.clearance[floor.node(4.0, 2.0)] > 1.0
    floor.mark(5.0, 3.0, 0.05)
    lasting = floor.lasting_clearance()
    assert lasting[floor.node(2.0, 2.0)] == 0.0 < lasting[floor.node(5.0, 3.0)]
    floor.forget_doubtful()
    assert np.array_equal(floor.clearance, lasting)
    floor.forget_barring(1.0, 1.0)  # it bars no way
    assert np.array_equal(floor.clearance, lasting)


def test_a_copy_has_the_lasting_obstacles_too():
    floor = ground(room(6.0, 4.0))
    floor.mark(2.0, 2.0, 0.05)
    floor.forget_doubtful()
    copy = floor.copy()
    floor.mark(2.0, 2.0, 0.05)
    assert floor.has_lasting and not copy.has_lasting
    copy.mark(2.0, 2.0, 0.05)
    assert copy.has_lasting and floor.copy().has_lasting


def wall_of_points(x, low, high):
    """Points of something that is seen, across a room."""
    return np.array([(x, y) for y in np.arange(low, high, 0.04)])


def test_squeezed_what_is_seen_leaves_a_gap_open_that_is_as_narrow_as_the_robot():
    floor = ground(room(4.0, 3.0))
    below = np.arange(1.5 - RADIUS - 0.01, 0.0, -0.04)
    wall = np.array([(2.0, y) for y in (*below, *(3.0 - below))])
    floor.show(Seen(wall, wall[:0]))
    ends = np.array([[1.0, 1.5], [3.0, 1.5]])
    assert paths.between(floor, *ends) is None
    assert floor.opened(1.0, 1.5) == approx((4.0 - 2.0 * RADIUS) * (3.0 - 2.0 * RADIUS) / 2.0, rel=0.2)
    floor.squeeze(True)
    assert paths.between(floor.copy(), *ends) is not None and floor.shows(wall) and floor.opened(1.0, 1.5) == 0.0
    floor.squeeze(False)
    assert paths.between(floor, *ends) is None


@pytest.mark.parametrize('gap, opens', [(0.34, True), (0.30, False)])
def test_squeezed_the_body_hangs_over_a_cliff_beside_a_wall_as_far_as_the_wheels_stay_off(gap, opens):
    plan = room(4.0, 3.0, 0.02)
    cliff = np.zeros((plan.rows, plan.columns), np.bool_)
    top = int(round((3.0 - gap - plan.origin[1]) / 0.02))
    cliff[:top, 100:105] = True
    floor = ground(FloorPlan('a gap', plan.occupancy, 0.02, plan.origin, cliff=cliff))
    ends = np.array([[1.0, 1.5], [3.0, 1.5]])
    assert paths.between(floor, *ends) is None
    floor.squeeze(True)
    assert (paths.between(floor, *ends) is not None) == opens
    floor.squeeze(False)
    assert paths.between(floor, *ends) is None


def test_what_is_seen_is_shown_until_something_else_is():
    floor = ground(room(4.0, 3.0))
    floor.show(Seen(wall_of_points(1.0, 1.0, 2.0), wall_of_points(3.0, 1.0, 2.0)))
    assert floor.has_marks and floor.has_doubtful and floor.has_lasting
    assert floor.shows(np.array([[1.0, 1.04], [3.0, 1.04]])) and not floor.shows(np.array([[1.0, 1.04], [2.0, 1.5]]))
    assert floor.clearance[floor.node(1.3, 1.4)] == approx(0.3 - SEEN)
    assert floor.lasting_clearance()[floor.node(1.3, 1.4)] == approx(1.3)
    assert len(floor.forget_doubtful()) == len(wall_of_points(1.0, 1.0, 2.0))
    assert not floor.has_doubtful and floor.has_lasting
    floor.show(Seen(wall_of_points(1.0, 1.0, 2.0), wall_of_points(3.0, 1.0, 2.0)))
    floor.show(NOTHING_SEEN)
    assert not floor.has_marks and (floor.clearance == floor.plan.safe_clearance).all()


def test_what_is_known_to_stay_stays_at_once():
    floor = ground(room(4.0, 3.0))
    floor.mark(2.0, 2.0, 0.05, stays=True)
    assert floor.has_lasting and not floor.has_doubtful
    floor.forget_doubtful()
    assert floor.has_lasting


def test_of_what_stays_only_what_bars_a_way_is_forgotten():
    floor = ground(room(4.0, 3.0, boxes=[(2.0, 0.0, 2.2, 1.2), (2.0, 1.8, 2.2, 3.0)]))
    floor.mark(2.1, 1.5, 0.1, stays=True)
    floor.mark(0.8, 2.4, 0.1, stays=True)
    barring, beside = wall_of_points(2.1, 1.3, 1.7), wall_of_points(3.5, 2.5, 2.8)
    floor.show(Seen(NOTHING_SEEN.passing, np.concatenate([barring, beside])))
    lasting = floor.lasting_clearance()
    assert floor.cut_off(1.0, 0.5) > 1.0
    assert floor.forget_barring(1.0, 0.5).tolist() == barring.tolist()
    assert floor.cut_off(1.0, 0.5) == 0.0
    kept = floor.node(0.8, 2.1), floor.node(3.2, 2.6)
    assert all(floor.lasting_clearance()[node] == lasting[node] for node in kept)
    floor.mark(2.1, 1.5, 0.05)  # met again: it stays
    assert floor.cut_off(1.0, 0.5) > 1.0


def test_an_obstacle_is_as_small_as_the_robot_shows_it_to_be_by_standing_there():
    floor = ground(room(4.0, 3.0))
    floor.mark(2.0, 1.5, 0.2)
    floor.mark(1.0, 1.0, 0.1, stays=True)
    floor.leave_out(1.72, 1.5, 0.1)  # does not overlap it by more than the pose may err
    assert floor.clearance[floor.node(2.3, 1.5)] == approx(0.1)
    floor.leave_out(1.75, 1.5, 0.17)
    assert floor.clearance[floor.node(2.3, 1.5)] == approx(0.3 - 0.08)
    assert floor.clearance[floor.node(1.0, 1.3)] == approx(0.2)
    floor.leave_out(1.0, 1.0, 0.17)
    assert not floor.has_lasting


def test_floor_to_which_no_way_is_left_is_cut_off():
    floor = ground(room(4.0, 3.0))
    assert floor.cut_off(1.0, 1.5) == 0.0
    floor.show(Seen(wall_of_points(2.0, 0.0, 3.0), NOTHING_SEEN.staying))
    assert floor.cut_off(1.0, 1.5) == 0.0  # it may move on
    floor.show(Seen(NOTHING_SEEN.passing, wall_of_points(2.0, 0.0, 3.0)))
    half = (2.0 - 2 * floor.reach) * (3.0 - 2 * floor.reach)
    assert floor.cut_off(1.0, 1.5) == approx(half, rel=0.1) == floor.cut_off(3.0, 1.5)
    floor.show(Seen(NOTHING_SEEN.passing, wall_of_points(2.0, 0.0, 2.5)))
    assert floor.cut_off(1.0, 1.5) == 0.0


def test_a_robot_in_a_passage_where_it_does_not_quite_fit_can_go_on_to_the_larger_side():
    """It believes to be a little nearer to what is there than it fits, or that is not quite where it was seen."""
    floor = ground(room(4.0, 3.0, 0.02))
    half = floor.reach + SLACK + SEEN - 0.01
    floor.show(Seen(np.concatenate([wall_of_points(1.0, 0.0, 1.5 - half + 0.04), wall_of_points(1.0, 1.5 + half, 3.0)]),
                    NOTHING_SEEN.staying))
    inside, left, right = np.array([0.96, 1.5]), np.array([0.4, 1.5]), np.array([3.0, 1.5])
    assert paths.between(floor, left, right) is None and not floor.are_free(inside[np.newaxis])[0]
    assert floor.points([floor.standing_at(*inside)])[0][0] > 1.0
    for place in (left, right):
        assert (paths.between(floor, inside, place)[-1] == place).all()
