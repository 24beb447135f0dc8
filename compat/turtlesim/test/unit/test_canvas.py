"""Colours of parameters: as turtlesim takes them."""

import math

import pytest

from turtlesim.model.canvas import colour_part


@pytest.mark.parametrize('value, part', [
    (0, 0), (255, 255), (300, 44), (-5, 251), (1.5, 2), (1.4, 1), (-1.5, 254), (-1.2, 254), (254.6, 255), (1e30, 0),
    (10 ** 400, 0), ('red', 86), (True, 86), (None, 86), ([1], 86), (math.nan, 86), (math.inf, 86)])
def test_numbers_are_rounded_and_wrapped_and_anything_else_is_the_default(value, part):
    assert colour_part(value, 86) == part
