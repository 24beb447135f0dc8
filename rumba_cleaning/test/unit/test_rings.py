"""Rings: where they lie, what they sweep, and how those inside one another are joined."""

import math

import numpy as np
import pytest
from floors import BRUSH, ground, knowing, length, tilted, wiped
from hypothesis import given, settings
from pytest import approx
from rooms import NAMES, PLANS, crooked, room

from rumba_cleaning.planning.common.polyline import SPACING
from rumba_cleaning.planning.decompose.regions import Shapes, regions
from rumba_cleaning.planning.swaths.rings import BESIDE, PASS, WALL_MARGIN, chains, is_needed, rings, stretch
from rumba_sim.model.common.geometry import Pose

START = Pose(0.5, 0.5, 0.0)


def everywhere(floor, swept, spare=math.inf):
    """Rings on all of a floor, whatever shape its regions have."""
    labels = regions(floor)
    nowhere = np.zeros(labels.max() + 1, bool)
    return rings(floor, swept, labels, Shapes(nowhere, nowhere), BRUSH, PASS, spare)


def planned(plan, start=START):
    """The context of a robot, the memory after it drove all rings on paper, and the rings."""
    context = knowing(plan, start)
    swept = context.swept.copy()
    return context, swept, everywhere(context.ground, swept)


def test_rings_of_an_empty_room_lie_a_pass_apart_and_the_first_beside_the_walls():
    context, swept, found = planned(room(3.0, 2.0, 0.02))
    for ring in found:
        away = WALL_MARGIN + context.ground.reach + ring.level * PASS * BRUSH
        sides = ring.waypoints[np.abs(ring.waypoints - [1.5, 1.0]).max(axis=1) > 0.1]
        edge = np.minimum(np.minimum(sides[:, 0], 3.0 - sides[:, 0]), np.minimum(sides[:, 1], 2.0 - sides[:, 1]))
        assert np.median(edge) == approx(away, abs=0.004)
    assert [ring.level for ring in found] == list(range(len(found))) and len(found) in (5, 6)
    assert swept.coverage > 0.97


@settings(max_examples=12, deadline=None)
@given(NAMES)
def test_every_waypoint_lies_where_the_robot_can_stand(name):
    plan = PLANS[name].refined()
    floor = ground(plan)
    node = np.argwhere(floor.fits)[0]
    _, _, found = planned(plan, Pose(*floor.points(node[np.newaxis])[0], 0.0))
    for ring in found:
        assert min(plan.safe_clearance_at(x, y) for x, y in ring.waypoints) >= floor.reach - 0.006


@pytest.mark.parametrize('resolution', [0.01, 0.02, 0.05, 0.1])
def test_rings_sweep_nearly_everything_at_any_resolution(resolution):
    _, swept, found = planned(crooked(resolution))
    assert swept.coverage > 0.92
    assert sum(length(ring.waypoints) for ring in found) * BRUSH < 1.25 * swept.reachable_area


def test_rings_follow_walls_along_no_axis():
    plan = tilted(3.0, 2.0, 0.4)
    _, swept, found = planned(plan, plan.most_open_pose())
    longest = max(found, key=lambda ring: len(ring.waypoints))
    assert longest.is_closed and swept.coverage > 0.92
    steps = np.diff(longest.waypoints, axis=0)
    turned = (np.arctan2(steps[:, 1], steps[:, 0]) - 0.4 + math.pi / 4.0) % (math.pi / 2.0) - math.pi / 4.0
    assert np.mean(abs(turned) < 0.3) > 0.85


def test_floor_that_was_swept_needs_no_rings():
    context = wiped(knowing(room(4.0, 3.0), START), (2.0, 0.0, 4.0, 3.0))
    found = everywhere(context.ground, context.swept.copy())
    assert found and max(ring.waypoints[:, 0].max() for ring in found) < 2.3
    swept = wiped(context, (0.0, 0.0, 4.0, 3.0)).swept.copy()
    assert not everywhere(context.ground, swept)


def needed(context, path):
    everywhere_steep = np.ones(context.ground.clearance.shape, bool)
    return is_needed(context.ground, context.swept.missing_share(), everywhere_steep, path, BRUSH)


@pytest.mark.parametrize('resolution', [0.02, 0.05])
@pytest.mark.parametrize('box, axis', [((0.0, 0.0, 4.0, 1.5), 1), ((0.0, 0.0, 1.5, 3.0), 0)])
def test_waypoints_are_needed_if_a_quarter_of_the_brush_finds_floor_that_was_missed(resolution, box, axis):
    context = wiped(knowing(room(4.0, 3.0, resolution), START), box)  # up to 1.5 m
    steps = np.linspace(0.0, 1.0, 50)
    for share, expected in ((0.1, False), (0.4, True)):
        for along in (1.0, -1.0):
            path = np.full((50, 2), 1.5 + (share - 0.5) * BRUSH)
            path[:, 1 - axis] = 1.5 + along * (steps - 0.5)
            assert (needed(context, path) == expected).all()
    path = np.full((50, 2), 1.5)
    path[:, axis] = 1.0 + steps
    assert (needed(context, path) == (path[:, axis] > 1.5)).mean() > 0.95


def test_where_two_sides_almost_touch_there_is_no_ring():
    width = 2.0 * (0.17425 + PASS * BRUSH) + 0.03  # of a corridor in whose middle the second ring is 3 cm wide
    _, _, found = planned(room(3.0, width, 0.01), Pose(0.3, 0.3, 0.0))
    assert [ring.level for ring in found] == [0]


@pytest.mark.parametrize('spare, levels', [(0.2, []), (0.05, [0])])
def test_a_passage_hardly_wider_than_the_robot_has_a_ring_if_a_pass_in_its_middle_leaves_too_much(spare, levels):
    context = knowing(room(4.0, 0.4, 0.01), Pose(0.3, 0.2, 0.0))  # 3.65 m are left on both sides, 1.5 cm wide or more
    found = everywhere(context.ground, context.swept.copy(), spare)
    assert [ring.level for ring in found] == levels and all(ring.is_closed for ring in found)


def test_rings_of_two_rooms_end_at_the_door_between_them():
    plan = room(5.0, 2.4, 0.05, [(2.8, 0.0, 2.9, 0.3), (2.8, 1.0, 2.9, 2.4)])
    _, _, found = planned(plan)
    for ring in found:
        assert ring.waypoints[:, 0].max() < 3.1 or ring.waypoints[:, 0].min() > 2.6


# --- chains --------------------------------------------------------------------------------------------------------

def test_rings_inside_one_another_are_one_chain_from_outside_inward():
    _, _, found = planned(room(3.0, 2.0))
    chain, = chains(found)
    assert [ring.level for ring in chain] == list(range(len(found)))


TWO_LEGS = room(3.0, 3.0, 0.02, [(x, 1.48, x + 0.04, 1.52) for x in (1.28, 1.7)])  # one ring around both rings


@pytest.mark.parametrize('plan', [crooked(), TWO_LEGS])
def test_each_ring_is_in_one_chain(plan):
    _, _, found = planned(plan)
    numbers = [id(ring) for chain in chains(found) for ring in chain]
    assert sorted(numbers) == sorted(id(ring) for ring in found)


def test_rings_around_two_islands_are_chains_of_their_own():
    _, _, found = planned(room(5.0, 3.0, 0.02, [(1.4, 1.4, 1.6, 1.6), (3.4, 1.4, 3.6, 1.6)]))
    first = [chain[0] for chain in chains(found) if chain[0].level == 0]
    assert len(first) == 3
    assert sorted(round(float(ring.waypoints[:, 0].mean()), 1) for ring in first) == [1.5, 2.5, 3.5]


def test_a_chain_can_be_driven_in_both_directions_and_both_ways_round_from_many_points():
    _, _, found = planned(room(3.0, 2.0))
    part = stretch(chains(found)[0], BRUSH)
    assert len(part.variants) % 4 == 0
    assert part.area == approx(sum(length(ring.waypoints) for ring in found) * BRUSH, rel=0.03)
    turns = set()
    for there, back in zip(part.variants[::2], part.variants[1::2]):
        path = there.path()
        assert (path == back.path()[::-1]).all() and (there.ends() == back.ends()[::-1]).all()
        assert (there.ends()[[0, 3]] == path[[0, -1]]).all()
        x, y = (path[:-1] - [1.5, 1.0]).T
        dx, dy = np.diff(path, axis=0).T
        turns.add(float(np.sign(np.sum(x * dy - y * dx))))
    assert turns == {-1.0, 1.0}
    assert len({tuple(np.round(variant.path()[0], 2)) for variant in part.variants[::2]}) >= 6


@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_no_path_along_a_chain_crosses_a_wall(resolution):
    context, _, found = planned(crooked(resolution))
    for chain in chains(found):
        for variant in stretch(chain, BRUSH).variants[::2]:
            for before, after in zip(variant.parts, variant.parts[1:]):
                assert context.ground.is_straight(before[-1], after[0])


def test_the_path_along_a_chain_goes_on_near_by_on_the_next_ring():
    _, _, found = planned(room(3.0, 2.0))
    for variant in stretch(chains(found)[0], BRUSH).variants[::2]:
        for before, after in zip(variant.parts, variant.parts[1:]):
            step = after[0] - before[-1]
            assert PASS * BRUSH - 0.02 < np.hypot(*step) < BESIDE + BRUSH + 4.0 * SPACING
