"""The floor plan of an office: rooms with one door each on both sides of a corridor, and furniture."""

import numpy as np

from rumba_sim.model.floor_plan import FREE, OCCUPIED, FloorPlan

CORRIDOR, DOOR = 2.0, 0.9  # [m]
ROOMS = (3.0, 6.0)  # [m] smallest and largest width
FURNITURE = (0.3, 1.6)  # [m] smallest and largest side


def office(rows, columns, resolution, furniture, seed):
    """A floor plan of `rows` and `columns` cells of a resolution [m], with a number of pieces of furniture."""
    generator = np.random.default_rng(seed)
    grid = np.full((rows, columns), OCCUPIED, np.int8)
    grid[2:-2, 2:-2] = FREE
    low, high = (round((rows * resolution + side * CORRIDOR) / 2.0 / resolution) for side in (-1.0, 1.0))
    for wall, part in ((low, slice(0, low)), (high, slice(high, rows))):
        grid[wall:wall + 2] = OCCUPIED
        left = 0
        while left < columns:
            right = min(left + round(generator.uniform(*ROOMS) / resolution), columns)
            grid[part, right:right + 2] = OCCUPIED
            middle, half = (left + right) // 2, round(DOOR / 2.0 / resolution)
            grid[wall:wall + 2, middle - half:middle + half] = FREE
            left = right
    for _ in range(furniture):
        height, width = (generator.uniform(*FURNITURE, 2) / resolution).astype(int)
        row, column = generator.integers(rows), generator.integers(columns)
        if not low - height - round(DOOR / resolution) < row < high + round(DOOR / resolution):
            grid[row:row + height, column:column + width] = OCCUPIED
    return FloorPlan('office', grid, resolution, (0.0, 0.0))
