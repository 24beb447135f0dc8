"""The memory of what a robot swept, against the floor of the world in which the same brush sweeps."""

import math

import numpy as np
import pytest
from floors import part_of, two_rooms
from pytest import approx
from rooms import crooked, quiet, room

from rumba_cleaning.belief.swept import Swept
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

CLIFF = (3.8, 2.8, 4.0, 3.0)
WIDTH = 0.17  # [m] of the brush


def memory(plan, x=1.0, y=1.0):
    """The memory of a robot that begins at (x, y) [m]."""
    swept = Swept(plan.refined(), quiet())
    swept.begin(x, y)
    return swept


def followed(swept, *points, brushes_up=False):
    """The memory after the robot passed points (x, y) [m], heading along x."""
    for x, y in points:
        swept.follow(Pose(x, y, 0.0), brushes_up)
    return swept


def area(swept):
    """Area that was swept [m^2]."""
    return swept.coverage * swept.reachable_area


def columns_of(swept):
    """Columns in which anything was swept, counted from x = 0."""
    return np.flatnonzero((swept.missing_share() < memory(room(4.0, 3.0)).missing_share()).any(axis=0)) - 2


@pytest.mark.parametrize('resolution, seed', [(0.02, 1), (0.05, 2), (0.1, 3)])
def test_a_robot_that_knows_its_pose_in_each_tick_knows_what_it_swept(resolution, seed):
    plan = crooked(resolution, cliff=CLIFF, carpet=(0.0, 0.0, 1.0, 1.0))
    world = World(plan, quiet(), seed=seed)
    robot = world.spawn('rumba')
    swept = memory(plan, world.start.x, world.start.y)
    swept.follow(robot.pose, False)
    generator = np.random.default_rng(seed)
    for _ in range(60):
        v, w = generator.uniform(-0.1, 0.4), generator.uniform(-1.5, 1.5)
        robot.brushes_up = bool(generator.random() < 0.2)
        for _ in range(25):
            robot.command(v, w, world.tick)
            world.step()
            swept.follow(robot.pose, robot.brushes_up)
    assert robot.bumps > 0 and 0.03 < world.floor.coverage < 0.9 and not robot.has_fallen
    assert swept.coverage == approx(world.floor.coverage, abs=0.002)  # the world sweeps in longer strides
    assert swept.reachable_area == world.floor.reachable_area
    missing = world.floor.sweep.missing_share()
    assert np.abs(swept.missing_share() - missing).mean() < 0.005
    assert (swept.missed() == (swept.missing_share() >= 0.5)).all() and swept.missed().dtype == np.bool_


def test_brushes_that_are_up_sweep_nothing_even_once_they_are_down_again():
    plan = room(4.0, 3.0)
    swept = followed(memory(plan), *((x, 1.0) for x in np.arange(1.0, 2.01, 0.1)), brushes_up=True)
    assert area(swept) == 0.0 and swept.coverage == 0.0
    followed(swept, (2.1, 1.0))
    assert area(swept) == approx(0.1 * WIDTH, rel=0.05)
    assert (columns_of(swept) * 0.025 >= 1.99).all()


def test_a_jump_sweeps_nothing_and_a_long_step_does():
    plan = room(4.0, 3.0)
    for step in ((1.0, 0.0), (0.0, -0.6), (0.4, 0.4)):
        swept = followed(memory(plan), (1.0, 1.0), (1.0 + step[0], 1.0 + step[1]))
        assert area(swept) == 0.0, step
    followed(swept, (1.8, 1.4))  # it goes on from the pose after the jump
    columns = columns_of(swept) * 0.025
    assert area(swept) == approx(0.4 * WIDTH, rel=0.05) and columns.min() >= 1.37 and columns.max() <= 1.8


def test_a_robot_that_turns_sweeps_a_disc():
    plan = room(4.0, 3.0, 0.02)
    swept = memory(plan)
    for theta in np.arange(0.0, math.pi + 0.1, 0.1):
        swept.follow(Pose(2.0, 1.5, theta), False)
    assert area(swept) == approx(math.pi * (0.5 * WIDTH) ** 2, rel=0.05)


def test_sweep_from_pose_to_pose_equals_follow():
    plan = room(4.0, 3.0, 0.02)
    one, other = memory(plan), memory(plan)
    one.sweep(Pose(1.0, 1.0, 0.3), Pose(1.2, 1.1, 0.5))
    other.follow(Pose(1.0, 1.0, 0.3), False)
    other.follow(Pose(1.2, 1.1, 0.5), False)
    assert (one.missing_share() == other.missing_share()).all() and one.coverage == other.coverage > 0.0


def test_begin_forgets_what_was_swept_and_where_the_robot_was():
    plan = room(4.0, 3.0)
    swept = followed(memory(plan), (1.0, 1.0), (1.3, 1.0))
    assert swept.coverage > 0.0
    swept.begin(1.0, 1.0)
    assert swept.coverage == 0.0 and (swept.missing_share() == memory(plan).missing_share()).all()
    followed(swept, (1.2, 1.0))
    assert area(swept) == 0.0
    followed(swept, (1.2, 1.0), (1.4, 1.0))
    assert area(swept) == approx(0.2 * WIDTH, rel=0.05)


def test_begin_counts_what_can_be_reached_from_there():
    plan = room(5.0, 2.4, boxes=[(2.8, 0.0, 2.9, 2.4)])
    swept = memory(plan, 1.0, 1.0)
    left = swept.missed()
    swept.begin(4.0, 1.0)
    right = swept.missed()
    assert left.any() and right.any() and not left[:, 115:].any() and not right[:, :116].any()
    assert swept.reachable_area == approx(swept.missing_share().sum() * 0.025 ** 2)
    with pytest.raises(MapError, match='a robot of radius 0.174 m does not fit'):
        swept.begin(2.7, 1.0)


def test_a_copy_holds_the_same_and_changes_on_its_own():
    plan = two_rooms()
    swept = followed(memory(plan), (1.0, 1.0), (1.3, 1.0))
    copy = swept.copy()
    assert copy.coverage == swept.coverage > 0.0 and copy.reachable_area == swept.reachable_area
    assert (copy.missing_share() == swept.missing_share()).all()
    before, shares = swept.coverage, swept.missing_share()
    followed(copy, (2.0, 1.0), (2.3, 1.0))
    assert copy.coverage == approx(2.0 * before, rel=0.2)
    assert swept.coverage == before and (swept.missing_share() == shares).all()
    followed(swept, (1.0, 1.5), (1.3, 1.5), (1.3, 1.8))
    assert swept.coverage > before and copy.missing_share()[60:].sum() == memory(plan).missing_share()[60:].sum()


def test_coverage_is_complete_if_nothing_can_be_reached():
    plan = room(4.0, 3.0)
    swept = Swept(plan, quiet())
    assert (swept.coverage, swept.reachable_area) == (1.0, 0.0) and not swept.missed().any()
    followed(swept, (1.0, 1.0), (1.3, 1.0))
    assert swept.coverage == 1.0 and not swept.missed().any()


def test_floor_beside_cliffs_and_walls_that_the_brush_cannot_reach_does_not_count():
    plan = crooked(cliff=CLIFF).refined()
    swept = memory(plan)
    cliff = part_of(plan, CLIFF)
    assert not swept.missed()[cliff | ~plan.free].any() and swept.missed().any()
    before = swept.coverage
    followed(swept, (3.5, 2.9), (3.7, 2.9), (3.9, 2.9))
    assert before < swept.coverage < 0.01
    followed(swept, (0.3, 0.0), (0.6, 0.0), (0.9, 0.0))  # along the rim, which the brush cannot reach
    assert area(swept) < 0.2 * WIDTH


def test_what_can_be_reached_with_less_clearance_is_as_on_a_map_that_shows_why():
    apart = room(5.0, 2.4, 0.05, [(2.8, 0.0, 2.9, 2.4)])
    path = (1.0, 1.0), (1.3, 1.0), (1.6, 1.0)
    swept, alone = followed(memory(two_rooms()), *path), followed(memory(apart), *path)
    part = swept.within(apart.refined().safe_clearance, *swept.start)
    assert part.share == approx(alone.reachable_area / swept.reachable_area) and 0.5 < part.share < 0.7
    assert part.coverage == approx(alone.coverage) and alone.coverage > 1.4 * swept.coverage > 0.0
    clearance = two_rooms().refined().safe_clearance
    assert swept.within(clearance, *swept.start) == (1.0, approx(swept.coverage))
    assert swept.within(0.0 * clearance, *swept.start) == (1.0, swept.coverage)  # not even the start is left


@pytest.mark.parametrize('resolution', [0.02, 0.025, 0.03, 0.05])
def test_a_memory_that_goes_on_with_a_plan_of_other_cells_keeps_what_was_swept_where_it_was(resolution):
    swept = followed(memory(room(4.0, 3.0, 0.02)), *((x, 1.0) for x in np.arange(1.0, 3.01, 0.1)))
    before = area(swept)
    plan = room(4.0, 3.0, resolution)
    swept.learn(plan.refined(), [(1.0, 1.0)])
    assert area(swept) == approx(before, rel=0.04)
    y, x = ((cells + 0.5) * plan.refined().resolution + plan.origin[axis]
            for axis, cells in zip((1, 0), np.nonzero(swept.missing_share() < memory(plan).missing_share())))
    assert 0.96 < x.min() < 1.04 and 2.96 < x.max() < 3.04
    assert abs(y - 1.0).max() < 0.5 * WIDTH + 0.03


def test_what_can_be_reached_counts_from_the_place_from_which_that_is_most():
    plan = room(5.0, 2.4, boxes=[(4.0, 0.0, 4.1, 2.4)]).refined()  # 4 m x 2.4 m, and a closed room of 0.9 m
    swept = memory(plan)
    wanted = swept.reachable_area
    swept.learn(plan, [(4.5, 1.0), (1.0, 1.0)])
    assert swept.start == (1.0, 1.0) and swept.reachable_area == wanted
