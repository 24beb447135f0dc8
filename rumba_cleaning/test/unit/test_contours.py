"""Contours against those of scikit-image."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms import crooked
from scipy import ndimage
from skimage import measure

from rumba_cleaning.planning.common.contours import contours


def assert_same(values, level):
    """The same lines, point by point, in the same order."""
    found, expected = contours(values, level), measure.find_contours(values, level)
    assert len(found) == len(expected)
    for one, other in zip(found, expected):
        assert one.shape == other.shape and (one == other).all()


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2 ** 32 - 1), st.integers(2, 30), st.integers(2, 30), st.floats(0.0, 3.0))
def test_contours_of_noise_are_those_of_scikit_image(seed, rows, columns, smooth):
    noise = np.random.default_rng(seed).standard_normal((rows, columns))
    assert_same(ndimage.gaussian_filter(noise, smooth), 0.05)


@pytest.mark.parametrize('level', [0.1, 0.1801, 0.3, 0.5])
def test_contours_of_a_clearance_are_those_of_scikit_image(level):
    assert_same(crooked(0.02).clearance, level + 1e-4)


def test_levels_that_some_nodes_have_exactly_are_met_all_the_same():
    values = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 2.0, 0.0], [0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0]])
    line, = contours(values, 1.0)
    assert sorted(map(tuple, line[1:].tolist())) == [(0.5, 2.0), (1.0, 1.0), (1.0, 2.5), (2.0, 2.0)]
    assert (line[0] == line[-1]).all()


def test_where_nothing_crosses_a_level_there_are_no_contours():
    for values in (np.zeros((5, 5)), np.ones((5, 5)), np.ones((1, 5)), np.eye(1)):
        assert contours(values, 0.5) == []
