"""Crumbs: which there are, the paths past them, and the lines in their middle."""

import math

import numpy as np
import pytest
from floors import ground, knowing, length, off, wiped_but
from pytest import approx
from rooms import crooked, room

from rumba_cleaning.planning.decompose.regions import regions
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.crumbs import HEADINGS, LEAST, crumbs, middle_lines
from rumba_sim.model.common.geometry import Pose

START = Pose(0.5, 0.5, 0.0)


def missed_alone(plan, *boxes):
    """The context of a robot that has swept everything except what lies in boxes."""
    return wiped_but(knowing(plan, START), *boxes)


def found(context, least=0.0):
    """The crumbs on the floor of a context, those of an area [m^2] or more."""
    return crumbs(context.ground, context.swept.missing_share(), regions(context.ground), least)


@pytest.mark.parametrize('resolution', [0.01, 0.02, 0.05])
def test_a_spot_is_passed_over_in_any_direction(resolution):
    context = missed_alone(room(4.0, 3.0, resolution), (2.0, 1.5, 2.1, 1.6))
    spot, = found(context)
    assert spot.area == approx(0.01, rel=0.15) and len(spot.variants) == HEADINGS
    for variant in spot.variants:
        swept = context.swept.copy()
        path = variant.path()
        ahead = 2.5 * (path[1] - path[0])
        drive(swept, np.array([path[0] - ahead, path[1] + ahead]))
        assert swept.coverage > 1.0 - 0.3 * spot.area / swept.reachable_area


@pytest.mark.parametrize('resolution', [0.01, 0.02, 0.05])
def test_a_strip_is_driven_along_its_middle_from_either_end(resolution):
    context = missed_alone(room(4.0, 3.0, resolution), (1.0, 1.5, 2.5, 1.6))
    strip, = found(context)
    path = strip.variants[0].path()
    assert strip.area == approx(0.15, rel=0.15) and length(path) == approx(1.4, abs=0.12)
    assert max(abs(path[:, 1] - 1.55)) < 0.02 and (strip.variants[1].path() == path[::-1]).all()


@pytest.mark.parametrize('resolution', [0.01, 0.02])
def test_what_is_left_in_a_broken_line_is_one_strip_if_its_pieces_are_near_enough(resolution):
    floor = ground(room(4.0, 3.0, resolution))
    share = np.zeros(floor.plan.occupancy.shape, np.float32)
    row, column, piece, gap, thick = (round(each / resolution) for each in (1.5, 1.0, 0.16, 0.04, 0.02))
    for number in range(8):
        share[row:row + thick, column + number * (piece + gap):][:, :piece] = 1.0

    def parts(**only):
        return crumbs(floor, share, regions(floor), **only)

    assert len(parts()) == len(parts(apart=0.03)) == 8
    strip, = parts(apart=0.06)
    assert strip.area == approx(8 * 0.16 * 0.02) and length(strip.variants[0].path()) == approx(1.5, abs=0.12)
    assert parts(least=0.025, apart=0.06) and not parts(least=0.026, apart=0.06)


def test_a_bent_strip_is_driven_around_its_bend():
    context = missed_alone(room(4.0, 3.0, 0.02), (1.0, 1.0, 1.9, 1.1), (1.0, 1.1, 1.1, 2.0))
    path = max(found(context), key=lambda part: part.area).variants[0].path()
    assert min(off(np.array([[1.05, 1.8]]), *ends)[0] for ends in zip(path[:-1], path[1:])) < 0.03
    assert min(off(np.array([[1.7, 1.05]]), *ends)[0] for ends in zip(path[:-1], path[1:])) < 0.03


def test_specks_are_no_crumbs():
    side = 0.7 * math.sqrt(LEAST)
    context = missed_alone(room(4.0, 3.0, 0.01), (2.0, 1.5, 2.0 + side, 1.5 + side))
    assert context.swept.missed().any() and not found(context)


def test_crumbs_that_are_smaller_than_wanted_are_left_out():
    context = missed_alone(room(4.0, 3.0, 0.02), (1.0, 1.5, 1.1, 1.6), (2.0, 1.5, 2.2, 1.6))
    assert [len(found(context, least)) for least in (0.0, 0.005, 0.015, 0.03)] == [2, 2, 1, 0]


def test_each_crumb_lies_in_its_region_and_its_path_where_the_robot_can_stand():
    plan = room(5.0, 2.4, 0.05, [(2.8, 0.0, 2.9, 0.3), (2.8, 1.0, 2.9, 2.4)])
    context = missed_alone(plan, (1.0, 1.1, 1.2, 1.2), (4.0, 1.1, 4.2, 1.2))
    labels = regions(context.ground)
    expected = {int(labels[context.ground.node(x, 1.15)]) for x in (1.1, 4.1)}
    assert {crumb.region for crumb in found(context)} == expected and len(expected) == 2
    untouched = knowing(crooked(), START)
    for crumb in found(untouched):
        for variant in crumb.variants:
            assert untouched.ground.are_free(variant.path()).all()


def test_no_path_along_a_strip_that_the_robot_can_only_pass_beside_leads_through_a_wall():
    """A slot between two rooms, from one side of which to the other the strip lies aslant."""
    plan = room(3.0, 2.2, 0.025, [(0.0, 0.9, 2.6, 0.95), (0.0, 1.25, 2.6, 1.3)])
    context = knowing(plan, Pose(0.5, 0.5, 0.0))
    x, y = (0.025 * (np.arange(size) + 0.5) for size in plan.occupancy.shape[::-1])
    share = (np.abs(y[:, np.newaxis] - 1.0 - 0.1 * (x - 0.3)) < 0.05) & (x > 0.3) & (x < 2.3)
    strips = crumbs(context.ground, share.astype(np.float32), regions(context.ground))
    assert strips and all(context.ground.is_straight(*leg) for strip in strips for variant in strip.variants
                          for leg in zip(variant.path(), variant.path()[1:]) if math.dist(*leg) > 0.2)


def test_the_middle_of_a_bar_is_one_line_along_it():
    cells = np.zeros((12, 40), bool)
    cells[3:8, 2:38] = True
    line, = middle_lines(cells, 8)
    assert abs(line[:, 0] - 5).max() <= 1 and np.ptp(line[:, 1]) >= 28
    assert (np.abs(np.diff(line, axis=0)).max(axis=1) == 1).all()


def test_long_branches_have_lines_of_their_own_and_short_ones_have_none():
    cells = np.zeros((40, 60), bool)
    cells[4, 2:58] = True
    cells[4:34, 20] = True
    cells[4:8, 40] = True
    lines = middle_lines(cells, 8)
    assert sorted(len(line) for line in lines)[-1] >= 56 and len(lines) == 2


def test_a_ring_of_cells_has_lines_around_it():
    rows, columns = np.indices((60, 60))
    away = np.hypot(rows - 30, columns - 30)
    lines = middle_lines((away > 20) & (away < 24), 8)
    assert 0.8 * math.pi * 44 < sum(len(line) for line in lines) * 1.2 < 1.4 * math.pi * 44


def test_ground_without_crumbs_has_none():
    plan = room(4.0, 3.0)
    share = np.zeros(plan.refined().occupancy.shape, np.float32)
    floor = ground(plan.refined())
    assert crumbs(floor, share, regions(floor)) == []
