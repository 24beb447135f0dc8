"""The direction of the walls, and the floor on a grid that is turned to it."""

import math

import numpy as np
import pytest
from floors import ground, tilted, window_around
from pytest import approx
from rooms import crooked, room

from rumba_cleaning.planning.decompose.turned_floor import TurnedFloor, main_direction
from rumba_cleaning.planning.swaths.rings import outlines

FINE = pytest.mark.parametrize('resolution', [0.02, 0.05])


@pytest.mark.parametrize('degrees', [0, 20, -20, 45, 65, -70])
@FINE
def test_the_main_direction_is_that_of_the_walls(resolution, degrees):
    found = math.degrees(main_direction(outlines(ground(tilted(4.0, 2.5, math.radians(degrees), resolution)))))
    assert -45.0 <= found <= 45.0 and abs((found - degrees + 45.0) % 90.0 - 45.0) <= 1.5


@pytest.mark.parametrize('degrees', [1.0, -2.0])
def test_a_floor_that_is_turned_by_two_degrees_or_less_is_not_turned(degrees):
    assert main_direction(outlines(ground(tilted(4.0, 2.5, math.radians(degrees), 0.02)))) == 0.0


def test_the_main_direction_is_that_of_the_longer_walls():
    slanting = [(0.8 + x, 1.5 + 0.58 * x, 0.85 + x, 1.55 + 0.58 * x) for x in np.arange(0.0, 1.5, 0.01)]
    assert main_direction(outlines(ground(room(4.0, 4.0, 0.02, slanting)))) == 0.0


@pytest.mark.parametrize('angle', [0.0, 0.35, -0.7])
def test_a_turned_floor_equals_the_floor_cell_by_cell(angle):
    plan = crooked(0.1)
    floor = ground(plan)
    missed = plan.free & (np.random.default_rng(9).random(plan.occupancy.shape) < 0.5)
    turned = TurnedFloor(floor, missed, window_around(missed), angle, 0.2)
    rows, columns = turned.missed.shape
    assert turned.clearance.shape == (rows + 1, columns + 1) and turned.resolution == 0.1
    seen = np.zeros_like(missed)
    for row, column in np.ndindex(rows, columns):
        (x, y), = turned.points(np.array([[column + 0.5, row + 0.5]]))
        cell = plan.cell(x, y)
        inside = 0 <= cell[0] < plan.rows and 0 <= cell[1] < plan.columns
        assert turned.missed[row, column] == (inside and missed[cell])
        if inside:
            seen[cell] = True
    assert seen.mean() > 0.75  # a turned grid leaves out some cells, and holds others twice
    for row, column in np.ndindex(rows + 1, columns + 1):
        (x, y), = turned.points(np.array([[column, row]]))
        if turned.clearance[row, column] > 0.1:
            assert turned.clearance[row, column] == approx(floor.plan.safe_clearance_at(x, y), abs=1e-9)
    assert (turned.clearance > 0.1).sum() > 0.5 * (plan.safe_clearance > 0.1).sum()


@pytest.mark.parametrize('angle', [0.0, 0.35, -0.7])
def test_only_the_part_around_the_cells_to_clean_is_turned_and_it_is_the_same_on_a_larger_floor(angle):
    found = []
    for width in (4.0, 12.0):
        plan = room(width, 4.0, 0.05)
        missed = np.zeros(plan.occupancy.shape, bool)
        missed[30:40, 40:60] = True  # 0.5 m x 1 m
        turned = TurnedFloor(ground(plan), missed, window_around(missed), angle, 0.17)
        rows, columns = np.nonzero(turned.missed)
        margin = 4  # cells of 5 cm, at least 0.17 m
        beside = [rows.min(), columns.min(), *(turned.missed.shape - np.array([rows.max(), columns.max()]) - 1)]
        assert beside == 4 * [margin] if angle == 0.0 else margin <= min(beside) and max(beside) < 20
        assert turned.clearance.shape == tuple(size + 1 for size in turned.missed.shape)
        assert len(rows) == approx(200, abs=12)
        found.append((turned.missed, turned.clearance, turned.points(np.array([[0.0, 0.0]]))))
    (missed, clearance, corner), (same, as_clear, there) = found
    assert (missed == same).all() and corner == approx(there)
    assert (as_clear >= clearance - 1e-9).all()


def test_off_the_map_there_is_nothing_to_clean_and_no_clearance():
    plan = room(1.0, 1.0, 0.05)
    missed = np.ones(plan.occupancy.shape, bool)
    for angle in (0.0, 0.35):
        turned = TurnedFloor(ground(plan), missed, window_around(missed), angle, 0.5)
        assert not turned.missed[0].any() and not turned.missed[:, -1].any() and turned.missed.any()
        assert turned.clearance[0].max() == turned.clearance[:, -1].max() == 0.0
