"""Angles in the interval (-pi, pi]."""

import math

import pytest
from pytest import approx

from rumba_sim.model.common.geometry import wrap_angle


@pytest.mark.parametrize('angle, wrapped', [
    (0.0, 0.0), (math.pi, math.pi), (-math.pi, math.pi), (3.0 * math.pi, math.pi), (1.0, 1.0), (-1.0, -1.0),
    (math.pi + 0.5, 0.5 - math.pi), (-math.pi - 0.5, math.pi - 0.5), (100.0 * math.pi + 0.25, 0.25)])
def test_an_angle_wraps_into_its_interval(angle, wrapped):
    assert wrap_angle(angle) == approx(wrapped)
