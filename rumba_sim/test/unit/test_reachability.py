"""Where a robot can stand and what its brush can reach, against closed forms and against a search point by point."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import crooked, quiet, room, slanted
from scipy import ndimage, spatial

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.floors import reachability
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import SLACK, reach, stands
from rumba_sim.model.kernel.sweeping.samples import REACHABLE, SWEEPABLE, sample_point
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

RESOLUTIONS = (0.005, 0.01, 0.02, 0.05, 0.1)
RADIUS, BRUSH = 0.17425, 0.17  # [m]


def area(plan, x=0.5, y=0.5):
    """Area that can be reached from (x, y) [m^2]."""
    terrain = plan.refined()
    return reach(terrain, quiet(), x, y).reachable * terrain.sample_pitch ** 2


@pytest.mark.parametrize('resolution', RESOLUTIONS)
def test_of_an_empty_room_all_but_a_rim_and_the_corners_can_be_reached(resolution):
    rim, half = RADIUS - 0.5 * BRUSH, 0.5 * BRUSH
    whole = (4.0 - 2.0 * rim) * (3.0 - 2.0 * rim) - (4.0 - math.pi) * half ** 2
    assert area(room(4.0, 3.0, resolution)) == approx(whole, rel=0.005)


@pytest.mark.parametrize('resolution', RESOLUTIONS)
@pytest.mark.parametrize('width', [0.4, 0.5, 0.8])
def test_a_door_is_passable_at_any_resolution_and_position(width, resolution):
    """Gaps of an even number of cells, and of an odd one, have their middle at a node, and at a centre."""
    for bottom in (1.0, 1.1):
        plan = room(4.0, 3.0, resolution, [(2.0, 0.0, 2.1, bottom), (2.0, bottom + width, 2.1, 3.0)])
        assert area(plan) == approx(2.0 * area(room(1.95, 3.0, resolution)), rel=0.03)


@pytest.mark.parametrize('resolution', [0.01, 0.02])
def test_a_door_that_is_a_little_wider_than_the_robot_is_passable_and_a_narrower_one_is_not(resolution):
    for width, is_passable in ((0.34, False), (0.36, True)):
        plan = room(4.0, 3.0, resolution, [(2.0, 0.0, 2.1, 1.0), (2.0, 1.0 + width, 2.1, 3.0)])
        assert (area(plan) > 0.6 * 12.0) == is_passable


@pytest.mark.parametrize('width, is_passable', [(0.36, True), (0.35, False)])
def test_a_passage_with_less_than_three_millimetres_to_spare_on_each_side_is_none(width, is_passable):
    plan = room(4.0, 3.0, 0.01, [(2.0, 0.0, 2.1, 1.0), (2.0, 1.0 + width, 2.1, 3.0)])
    assert 2.0 * (RADIUS + SLACK) == approx(0.3545) and (area(plan) > 6.0) == is_passable


def test_the_same_floor_has_the_same_area_at_any_resolution():
    areas = [area(crooked(resolution), 0.3, 0.3) for resolution in (0.01, 0.02, 0.05, 0.1)]
    assert areas == approx([areas[0]] * 4, rel=0.005)


def by_hand(plan, x, y):
    """The definition: samples within half a brush of a position at which the robot fits, on a lattice of 2.5 mm."""
    needed = clearance_needed(RADIUS, plan.resolution)
    where = stands(plan, needed, x, y)
    step = 0.0025
    rows, columns = (int(size * plan.resolution / step) for size in (plan.rows, plan.columns))
    v, u = np.mgrid[:rows, :columns] * step / plan.resolution
    fits = ndimage.map_coordinates(plan.safe_clearance, [v, u], order=1) >= needed
    fits &= where[np.rint(2.0 * v).astype(int), np.rint(2.0 * u).astype(int)]
    standing = spatial.cKDTree(np.stack([u[fits], v[fits]], axis=1) * plan.resolution)
    squares = plan.sample_squares
    rng = np.random.default_rng(0)
    samples = rng.integers((0, 0), (plan.rows * squares, plan.columns * squares), (3000, 2)).tolist()
    points = np.array([sample_point(row, column) for row, column in samples]) * plan.sample_pitch
    return [(row, column, distance) for (row, column), distance in zip(samples, standing.query(points)[0])]


@pytest.mark.parametrize('plan', [crooked(0.025), slanted(0.025)], ids=['crooked', 'slanted'])
def test_samples_are_reachable_as_the_definition_says(plan):
    found = reach(plan, quiet(), 0.5, 0.5).samples
    for row, column, distance in by_hand(plan, 0.5, 0.5):
        if found[row, column] & SWEEPABLE and abs(distance - 0.5 * BRUSH) > 0.003:
            assert bool(found[row, column] & REACHABLE) == (distance < 0.5 * BRUSH), (row, column, distance)


def strewn(seed):
    """A room of 4 x 3 m with walls of one cell of 5 cm, three on each square metre, but for the corner of the start."""
    generator, cells = np.random.default_rng(seed), np.full((60, 80), FREE, np.int8)
    cells[generator.integers(0, 60, 36), generator.integers(0, 80, 36)] = OCCUPIED
    cells[:14, :14] = FREE
    return FloorPlan('strewn', np.pad(cells, 1, mode='constant', constant_values=OCCUPIED), 0.05, (-0.05, -0.05))


def exact_area(plan, x, y):
    """Area within half a brush of positions that a robot reaches, by exact distances on a lattice of 5 mm [m^2]."""
    parts = 10
    step, free = plan.resolution / parts, plan.free.repeat(parts, 0).repeat(parts, 1)
    padded = np.pad(free, 1, mode='constant')
    inside = padded[:-1, :-1] & padded[:-1, 1:] & padded[1:, :-1] & padded[1:, 1:]
    away = step * ndimage.distance_transform_edt(inside)
    labels, _ = ndimage.label(away >= RADIUS + SLACK, np.ones((3, 3)))
    here = labels == labels[round((y - plan.origin[1]) / step), round((x - plan.origin[0]) / step)]
    stands = ndimage.binary_dilation(here, np.ones((3, 3)), 2, mask=away >= RADIUS)
    near = step * ndimage.distance_transform_edt(~stands)
    middle = 0.25 * (near[:-1, :-1] + near[1:, :-1] + near[:-1, 1:] + near[1:, 1:])
    return np.count_nonzero((middle <= 0.5 * BRUSH) & free) * step ** 2


def test_between_things_closer_than_two_robots_the_floor_in_reach_is_that_by_exact_distances():
    plans = [strewn(seed) for seed in (1, 6, 12)]
    found, exact = (sum(each(plan, 0.4, 0.4) for plan in plans) for each in (area, exact_area))
    assert found == approx(exact, rel=0.0013)  # 0.16 % less by interpolated ones


def test_straits_between_parts_are_looked_for_once(monkeypatch):
    """Among specks that takes seconds."""
    plan, asked, joined = strewn(1).refined(), [], reachability.joined
    monkeypatch.setattr(reachability, 'joined', lambda *args: asked.append(args) or joined(*args))
    needed = clearance_needed(RADIUS, plan.resolution)
    areas = reachability.Parts(plan, needed).areas
    reach(plan, quiet(), 0.4, 0.4)
    assert reachability.Parts(plan, needed).areas.tolist() == areas.tolist() and len(areas) > 1 and len(asked) == 1
    assert reachability.Parts(plan, needed - 0.02).areas.tolist() != areas.tolist() and len(asked) == 2


def test_no_sample_in_a_wall_or_over_a_cliff_can_be_swept():
    plan = crooked(0.02, cliff=(3.4, 2.4, 4.0, 3.0))
    samples = reach(plan, quiet(), 0.5, 0.5).samples
    floor = (plan.free & ~plan.cliff).repeat(2, 0).repeat(2, 1)
    assert ((samples & SWEEPABLE > 0) == floor).all()
    assert not (samples & REACHABLE > 0)[~floor].any() and (samples & REACHABLE).any()


def test_a_robot_keeps_away_from_a_cliff_as_from_a_wall():
    with_cliff = crooked(0.02, cliff=(3.4, 2.4, 4.0, 3.0))
    occupancy = with_cliff.occupancy.copy()
    occupancy[with_cliff.cliff & (occupancy == FREE)] = OCCUPIED
    with_wall = FloorPlan('wall', occupancy, 0.02, with_cliff.origin)
    assert area(with_cliff) == area(with_wall)


def test_every_start_in_the_same_region_reaches_the_same_and_the_answer_is_remembered():
    plan = room(5.0, 2.4, 0.02, boxes=[(2.8, 0.0, 2.9, 2.4)])
    left, again, right = (reach(plan, quiet(), x, 1.0) for x in (1.0, 2.2, 4.0))
    assert again is left and right is not left
    assert not (left.samples & right.samples & REACHABLE).any()
    assert (reach(plan, quiet(), 0.4, 0.4).samples == left.samples).all()
    narrow = reach(plan, quiet(brush={'width': 0.1}), 1.0, 1.0)
    assert narrow.reachable < left.reachable


def test_a_start_where_the_robot_does_not_fit_is_refused():
    with pytest.raises(MapError, match=r'a robot of radius 0.174 m does not fit$'):
        reach(crooked(0.02), quiet(), 1.2, 0.5)
