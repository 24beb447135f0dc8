"""Closed forms for symmetric matrices agree with numpy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rumba_localisation.compiled_matrices import inverse, product


@given(st.integers(0, 2 ** 32 - 1), st.sampled_from([1e-6, 1.0, 1e6]))
def test_the_inverse_times_the_matrix_is_one(seed, size):
    spread = np.random.default_rng(seed).uniform(-1.0, 1.0, (3, 3))
    matrix = size * (spread @ spread.T + 0.01 * np.eye(3))
    found = inverse(matrix)
    assert (found == found.T).all()
    assert found == pytest.approx(np.linalg.inv(matrix), rel=1e-6, abs=1e-9 / size)


def test_a_product_is_that_of_rows_with_the_vector():
    matrix = np.array([[1.0, 2.0, 3.0], [2.0, 5.0, 7.0], [3.0, 7.0, 11.0]])
    assert product(matrix, np.array([1.0, -1.0, 2.0])) == pytest.approx([5.0, 11.0, 18.0])
