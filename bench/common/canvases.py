"""Writes maps as SLAM leaves them: on a canvas of unknown cells, with rays of beams that left through windows."""

import numpy as np
from PIL import Image

from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED

BRIGHTNESS = {FREE: 254, OCCUPIED: 0}
UNKNOWN, RAYS = 205, 9


def write(folder, cells, size, resolution, rays=RAYS, keys=''):
    """Write a map with some cells on a canvas; returns its path.

    Args:
        folder: a pathlib.Path.
        cells: int8 (rows, columns), row 0 at the bottom; what is neither free nor occupied is unknown.
        size: of a side of the canvas [pixels]; it is larger if the cells need more.
        resolution: of the cells [m].
        rays: how many leave the walls, a third each to the right, up and aslant.
        keys: further lines of the YAML file.
    """
    rows, columns = cells.shape
    size = max(size, rows + 2, columns + 2)
    canvas = np.full((size, size), UNKNOWN, np.uint8)
    bottom, left = (size - rows) // 2, (size - columns) // 3
    window = canvas[bottom:bottom + rows, left:left + columns]
    for kind, level in BRIGHTNESS.items():
        window[cells == kind] = level
    for ray in range(rays // 3):
        canvas[bottom + 20 + 15 * ray, left + columns - 1:size - 5] = BRIGHTNESS[FREE]
        canvas[bottom + rows - 1:size - 5, left + 30 + 20 * ray] = BRIGHTNESS[FREE]
        steps = np.arange(size)
        across, up = left - steps // 2, bottom + 30 + (steps * (3 + ray)) // 10
        inside = (across >= 0) & (up < size)
        canvas[up[inside], across[inside]] = BRIGHTNESS[FREE]
    Image.fromarray(canvas[::-1]).save(str(folder / 'map.png'))
    origin = -left * resolution, -bottom * resolution
    (folder / 'map.yaml').write_text(f'image: map.png\nresolution: {resolution}\norigin: [{origin[0]}, {origin[1]}, '
                                     f'0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n{keys}')
    return folder / 'map.yaml'
