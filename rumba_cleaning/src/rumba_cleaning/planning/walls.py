"""Ways along the walls: the contours on which the robot just does not touch them."""

from typing import Iterator, List, NamedTuple

import numpy as np
from scipy import ndimage
from skimage import measure

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

MARGIN = 0.01  # [m] that the way along a wall keeps from it
STEP = 0.02  # [m] between the places of a way
SHORTEST = 0.3  # [m] of a contour, and of a part of it in one room
NEW = 0.2  # share of the brush that finds something to sweep, where a way is needed
GAP = 0.5  # [m] of a way that is not needed, and driven nevertheless
WHOLE = 0.85  # share of a way that is needed, where all of it is driven
SAMPLES = 9  # across the brush


class Wall(NamedTuple):
    """A way along a wall."""

    places: Array  # float64 (any, 2) [m]
    room: int  # label of the room it lies in
    is_closed: bool  # it ends where it begins


def walls(ground: Ground, missed: Array, rooms: Array, brush: float) -> List[Wall]:
    """Ways along walls where something was missed, the longest first; what they clean is missed no more.

    Args:
        ground: where the robot can stand.
        missed: what there is to clean, bool (rows, columns); changed.
        rooms: label of the room of each node, int (rows + 1, columns + 1).
        brush: width of the brush [m].
    """
    contours = measure.find_contours(ground.room, ground.reach + MARGIN)
    pieces = [piece for contour in contours for piece in _by_room(ground.places(contour), ground, rooms)]
    found = []
    for piece in sorted(pieces, key=lambda wall: -len(wall.places)):
        for wall in _needed(piece, ground, missed, brush):
            found.append(wall)
            missed &= ~band(ground, wall.places, brush)
    return found


def band(ground: Ground, places: Array, width: float) -> Array:
    """Cells whose middle lies within half a width of a way: bool (rows, columns)."""
    resolution = ground.plan.resolution
    corner = ground.nodes(np.array([places.min(axis=0), places.max(axis=0)]))
    size = int(np.ceil(width / resolution)) + 1
    top, left = np.maximum(corner[0] - size, 0)
    bottom, right = np.minimum(corner[1] + size, np.array(ground.room.shape) - 1)
    fine = np.ones((2 * (bottom - top) + 1, 2 * (right - left) + 1), np.bool_)
    dense = resampled(places, 0.5 * resolution)
    marks = np.rint((dense - ground.plan.origin) / (0.5 * resolution)).astype(np.intp)[:, ::-1] - (2 * top, 2 * left)
    marks = np.clip(marks, 0, np.array(fine.shape) - 1)
    fine[marks[:, 0], marks[:, 1]] = False
    near = ndimage.distance_transform_edt(fine)[1::2, 1::2] * 0.5 * resolution <= 0.5 * width
    cells = np.zeros(ground.plan.occupancy.shape, np.bool_)
    cells[top:bottom, left:right] = near
    return cells


def resampled(places: Array, step: float) -> Array:
    """Places along a way, about a step apart."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    along = np.linspace(0.0, lengths[-1], max(int(lengths[-1] / step), 1) + 1)
    return np.stack([np.interp(along, lengths, places[:, axis]) for axis in (0, 1)], axis=1)


def _by_room(places: Array, ground: Ground, rooms: Array) -> Iterator[Wall]:
    """The parts of a contour, room by room."""
    is_closed = bool(np.allclose(places[0], places[-1]))
    places = resampled(places, STEP)
    if len(places) * STEP < SHORTEST:
        return
    nodes = ground.standing(ground.nodes(places))
    labels = rooms[nodes[:, 0], nodes[:, 1]]
    cuts = np.flatnonzero(np.diff(labels)) + 1
    if len(cuts) == 0:
        yield Wall(places, int(labels[0]), is_closed)
        return
    if is_closed:
        places, labels = _turned(places, cuts[0]), _turned(labels, cuts[0])
        cuts = np.flatnonzero(np.diff(labels)) + 1
    for part in np.split(np.arange(len(labels)), cuts):
        if len(part) * STEP >= SHORTEST:
            yield Wall(places[part], int(labels[part[0]]), False)


def _turned(ring: Array, index: int) -> Array:
    """A ring, its last element the first again, that begins elsewhere."""
    return np.concatenate([ring[index:-1], ring[:index + 1]])


def _needed(wall: Wall, ground: Ground, missed: Array, brush: float) -> Iterator[Wall]:
    """The parts of a way on which the brush finds something that was missed."""
    needed = _finds(wall.places, ground, missed, brush)
    if needed.mean() > WHOLE:
        yield wall
        return
    size = int(GAP / STEP)
    needed = ndimage.binary_closing(np.pad(needed, size), np.ones(size))[size:-size] | needed
    places = wall.places
    if wall.is_closed and needed[0] and needed[-1]:
        index = int(np.argmin(needed))
        places, needed = _turned(places, index), _turned(needed, index)
    labels, count = ndimage.label(needed)
    for part in ndimage.find_objects(labels):
        if part[0].stop - part[0].start > 3:
            yield Wall(places[part[0]], wall.room, False)


def _finds(places: Array, ground: Ground, missed: Array, brush: float) -> Array:
    """At which places of a way the brush, across it, finds enough that was missed: bool (any)."""
    along = np.gradient(places, axis=0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(np.hypot(*along.T)[:, np.newaxis], 1e-9)
    offsets = np.linspace(-0.5 * brush, 0.5 * brush, SAMPLES)
    spots = places[:, np.newaxis] + offsets[np.newaxis, :, np.newaxis] * across[:, np.newaxis]
    cells = np.floor((spots - ground.plan.origin) / ground.plan.resolution).astype(np.intp)
    rows, columns = np.clip(cells[..., 1], 0, missed.shape[0] - 1), np.clip(cells[..., 0], 0, missed.shape[1] - 1)
    return np.asarray(missed[rows, columns].mean(axis=1) >= NEW)
