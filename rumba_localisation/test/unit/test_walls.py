"""The distances and likelihoods of the walls of a map, against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rooms import crooked, distances, room

from rumba_localisation.compiled_matching import slope_at
from rumba_localisation.walls import FARTHEST, Walls


def at(walls, x, y):
    """Distance and its slopes at a point [m]."""
    distance, by_u, by_v = slope_at(walls.distance, (x - walls.origin[0]) / walls.resolution,
                                    (y - walls.origin[1]) / walls.resolution)
    return distance, by_u / walls.resolution, by_v / walls.resolution


@pytest.mark.parametrize('x, y, distance, slope', [
    (0.3, 1.0, 0.3, (1, 0)), (2.75, 1.0, 0.25, (-1, 0)), (1.0, 0.1, 0.1, (0, 1)), (1.0, 1.9, 0.1, (0, -1)),
    (-0.02, 1.0, -0.02, (1, 0)), (1.0, 2.01, -0.01, (0, -1)), (-0.08, 1.0, -0.08, (1, 0))])
def test_distances_are_exact_on_both_sides_of_a_wall(x, y, distance, slope):
    found = at(Walls(room(3.0, 2.0, 0.1)), x, y)
    assert found == (pytest.approx(distance, abs=1e-6), *(pytest.approx(part, abs=1e-4) for part in slope))


@given(st.floats(0.0, 4.0), st.floats(0.0, 3.0))
def test_distances_in_the_free_are_those_to_the_nearest_cell(x, y):
    plan = crooked(0.05)
    if plan.free[plan.cell(x, y)]:
        assert at(Walls(plan), x, y)[0] == pytest.approx(distances(plan, [(x, y)])[0], abs=0.025)


def test_outside_the_map_there_is_no_distance():
    assert math.isnan(at(Walls(room(3.0, 2.0)), 3.2, 1.0)[0])


def test_far_from_all_walls_distances_count_alike():
    assert Walls(room(10.0, 10.0, 0.1)).distance.max() == FARTHEST


def test_the_likelihood_is_that_of_the_book():
    walls = Walls(room(3.0, 2.0, 0.025))
    field = walls.log_likelihood(sigma=0.1, hit=0.9, rand=0.1, range_max=8.0)
    column, row = 1 + round(0.1875 / 0.025 + 0.5), 1 + round(1.0 / 0.025)  # 0.1875 m from the left wall
    anywhere = 0.1 / 8.0
    peak = 0.9 / (0.1 * math.sqrt(2.0 * math.pi))
    expected = math.log((peak * math.exp(-0.5 * (0.1875 / 0.1) ** 2) + anywhere) / (peak + anywhere))
    assert field[row, column] == pytest.approx(expected, rel=1e-3)
    assert np.all(field <= 0.0) and field[0, 0] == pytest.approx(math.log(anywhere / (peak + anywhere)))
