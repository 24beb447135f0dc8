"""A small map to write to files in all formats."""

import numpy as np
from PIL import Image

from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN

B, G, W = 0, 205, 254
PIXELS = np.array([  # an F with a rim, which differs from all its mirror images and rotations; row 0 at the top
    [G, B, B, B, B, G],
    [G, B, W, W, W, B],
    [G, B, W, B, B, G],
    [G, B, W, W, B, G],
    [B, B, W, B, B, G],
    [B, B, W, B, G, G],
    [G, B, B, B, G, G]], np.uint8)
CUT = PIXELS[:, 1:]  # cropped to the free cells and their rim
KEYS = {'image': 'flat.png', 'resolution': 0.5, 'origin': [-1.0, 2.0, 0.0], 'negate': 0, 'occupied_thresh': 0.65,
        'free_thresh': 0.196}


def grid(pixels):
    """Occupancy of pixels of the three usual values, row 0 at the bottom."""
    return np.select([pixels[::-1] == B, pixels[::-1] == W], [OCCUPIED, FREE], UNKNOWN)


def write(folder, pixels=PIXELS, **changes):
    """Write a map into a folder; returns its path. A key that is changed to None is left out."""
    if isinstance(pixels, np.ndarray):
        pixels = Image.fromarray(pixels)
    pixels.save(str(folder / 'flat.png'))
    keys = {key: value for key, value in {**KEYS, **changes}.items() if value is not None}
    (folder / 'flat.yaml').write_text(''.join(f'{key}: {value}\n' for key, value in keys.items()))
    return str(folder / 'flat.yaml')
