"""One map laid over another: each cell is where the frames say, turned and moved."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN
from rumba_sim.model.maps.laid_over import laid_over


class Grid(NamedTuple):
    """A map."""

    cells: np.ndarray
    resolution: float = 0.5
    left: float = 0.0
    bottom: float = 0.0


UPPER = np.array([[FREE, FREE, OCCUPIED], [UNKNOWN, FREE, FREE]], np.int8)  # differs from all that it is turned into


def below(rows, columns, **known):
    """A map of so many cells."""
    return Grid(np.zeros((rows, columns), np.int8), **known)


def test_a_map_in_the_same_frame_is_shown_as_it_is_and_is_unknown_beside_it():
    shown = laid_over(Grid(UPPER, left=0.5), Pose(0.0, 0.0, 0.0), below(3, 5))
    wanted = np.full((3, 5), UNKNOWN)
    wanted[:2, 1:4] = UPPER
    assert shown.tolist() == wanted.tolist() and shown.dtype == np.int8


@pytest.mark.parametrize('turns', range(4))
def test_a_turned_and_moved_frame_turns_counter_clockwise_about_its_origin(turns):
    frame = Pose(5.0, 7.0, turns * 0.5 * math.pi)
    shown = laid_over(Grid(UPPER, left=-0.5, bottom=-0.5), frame, below(6, 6, left=3.5, bottom=5.5))
    wanted = np.full((6, 6), UNKNOWN)
    wanted[2:4, 2:5] = UPPER  # the origin of the frame is the corner in the middle of the cells
    assert shown.tolist() == np.rot90(wanted, -turns).tolist()  # rows count upward here


@pytest.mark.parametrize('theta', [0.0, 0.4, -2.0])
@pytest.mark.parametrize('side', [0.02, 0.05, 0.11])
def test_a_thin_wall_has_no_gap_whatever_the_size_of_the_cells_below(theta, side):
    cells = np.full((41, 41), FREE, np.int8)
    cells[20] = OCCUPIED  # along the x axis of its frame
    frame = Pose(1.0, 2.0, theta)
    lower = below(*[math.ceil(2.0 / side)] * 2, resolution=side, left=0.0, bottom=1.0)
    shown = laid_over(Grid(cells, 0.02, -0.41, -0.41), frame, lower)
    along = np.linspace(-0.36, 0.36, 200)
    x, y = 1.0 + along * math.cos(theta), 2.0 + along * math.sin(theta)
    near = [shown[math.floor((b - 1.0) / side) + up, math.floor(a / side) + right]
            for a, b in zip(x, y) for up in (-1, 0, 1) for right in (-1, 0, 1)]
    assert (np.reshape(near, (-1, 9)) == OCCUPIED).any(axis=1).all()
    assert np.count_nonzero(shown == OCCUPIED) < 3 * 0.82 / side + 4


def test_a_map_outside_the_other_shows_nothing():
    assert (laid_over(Grid(UPPER), Pose(100.0, 0.0, 1.0), below(3, 4)) == UNKNOWN).all()
