"""Routes and paths are cut into pieces, of which it is known how long they take, and what they sweep."""

import math

import numpy as np
import pytest
from floors import BRUSH, knowing
from pytest import approx
from rooms import room

from rumba_cleaning.behaviours.follower import drive_of
from rumba_cleaning.planning.common.compiled_ways import NONE
from rumba_cleaning.planning.common.lines import needed
from rumba_cleaning.planning.search import pieces
from rumba_cleaning.planning.search.compiled_pieces import BEYOND, FAR, Pace, cells, durations, links
from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.route import Route, lengths_along
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import DriveConfig

START = Pose(0.5, 0.5, 0.0)
SPEED, TRANSIT = 0.3, 0.45
DRIVE = drive_of(DriveConfig(max_speed=0.4))
PACE = Pace(0.5, SPEED, TRANSIT, 0.5, 2.0, 0.5)


def ends_of(found):
    return [tuple(np.round(piece[[0, -1]], 6).ravel().tolist()) for piece in found]


def arc(radius, angle):
    turned = np.linspace(0.0, angle, 1 + math.ceil(angle * radius / 0.02))
    return radius * np.stack([np.sin(turned), 1.0 - np.cos(turned)], axis=1)


def test_a_route_is_cut_at_corners_and_without_its_ways_and_what_sweeps_little_new(monkeypatch):
    monkeypatch.setattr(pieces, 'IDLE', 0.1)  # the last piece is swept before, but for where the robot turns to it
    route = Route(np.array([[0.5, 0.5], [2.5, 0.5], [2.5, 1.5], [1.0, 1.5], [1.0, 2.5], [2.0, 2.5], [1.0, 0.5],
                            [2.0, 0.5]]), np.array([SPEED, SPEED, TRANSIT, SPEED, SPEED, TRANSIT, SPEED]))
    rehearsal = Rehearsal(knowing(room(4.0, 3.0, 0.02), START), START, dense(route))
    assert ends_of(pieces.of_route(rehearsal, SPEED, BRUSH)) == [
        (0.5, 0.5, 2.5, 0.5), (2.5, 0.5, 2.5, 1.5), (1.0, 1.5, 1.0, 2.5), (1.0, 2.5, 2.0, 2.5)]


def test_paths_are_cut_at_corners_and_into_parts_of_one_length():
    path = np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 1.0]])
    found = pieces.of_paths([path], [])
    assert [lengths_along(piece)[-1] for piece in found] == approx([7.0 / 3.0, 7.0 / 3.0, 7.0 / 3.0, 1.0], abs=0.1)
    assert all((one[-1] == other[0]).all() for one, other in zip(found, found[1:]))
    assert (found[0][0] == path[0]).all() and (found[-1][-1] == path[-1]).all()
    assert max(np.hypot(*np.diff(piece, axis=0).T).max() for piece in found) <= pieces.STEP + 1e-9
    assert len(pieces.of_paths([arc(0.3, 1.5 * math.pi)], [])) == 1  # a bend is no corner


def test_each_piece_is_there_once_in_either_direction():
    one, other = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[0.0, 0.2], [1.0, 0.2]])
    roundabout = np.array([[0.0, 0.0], [0.5, 0.1], [1.0, 0.0]])
    found = pieces.of_paths([one, other[::-1], one[::-1], other], [])
    assert ends_of(found) == [(0.0, 0.0, 1.0, 0.0), (1.0, 0.2, 0.0, 0.2)]
    assert ends_of(pieces.of_paths([one, other], [one[::-1]])) == [(0.0, 0.2, 1.0, 0.2)]
    assert len(pieces.of_paths([roundabout], [one])) == 1


@pytest.mark.parametrize('radius', [0.1, 0.2, 0.5, 2.0])
def test_a_piece_takes_longer_in_bends_in_which_the_outer_wheel_or_the_turn_rate_is_at_its_limit(radius):
    path = arc(radius, 2.0)
    speed = min(SPEED, DRIVE.max_speed * radius / (radius + 0.5 * DRIVE.wheel_base), DRIVE.max_turn_rate * radius)
    found = durations(np.concatenate([[[0.0, 0.0], [0.6, 0.0]], path]), np.array([0, 2, 2 + len(path)]), SPEED, DRIVE)
    assert found.tolist() == approx([2.0, 2.0 * radius / speed], rel=0.05)


@pytest.mark.parametrize('angle', [0.0, 0.3, 0.8])
def test_a_piece_sweeps_the_floor_beside_it_once_and_a_little_beyond_its_ends(angle):
    along, resolution = np.array([math.cos(angle), math.sin(angle)]), 0.01
    path = np.array([0.503, 0.503]) + np.linspace(0.0, 1.0, 11)[:, np.newaxis] * along
    wanted = np.ones((200, 200), bool)
    wanted[:, :40] = False
    found, stops = cells(np.concatenate([path, path[::-1], path[:1], path[:1]]), np.array([0, 11, 22, 24]), 0.5 * BRUSH,
                         wanted, (0.0, 0.0), resolution)
    one, other = found[:stops[1]], found[stops[1]:stops[2]]
    assert len(set(one.tolist())) == len(one) and set(one.tolist()) == set(other.tolist())
    assert stops[3] == stops[2]  # a point sweeps nothing
    assert len(one) * resolution ** 2 == approx((1.0 + BEYOND * BRUSH) * BRUSH, rel=0.02)
    points = resolution * (0.5 + np.stack([one % 200, one // 200], axis=1)) - 0.503
    aside = np.abs(points @ [-along[1], along[0]])
    assert aside.max() <= 0.5 * BRUSH + 1e-9, (angle, aside.max())
    few, _ = cells(path, np.array([0, 11]), 0.5 * BRUSH, ~wanted, (0.0, 0.0), resolution)
    assert len(few) == 0


def test_links_lead_where_the_floor_is_free_and_the_quickest_is_first():
    context = knowing(room(4.0, 3.0, 0.02, [(1.9, 0.0, 2.1, 2.0)]), START)
    ground = context.ground
    ends = np.array([[1.5, 1.0], [0.5, 1.0], [1.5, 1.17], [0.5, 1.17], [2.5, 1.0], [3.5, 1.0]])
    headings = np.array([0.0, math.pi, 0.0, math.pi, math.pi, 0.0])
    near = np.array([[2, 3, 4, NONE], [3, 2, 0, NONE], [0, 1, NONE, 4], [1, 0, NONE, NONE], [0, 2, NONE, NONE],
                     [NONE, NONE, NONE, NONE]])
    found, times = links(ends, headings, near, ground.clearance, ground.plan.origin, ground.plan.resolution,
                         needed(ground), PACE)
    assert found.tolist() == [[2, 3, NONE, NONE], [3, 2, NONE, NONE], [0, 1, NONE, NONE], [1, 0, NONE, NONE],
                              [NONE] * 4, [NONE] * 4]
    assert (times == times.T).all() and times.dtype == np.float32
    corners = 2.0 * (0.5 * math.pi - PACE.free) / PACE.rate
    assert times[0, 2] == approx(0.17 / SPEED + corners)
    assert times[0, 3] > 1.0 / TRANSIT and times[0, 4] == times[0, 1] == FAR  # behind a wall; of one piece


def test_a_link_straight_on_takes_no_time_and_one_back_a_turn():
    context = knowing(room(4.0, 3.0, 0.02), START)
    ground = context.ground
    ends = np.array([[0.5, 1.0], [1.5, 1.0], [1.5, 1.0], [2.5, 1.0], [1.5, 1.0], [1.5, 1.0]])
    headings = np.array([math.pi, 0.0, math.pi, 0.0, math.nan, math.nan])
    near = np.array([[NONE] * 3, [2, 5, NONE], [1, 4, NONE], [NONE] * 3, [1, 2, NONE], [1, 2, NONE]])
    _, times = links(ends, headings, near, ground.clearance, ground.plan.origin, ground.plan.resolution, needed(ground),
                     PACE)
    assert times[1, 2] == times[1, 5] == 0.0  # the second is a point, which has no direction
    headings[2] = 0.0
    _, times = links(ends, headings, near, ground.clearance, ground.plan.origin, ground.plan.resolution, needed(ground),
                     PACE)
    assert times[1, 2] == approx((math.pi - PACE.free) / PACE.rate + PACE.stop)
