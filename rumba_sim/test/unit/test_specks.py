"""Specks of unknown cells on the floor: counted, and floor if the file of the map says so."""

import itertools

import numpy as np
import pytest
from sheets import B, G, W, write

from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import UNKNOWN


def specked(cell):
    """A room of 5 x 4 m with specks of unknown cells: 12 of one cell, and one of 0.4 x 0.4 m; one more is at a wall."""
    pixels = np.full((round(4.0 / cell), round(5.0 / cell)), W, np.uint8)
    pixels = np.pad(pixels, 1, mode='constant', constant_values=B)
    for row, column in itertools.product((1.0, 2.0, 3.0), (1.0, 2.0, 3.0, 4.0)):
        pixels[round(row / cell), round(column / cell)] = G
    pixels[round(1.5 / cell):round(1.9 / cell), round(1.5 / cell):round(1.9 / cell)] = G
    pixels[1, 5] = G
    return pixels


@pytest.mark.parametrize('most, filled', [(None, 0), (0.0025, 12), (0.1, 12), (0.2, 13)])
def test_specks_of_unknown_cells_are_counted_and_free_if_the_file_says_so(tmp_path, most, filled):
    pixels = specked(0.05)
    path = write(tmp_path, pixels, resolution=0.05, fill_unknown=most)
    plan = map_file.load(path)
    assert plan.free.sum() == (pixels == W).sum() + min(filled, 12) + 64 * (filled == 13)
    assert plan.occupancy[pixels.shape[0] - 2, 5] == UNKNOWN
    if most is None:
        assert plan.remarks == (f'{path}: 12 specks of unknown cells, 0.03 m2 in all, count as walls: with '
                                'fill_unknown: 0.05 they are floor',)
    else:
        area = '0.03' if filled == 12 else '0.19'
        assert plan.remarks == (f'{path}: fill_unknown: {filled} specks of unknown cells, {area} m2 in all, are floor',)
