"""What plans are made of depends neither on versions of the libraries nor on what they do with ties and rounding."""

import math

import numpy as np
import pytest

from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning.common.rows import distinct
from rumba_cleaning.planning.decompose.turned_floor import _on_axes


def test_distinct_rows_are_those_of_numpy_and_none_has_none():
    rows = np.array([[2, 1], [0, 5], [2, 1], [0, 4]])
    found, first = distinct(rows)
    assert found.tolist() == [[0, 4], [0, 5], [2, 1]]
    assert first.tolist() == [3, 1, 0]
    found, first = distinct(np.zeros((0, 2)))
    assert found.shape == (0, 2)
    assert first.tolist() == []


def test_bearings_are_those_of_the_c_library():
    legs = np.random.default_rng(2).normal(size=(1000, 2))
    assert bearings(legs).tolist() == [math.atan2(y, x) for x, y in legs.tolist()]
    assert bearings(np.zeros((0, 2))).shape == (0,)


@pytest.mark.parametrize('shape', [(5, 2), (4, 2, 2)])
def test_points_are_turned_as_by_a_product_of_matrices(shape):
    points, axes = np.random.default_rng(3).normal(size=shape), np.array([[0.8, 0.6], [-0.6, 0.8]])
    assert _on_axes(points, axes) == pytest.approx(points @ axes)
