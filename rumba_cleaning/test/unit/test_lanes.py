"""Lanes on floors whose best lanes are known, and on random floors: what they clean, and where they lie."""

import math

import numpy as np
import pytest
from floors import BRUSH, along, ground, length, part_of, tilted, window_around
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import crooked, distances, quiet, room

from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.decompose.turned_floor import main_direction
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths import lanes
from rumba_cleaning.planning.swaths.lanes import BLOCK, TURN, Layout
from rumba_cleaning.planning.swaths.rings import outlines
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

SPEED = 0.3
APART = (1.0 - Layout().overlap) * BRUSH  # [m] from lane to lane
FINE = pytest.mark.parametrize('resolution', [0.02, 0.05])


def blocks(floor, missed, *others):
    """The blocks of lanes that clean what was missed."""
    return lanes.blocks(floor, missed, window_around(missed), *others)


def direction(lane):
    """Direction of a lane, of its two the one from -pi/2 to pi/2 [rad]."""
    (x, y), (to_x, to_y) = lane
    angle = math.atan2(to_y - y, to_x - x)
    return angle - math.copysign(math.pi, angle) if abs(angle) > math.pi / 2.0 else angle


def lies_along(block, axis):
    """Whether all lanes of a block run along an axis: 0, x, or 1, y."""
    return all(lane[0][1 - axis] == approx(lane[1][1 - axis]) for lane in block.lanes)


def area(missed, plan):
    """Area of cells [m^2]."""
    return np.count_nonzero(missed) * plan.resolution ** 2


def share(found, missed, plan):
    """Share of what was missed that blocks promise to clean."""
    return sum(block.area for block in found) / area(missed, plan)


def cleaned(found, plan, start):
    """The missed cells that the brush sweeps on the lanes, driven on paper: bool (rows, columns)."""
    swept = Swept(plan, quiet())
    swept.begin(*start)
    before = swept.missed()
    for block in found:
        for lane in block.lanes:
            drive(swept, lane)
    return before & ~swept.missed()


def all_of(plan):
    """The cells of a plan that the brush can reach: bool (rows, columns)."""
    x, y, _ = plan.most_open_pose()
    swept = Swept(plan, quiet())
    swept.begin(x, y)
    return swept.missed()


# --- rectangles ----------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('width, height', [(3.4, 2.0), (3.4, 1.0), (1.4, 2.4), (0.6, 2.0), (1.0, 0.3), (0.4, 0.2)])
@FINE
def test_a_rectangle_is_one_block_with_lanes_along_its_longer_side_almost_a_brush_apart(resolution, width, height):
    plan = room(4.0, 3.0, resolution)
    missed = part_of(plan, (0.3, 0.3, 0.3 + width, 0.3 + height))
    block, = blocks(ground(plan), missed, BRUSH, SPEED)
    along_lanes, across = (0, 1) if width > height else (1, 0)
    sides = (width, height)
    assert lies_along(block, along_lanes)
    assert len(block.lanes) == math.ceil(sides[across] / APART) and block.area == approx(area(missed, plan))
    positions = sorted(lane[0][across] for lane in block.lanes)
    assert positions == approx([lane[0][across] for lane in block.lanes])  # one beside the other
    assert positions[0] - 0.5 * BRUSH <= 0.3 + 0.5 * resolution
    assert positions[-1] + 0.5 * BRUSH >= 0.3 + sides[across] - 0.5 * resolution
    assert max(np.diff(positions)) <= APART + 1e-9
    for lane in block.lanes:
        assert lane[:, along_lanes] == approx([0.3, 0.3 + sides[along_lanes]])
    turns = block.time - sum(length(lane) for lane in block.lanes) / SPEED
    assert turns == approx(BLOCK + TURN * len(block.lanes)) and turns > 2.0 + 2.0 * len(block.lanes)


@FINE
def test_the_brush_cleans_on_the_lanes_all_that_a_block_counts(resolution):
    plan = room(4.0, 3.0, resolution, [(1.7, 1.3, 2.2, 1.7)])
    missed = part_of(plan, (0.3, 0.3, 3.5, 2.6)) & all_of(plan)
    found = blocks(ground(plan), missed, BRUSH, SPEED)
    promised = sum(block.area for block in found)
    assert promised <= area(missed & cleaned(found, plan, (0.5, 0.5)), plan) + 0.01 * promised


def test_lanes_overlap_by_a_share_of_the_brush():
    plan = room(4.0, 3.0)
    missed = part_of(plan, (0.3, 0.3, 3.7, 2.3))
    for brush in (0.1, 0.3):
        block, = blocks(ground(plan), missed, brush, SPEED)
        apart = (1.0 - Layout().overlap) * brush
        assert len(block.lanes) == math.ceil((2.0 - brush) / apart) + 1
        assert np.diff([lane[0, 1] for lane in block.lanes]) == approx(apart)


def test_a_block_that_is_cleaned_faster_takes_less_time():
    plan = room(4.0, 3.0)
    missed = part_of(plan, (0.3, 0.3, 3.7, 1.3))
    slow, fast = (blocks(ground(plan), missed, BRUSH, speed)[0] for speed in (0.2, 0.4))
    distance = sum(length(lane) for lane in slow.lanes)
    assert slow.time - fast.time == approx(distance / 0.2 - distance / 0.4)


def test_the_array_of_missed_cells_is_not_changed():
    plan = room(4.0, 3.0)
    missed = part_of(plan, (0.3, 0.3, 3.7, 1.3))
    before = missed.copy()
    blocks(ground(plan), missed, BRUSH, SPEED)
    blocks(ground(plan), missed, BRUSH, SPEED, 0.3)
    assert (missed == before).all()


# --- other shapes --------------------------------------------------------------------------------------------------

SHAPES = {  # boxes, the first of which is wide and the second high
    'L': [(0.3, 0.3, 3.7, 1.0), (0.3, 1.0, 1.0, 2.7)],
    'mirrored L': [(0.3, 0.3, 3.7, 1.0), (3.0, 1.0, 3.7, 2.7)],
    'T': [(0.3, 2.0, 3.7, 2.7), (1.65, 0.3, 2.35, 2.0)],
}


@pytest.mark.parametrize('shape', list(SHAPES))
@FINE
def test_each_arm_of_an_l_or_a_t_is_cleaned_along_its_length(resolution, shape):
    plan = room(4.0, 3.0, resolution)
    missed = part_of(plan, *SHAPES[shape])
    found = blocks(ground(plan), missed, BRUSH, SPEED)
    assert 0.97 <= share(found, missed, plan) <= 1.0 + 1e-9
    assert np.count_nonzero(missed & cleaned(found, plan, (0.5, 0.5))) >= 0.97 * np.count_nonzero(missed)
    wide, high = found
    assert wide.area > high.area and lies_along(wide, 0) and lies_along(high, 1)
    assert {len(wide.lanes), len(high.lanes)} <= {4, 5}


@FINE
def test_the_floor_around_an_obstacle_is_cut_into_blocks_beside_it(resolution):
    plan = room(4.0, 3.0, resolution, [(1.7, 1.3, 2.2, 1.7)])
    floor, missed = ground(plan), all_of(plan)
    found = blocks(floor, missed, BRUSH, SPEED)
    assert 0.93 <= share(found, missed, plan) <= 1.0 + 1e-9 and len(found) >= 4
    for block in found:
        for lane in block.lanes:
            assert min(distances(plan, along(lane))) >= floor.reach
    assert np.count_nonzero(missed & ~cleaned(found, plan, (0.5, 0.5))) <= 0.03 * np.count_nonzero(missed)


def test_a_lane_goes_on_over_a_short_piece_of_clean_floor_and_ends_at_a_long_one():
    plan = room(6.0, 2.0)
    short, long = (part_of(plan, (0.3, 0.5, 2.5, 1.0), (2.5 + gap, 0.5, 5.5, 1.0)) for gap in (0.4, 0.7))
    block, = blocks(ground(plan), short, BRUSH, SPEED)
    assert [lane[:, 0].tolist() for lane in block.lanes] == [approx([0.3, 5.5])] * 3
    assert block.area == approx(area(short, plan))
    found = sorted(blocks(ground(plan), long, BRUSH, SPEED), key=lambda block: block.lanes[0][0, 0])
    assert [lane[:, 0].tolist() for block in found for lane in block.lanes] == [approx([0.3, 2.5])] * 3 + [
        approx([3.2, 5.5])] * 3


def test_strips_that_lie_apart_are_separate_blocks():
    plan = room(4.0, 3.0)
    found = blocks(ground(plan), part_of(plan, (0.5, 0.4, 3.5, 0.9), (0.5, 1.6, 3.5, 2.1)), BRUSH, SPEED)
    assert sorted(round(block.lanes[0][0, 1], 1) for block in found) == [0.5, 1.7]
    assert [len(block.lanes) for block in found] == [3, 3]


@FINE
def test_among_pillars_no_floor_is_counted_twice(resolution):
    plan = crooked(resolution, cliff=(3.4, 2.4, 4.0, 3.0))
    missed = all_of(plan)
    found = blocks(ground(plan), missed, BRUSH, SPEED)
    assert 0.9 <= share(found, missed, plan) <= 1.0 + 1e-9
    promised = sum(block.area for block in found)
    assert promised <= area(missed & cleaned(found, plan, (0.5, 0.5)), plan) + 0.01 * promised


def test_a_strip_that_is_narrower_than_the_brush_is_one_lane():
    plan = room(4.0, 3.0, 0.02)
    block, = blocks(ground(plan), part_of(plan, (0.5, 1.4, 3.0, 1.5)), BRUSH, SPEED)
    lane, = block.lanes
    assert lane[:, 0] == approx([0.5, 3.0]) and lane[0, 1] == lane[1, 1] == approx(1.45, abs=0.05)


def test_what_lies_along_a_wall_is_cleaned_from_as_near_as_the_robot_can_come():
    plan = room(4.0, 3.0, 0.02)
    floor = ground(plan)
    missed = part_of(plan, (0.5, 0.0, 3.5, 0.24))
    block, = blocks(floor, missed, BRUSH, SPEED)
    lane, = block.lanes
    assert floor.reach <= lane[0, 1] <= floor.reach + 0.03 and min(distances(plan, along(lane))) >= floor.reach


def test_neither_specks_nor_a_clean_floor_make_blocks():
    plan = room(4.0, 3.0)
    floor = ground(plan)
    specks = np.zeros(plan.occupancy.shape, bool)
    assert blocks(floor, specks, BRUSH, SPEED) == []
    specks[10:60:12, 10:80:12] = True
    assert specks.any()
    assert blocks(floor, specks, BRUSH, SPEED) == [] and blocks(floor, specks, BRUSH, SPEED, 0.5) == []


def test_floor_that_the_robot_cannot_reach_makes_no_blocks():
    plan = room(4.0, 3.0, boxes=[(0.0, 0.3, 4.0, 0.35)])
    missed = part_of(plan, (0.0, 0.0, 4.0, 0.25))
    assert missed.any() and blocks(ground(plan), missed, BRUSH, SPEED) == []


# --- turned floors -------------------------------------------------------------------------------------------------

@pytest.mark.thorough(except_for=['0.02-20', '0.05--20'])
@pytest.mark.parametrize('degrees', [20, -20])
@FINE
def test_lanes_of_a_turned_room_run_along_its_walls_and_keep_off_them(resolution, degrees):
    plan = tilted(4.0, 2.5, math.radians(degrees), resolution)
    floor, missed = ground(plan), all_of(plan)
    found = blocks(floor, missed, BRUSH, SPEED, main_direction(outlines(floor)))
    for block in found:
        for lane in block.lanes:
            assert abs((math.degrees(direction(lane)) - degrees + 45.0) % 90.0 - 45.0) <= 1.5
            assert min(distances(plan, along(lane))) >= floor.reach
    assert 0.9 <= share(found, missed, plan) <= 1.01
    x, y, _ = plan.most_open_pose()
    assert np.count_nonzero(missed & ~cleaned(found, plan, (x, y))) <= 0.06 * np.count_nonzero(missed)
    most = max(found, key=lambda block: block.area)
    assert abs(math.degrees(direction(most.lanes[0])) - degrees) <= 1.5  # along the longer walls
    apart = np.diff([lane[0] for lane in most.lanes], axis=0) @ [-math.sin(math.radians(degrees)),
                                                                 math.cos(math.radians(degrees))]
    assert abs(apart).max() <= APART + 0.001 and np.median(abs(apart)) == approx(APART, abs=1e-4)
    assert len(most.lanes) >= 12


# --- random floors -------------------------------------------------------------------------------------------------

@st.composite
def floors(draw):
    """A small plan with boxes, the missed cells of it, and an angle [rad]."""
    resolution = draw(st.sampled_from([0.1, 0.05, 0.02]))
    generator = np.random.default_rng(draw(st.integers(0, 10 ** 6)))
    boxes = [(x, y, x + width, y + height) for x, y, width, height in generator.uniform(
        (0.0, 0.0, 0.05, 0.05), (1.4, 1.2, 0.5, 0.5), (draw(st.integers(0, 3)), 4))]
    plan = room(1.4, 1.2, resolution, boxes)
    kind = draw(st.sampled_from(['blots', 'dust', 'all']))
    missed = plan.free.copy()
    if kind == 'dust':
        missed &= generator.random(plan.occupancy.shape) < draw(st.sampled_from([0.05, 0.3, 0.8]))
    elif kind == 'blots':
        missed &= part_of(plan, *((x, y, x + width, y + height) for x, y, width, height in generator.uniform(
            (0.0, 0.0, 0.05, 0.05), (1.4, 1.2, 1.0, 0.6), (3, 4))))
    return plan, missed, draw(st.sampled_from([0.0, 0.0, 0.35, -0.7]))


@settings(max_examples=25)
@given(floors())
def test_on_any_floor_lanes_keep_off_walls_and_count_no_floor_twice(example):
    plan, missed, angle = example
    floor = ground(plan)
    found = blocks(floor, missed, BRUSH, SPEED, angle)
    assert all(block.area > 0.0 and block.time > 0.0 and block.lanes for block in found)
    assert sum(block.area for block in found) <= area(missed, plan) * (1.0 if angle == 0.0 else 1.05) + 1e-9
    driven = [along(lane, plan.resolution) for block in found for lane in block.lanes]
    if driven:
        least = floor.reach if angle == 0.0 else floor.reach - 0.1 * plan.resolution
        assert min(distances(plan, np.concatenate(driven))) >= least


def test_a_floor_of_a_single_cell_makes_no_blocks():
    grid = np.full((9, 9), OCCUPIED, np.int8)
    grid[4, 4] = FREE
    plan = FloorPlan('one', grid, 0.1, (0.0, 0.0))
    assert blocks(ground(plan), plan.free, BRUSH, SPEED) == []
