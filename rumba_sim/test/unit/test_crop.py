"""Maps are cropped to floor on which robots can stand, whatever rays and specks lie on their canvas."""

import numpy as np
import pytest
from pytest import approx
from scipy import ndimage
from sheets import B, G, W, write

from rumba_sim.model.maps import crop, map_file
from rumba_sim.model.maps.floor_plan import FREE


def with_rays(size, *boxes):
    """A canvas of unknown cells of 5 cm with free boxes (left, bottom, right, top) [m] with walls, and three rays."""
    pixels = np.full((size, size), G, np.uint8)
    for left, bottom, right, top in boxes:
        rows = slice(size - round(top / 0.05), size - round(bottom / 0.05))
        columns = slice(round(left / 0.05), round(right / 0.05))
        pixels[rows.start - 1:rows.stop + 1, columns.start - 1:columns.stop + 1] = B
        pixels[rows, columns] = W
    row, column = size - round(12.0 / 0.05), round(12.0 / 0.05)
    pixels[row, column:size - 3] = pixels[3:row, column] = W
    for step in range(size - row - 3):
        pixels[row + step, column + step // 2] = W
    return pixels


def test_a_map_is_cropped_to_where_robots_can_stand_and_to_what_is_near(tmp_path):
    path = write(tmp_path, with_rays(1200, (10.0, 10.0, 20.0, 17.5)), resolution=0.05, origin='[0, 0, 0]')
    plan = map_file.load(path)
    left, bottom, right, top = plan.bounds
    assert left == approx(9.95) and 8.7 < bottom < 9.0 and 21.0 < right < 21.3 and 18.5 < top < 18.8
    assert plan.occupancy[plan.cell(10.1, 10.1)] == FREE and plan.occupancy[plan.cell(20.5, 11.98)] == FREE
    whole = map_file.load(path, radius=0.02).bounds  # so small a robot drives along the rays
    assert whole.top > 59.0 and whole.right > 59.0


def test_a_room_elsewhere_and_a_dock_are_kept(tmp_path):
    boxes = (10.0, 10.0, 20.0, 17.5), (40.0, 30.0, 42.0, 32.0), (55.0, 55.0, 55.6, 55.6)
    pixels = with_rays(1200, *boxes)
    plan = map_file.load(write(tmp_path, pixels, resolution=0.05, origin='[0, 0, 0]'))
    assert 43.0 < plan.bounds.right < 43.3 and 33.0 < plan.bounds.top < 33.3
    plan = map_file.load(write(tmp_path, pixels, resolution=0.05, origin='[0, 0, 0]', docks='[[55.3, 55.3, 0]]'))
    assert plan.bounds.right > 56.3 and plan.bounds.top > 56.3
    turned = map_file.load(write(tmp_path, pixels, resolution=0.05, origin='[0, 0, 1.5707963]',
                                 dock='[-55.3, 55.3, 0]'))
    assert turned.bounds.left < -56.3 and turned.bounds.top > 56.3 and turned.occupancy[turned.cell(-41, 41)] != FREE


@pytest.mark.parametrize('radius', [0.3, 1.0, 2.77, 4.5])
@pytest.mark.parametrize('side', [1, 3])
def test_there_is_room_where_a_disc_of_cells_is_free(radius, side):
    free = np.random.default_rng(1).random((crop.STRIP * side + 7, 70)) < 0.97
    reach = int(radius)
    rows, columns = np.ogrid[-reach:reach + 1, -reach:reach + 1]
    room = ndimage.binary_erosion(free, rows ** 2 + columns ** 2 <= radius ** 2)
    room = np.pad(room, ((0, -len(room) % side), (0, -70 % side)), mode='constant')
    counts = crop._room_in_blocks(free, radius, side)
    assert (counts == room.reshape(counts.shape[0], side, counts.shape[1], side).sum(axis=(1, 3))).all()
