"""Whatever scans say, a map keeps within its bounds."""

import math

import numpy as np
import pytest

from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.mapping.mapper import LARGEST, MOST, Mapper
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.noise import Noise
from rumba_localisation.scan import scan_of
from rumba_sim.model.common.geometry import Pose

STEP = math.radians(1.0)


def circle(radius):
    """A scan of walls all around."""
    return scan_of(np.full(360, radius, np.float32), -math.pi, STEP, math.inf)


@pytest.mark.parametrize('radius', [60.0, 99.0])
def test_a_large_hall_gets_larger_cells(radius):
    mapper = Mapper()
    mapper.observe(Pose(0.0, 0.0, 0.0), circle(radius))
    assert not mapper.is_full and mapper.grid.resolution > 0.02
    assert mapper.grid.odds.size <= 1.1 * MOST
    assert mapper.grid.distance_at(radius, 0.0) < 2.0 * mapper.grid.resolution


def test_a_map_that_grows_gets_larger_cells_and_keeps_what_it_shows():
    mapper = Mapper()
    for place in range(10):
        mapper.observe(Pose(30.0 * place, 0.0, 0.0), circle(25.0))
    assert not mapper.is_full and 0.02 < mapper.grid.resolution <= LARGEST
    assert mapper.grid.odds.size <= 1.1 * MOST


def test_a_robot_that_believes_to_be_very_far_away_does_not_take_the_memory():
    mapper = Mapper()
    mapper.observe(Pose(0.0, 0.0, 0.0), circle(2.0))
    before = mapper.grid.odds.copy()
    mapper.observe(Pose(900_000.0, 0.0, 0.0), circle(2.0))
    assert mapper.is_full and np.array_equal(mapper.grid.odds, before)


def test_cells_are_as_large_as_people_say():
    mapper = Mapper(config=MapperConfig(delta=0.1, sigma=0.05))
    mapper.observe(Pose(0.0, 0.0, 0.0), circle(3.0))
    assert mapper.grid.resolution == 0.1 and mapper.noise.sigma == 0.05


def test_the_cells_with_a_scan_are_counted_before_it_is_added():
    grid, seen, noise = Grid(), circle(5.0), Noise()
    expected = grid.size_with(Pose(0.0, 0.0, 0.0), seen)
    grid.add(Pose(0.0, 0.0, 0.0), seen, noise)
    assert 0.5 * expected < grid.odds.size < 1.5 * expected
