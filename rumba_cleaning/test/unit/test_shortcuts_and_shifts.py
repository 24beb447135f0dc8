"""Shortcuts are offered where a route sweeps little of its own, shifts for its straight parts and its corners."""

import numpy as np
from floors import knowing
from pytest import approx
from rooms import room

from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.search.shifts import ASIDE, OUTWARD, shifts
from rumba_cleaning.planning.search.shortcuts import shortcuts
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

START = Pose(0.5, 1.5, 0.0)
FLOOR = room(4.0, 3.0, 0.02)
# Out and back again at x = 2: what the way back sweeps was swept before.
SPUR = np.array([[0.5, 1.5], [2.0, 1.5], [2.0, 2.2], [2.01, 1.5], [3.5, 1.5]])


def route_over(points):
    return dense(Route(np.array(points, float), np.full(len(points) - 1, 0.3)))


def test_a_shortcut_leaves_out_a_spur_if_the_price_is_low_enough():
    context = knowing(FLOOR, START)
    rehearsal = Rehearsal(context, START, route_over(SPUR))
    cheap, dear = shortcuts(context, rehearsal, 20.0), shortcuts(context, rehearsal, 200.0)
    assert len(dear) < len(cheap) and all(len(edit.path) == 0 for edit in cheap)
    best = rehearsal.judged(cheap[:1])[0]
    assert best.seconds < -2.0 and best.area < 0.0


def test_there_are_no_shortcuts_through_walls_nor_on_a_straight_line():
    floor = room(4.0, 3.0, 0.02, [(1.5, 0.0, 2.5, 1.6)])
    around = [[0.5, 1.0], [1.1, 1.9], [2.0, 1.9], [2.9, 1.9], [3.5, 1.0]]
    context = knowing(floor, Pose(0.5, 1.0, 0.0))
    rehearsal = Rehearsal(context, Pose(0.5, 1.0, 0.0), route_over(around))
    for edit in shortcuts(context, rehearsal, 0.0):
        ends = rehearsal.route.waypoints[[edit.first, edit.last]]
        line = ends[0] + np.linspace(0.0, 1.0, 50)[:, np.newaxis] * (ends[1] - ends[0])
        assert context.ground.are_free(line).all()
    straight = Rehearsal(context, Pose(0.5, 2.5, 0.0), route_over([[0.5, 2.5], [3.5, 2.5]]))
    assert shortcuts(context, straight, 0.0) == []


def test_straight_parts_are_moved_aside_and_corners_outward_or_inward():
    context = knowing(FLOOR, START)
    route = route_over([[0.5, 0.5], [1.0, 0.5], [1.0, 2.0], [2.5, 2.0], [2.5, 1.0]])
    edits = list(shifts(context, route))
    lines = [edit.path for edit in edits if len(edit.path) == 2]
    points = np.concatenate([edit.path for edit in edits if len(edit.path) == 1])
    upright = [float(line[0, 0]) - 1.0 for line in lines if line[0, 0] == approx(line[1, 0])]
    assert sorted(upright) == approx(sorted(ASIDE))
    assert len(lines) == 2 * len(ASIDE) and len(points) == 3 * len(OUTWARD)
    offs = points[len(OUTWARD):2 * len(OUTWARD)] - [1.0, 2.0]  # the corner at the upper left
    assert offs @ np.array([-1.0, 1.0]) / np.sqrt(2.0) == approx(np.array(OUTWARD))


def test_nothing_is_moved_to_where_the_robot_cannot_stand():
    context = knowing(FLOOR, START)
    reach = context.ground.reach
    route = route_over([[0.5, 1.5], [0.5, reach + 0.005], [3.0, reach + 0.005], [3.0, 1.5]])
    for edit in shifts(context, route):
        assert context.ground.are_free(edit.path).all()
