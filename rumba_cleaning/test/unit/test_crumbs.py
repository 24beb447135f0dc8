"""Crumbs: which there are, the paths past them, and the lines in their middle."""

import math

import numpy as np
import pytest
from floors import ground, knowing, length, wiped_but
from pytest import approx
from rooms import crooked, room

from rumba_cleaning.planning.decompose.regions import regions
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.crumbs import HEADINGS, LEAST, PIECE, crumbs
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
    assert spot.is_crumb and spot.area == approx(0.01, rel=0.15) and len(spot.variants) == HEADINGS
    for variant in spot.variants:
        swept = context.swept.copy()
        path = variant.path()
        ahead = 2.5 * (path[1] - path[0])
        drive(swept, np.array([path[0] - ahead, path[1] + ahead]))
        assert swept.coverage > 1.0 - 0.3 * spot.area / swept.reachable_area


@pytest.mark.parametrize('resolution', [0.01, 0.02, 0.05])
def test_a_strip_is_driven_along_its_middle_piece_by_piece_to_and_fro(resolution):
    context = missed_alone(room(4.0, 3.0, resolution), (1.0, 1.5, 2.5, 1.6))
    pieces = found(context)
    assert len(pieces) in (5, 6) and sum(part.area for part in pieces) == approx(0.15, rel=0.15)
    paths = [part.variants[0].path() for part in pieces]
    assert sum(length(path) for path in paths) == approx(1.5, abs=0.3)
    assert max(length(path) for path in paths) < PIECE + 0.06
    assert max(abs(path[:, 1] - 1.55).max() for path in paths) < 0.03
    assert all((part.variants[1].path() == path[::-1]).all() for part, path in zip(pieces, paths))


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
    strip = parts(apart=0.06)
    assert len(strip) in (5, 6) and sum(part.area for part in strip) == approx(8 * 0.16 * 0.02)
    assert parts(least=0.025, apart=0.06) and not parts(least=0.026, apart=0.06)


@pytest.mark.parametrize('boxes', [
    [(1.0, 1.0, 1.9, 1.1), (1.0, 1.1, 1.1, 2.0)],  # bent
    [(1.0, 1.0, 2.4, 1.1), (1.7, 1.1, 1.8, 2.0)],  # with a branch
    [(1.0, 1.0, 2.0, 1.1), (1.0, 1.1, 1.1, 1.9), (1.9, 1.1, 2.0, 1.9), (1.0, 1.9, 2.0, 2.0)]])  # closed
def test_the_pieces_of_a_bent_or_branching_strip_sweep_it(boxes):
    context = missed_alone(room(4.0, 3.0, 0.02), *boxes)
    swept = context.swept.copy()
    for part in found(context):
        drive(swept, part.variants[0].path())
    missed = 1.0 - context.swept.coverage
    assert missed > 0.01 and 1.0 - swept.coverage < 0.06 * missed


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
