"""Crops maps to the floor on which a robot can stand, and some more around it.

Most cells of a map from SLAM are unknown, and beams that left through a window draw rays of free cells far beyond the
walls. Time and memory grow with the whole rectangle.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Sequence, Tuple

import numpy as np
from scipy import ndimage

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

Window = Tuple[slice, slice]  # rows and columns

LEAST = 1.0  # [m^2] on which the centre of a robot can be: smaller parts are kept only if they are near larger ones
MOST_BLOCKS = 4_000_000  # into which a map is divided to find its parts: each takes some bytes
STRIP = 200  # blocks along y that are looked at together
BEYOND = 1.0  # [m] from floor on which a robot stands: there it sees and meets things; our choice


def window(free: NDArray[np.bool_], resolution: float, radius: float, points: Sequence[Tuple[float, float]]) -> Window:
    """The rows and columns to keep of a map.

    Args:
        free: bool (rows, columns), the free cells.
        resolution: side of a cell [m].
        radius: of the robots [m].
        points: row and column, which may have fractions, of places to keep with what is around them.

    Returns:
        The smallest window that has all free cells in BEYOND of a large part on which a robot can stand, and of the
        points, with a border of one cell. If a robot can stand nowhere, that with all free cells.
    """
    whole = _around(free)
    boxes = _standing(free[whole], resolution, radius)
    if not boxes:
        return whole
    beyond = (BEYOND + radius) / resolution
    spans = []
    for axis, outer in enumerate(whole):
        first = outer.start + min(box[axis].start for box in boxes)
        last = outer.start + max(box[axis].stop for box in boxes)
        places = [point[axis] for point in points]
        spans.append(slice(max(math.floor(min([first, *places]) - beyond), outer.start),
                           min(math.ceil(max([last, *places]) + beyond), outer.stop)))
    inner = spans[0], spans[1]
    closer = _around(free[inner])
    return (_moved(closer[0], inner[0].start), _moved(closer[1], inner[1].start))


def _standing(free: NDArray[np.bool_], resolution: float, radius: float) -> Sequence[Window]:
    """The windows of the parts of at least LEAST in which the centre of a robot can be; else that of the largest."""
    side = math.ceil(math.sqrt(free.size / MOST_BLOCKS))
    room = _room_in_blocks(free, radius / resolution - math.sqrt(0.5), side)
    parts, number = ndimage.label(room, np.ones((3, 3)))
    if number == 0:
        return []
    areas = np.bincount(parts.ravel(), weights=room.ravel())[1:] * resolution ** 2
    return [_scaled(box, side) for box, area in zip(ndimage.find_objects(parts), areas)
            if area >= min(LEAST, areas.max())]


def _room_in_blocks(free: NDArray[np.bool_], radius: float, side: int) -> NDArray[np.int32]:
    """How many cells `_with_room` finds in each block of side x side cells: strip by strip, which takes less memory."""
    columns, reach = math.ceil(free.shape[1] / side), math.ceil(max(radius, 0.0))
    counts = np.zeros((math.ceil(free.shape[0] / side), columns), np.int32)
    for first in range(0, len(counts), STRIP):
        top, bottom = first * side, min((first + STRIP) * side, len(free))
        above = max(top - reach, 0)
        room = _with_room(free[above:bottom + reach], radius)[top - above:bottom - above]
        whole = np.zeros((math.ceil(len(room) / side) * side, columns * side), np.bool_)
        whole[:len(room), :free.shape[1]] = room
        counts[first:first + STRIP] = whole.reshape(-1, side, columns, side).sum(axis=(1, 3))
    return counts


def _with_room(free: NDArray[np.bool_], radius: float) -> NDArray[np.bool_]:
    """The cells around whose centre all cells with a centre within a radius [cells] are free.

    A disc is a stack of rows: it takes some passes over the cells for each row, however wide that is.
    """
    rows, columns = free.shape
    room = free.copy()
    for up in range(math.floor(radius) + 1 if radius > 0.0 else 0):
        half = math.floor(math.sqrt(radius ** 2 - up ** 2))
        if rows <= up or columns <= 2 * half:
            return np.zeros_like(free)
        run = np.zeros_like(free)
        run[:, half:columns - half] = _runs(free, 2 * half + 1)
        room[:rows - up] &= run[up:]
        room[up:] &= run[:rows - up]
        room[:up] = room[rows - up:] = False
    return room


def _runs(free: NDArray[np.bool_], length: int) -> NDArray[np.bool_]:
    """Where so many free cells lie side by side, from that column on: bool (rows, columns - length + 1)."""
    runs, done = free, 1
    while done < length:
        step = min(done, length - done)
        runs = runs[:, :-step] & runs[:, step:]
        done += step
    return runs


def _around(free: NDArray[np.bool_]) -> Window:
    """The rows and columns that contain a free cell, and one more on each side."""
    return _span(free.any(axis=1)), _span(free.any(axis=0))


def _span(used: NDArray[np.bool_]) -> slice:
    indices = np.flatnonzero(used)
    if indices.size == 0:
        return slice(0, 1)
    return slice(max(int(indices[0]) - 1, 0), min(int(indices[-1]) + 2, used.size))


def _moved(span: slice, by: int) -> slice:
    return slice(span.start + by, span.stop + by)


def _scaled(box: Window, by: int) -> Window:
    rows, columns = (slice(span.start * by, span.stop * by) for span in box)
    return rows, columns
