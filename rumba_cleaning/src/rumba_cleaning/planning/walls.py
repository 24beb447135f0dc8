"""Paths along the walls: contours of the clearance, on which the robot only just does not touch a wall."""

from typing import Iterator, List, NamedTuple

import numpy as np
from scipy import ndimage
from skimage import measure

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
WALL_MARGIN = 0.01  # [m] between robot and wall: small sweeps more of the rim, large touches the wall less often
SPACING = 0.02  # [m] between the waypoints: one cell of a fine map, so that a path keeps the shape of its contour
SHORTEST = 0.3  # [m] of a contour, and of its part in one region; a shorter one is left to the crumbs
NEEDED = 0.2  # share of the brush's width that was missed, for a waypoint to be needed: small drives over swept floor
GAP = 0.5  # [m] of a path that are not needed, but are driven: large saves turns, small saves distance
WHOLE = 0.85  # share of a path's waypoints that are needed, for all of it to be driven: saves turns, as GAP does
SAMPLES = 9  # points across the brush: one for each 2 cm of a brush of 17 cm
FEWEST = 4  # waypoints of a part of a path; a shorter one is left to the crumbs


class Wall(NamedTuple):
    """A path along a wall."""

    waypoints: Array  # float64 (any, 2) [m]
    region: int  # label of the region in which it lies
    is_closed: bool  # whether it ends where it begins


def walls(ground: Ground, missed: Array, labels: Array, brush: float) -> List[Wall]:
    """Paths along walls beside which something was missed, the longest first.

    Args:
        ground: where the robot can stand.
        missed: the cells to clean, bool (rows, columns); those that the paths clean are set to False.
        labels: the region of each node, int (rows + 1, columns + 1).
        brush: width of the brush [m].
    """
    contours = measure.find_contours(ground.clearance, ground.reach + WALL_MARGIN)
    pieces = [piece for contour in contours for piece in _by_region(ground.points(contour), ground, labels)]
    found = []
    for piece in sorted(pieces, key=lambda wall: -len(wall.waypoints)):
        for wall in _needed(piece, ground, missed, brush):
            found.append(wall)
            missed &= ~band(ground, wall.waypoints, brush)
    return found


def band(ground: Ground, path: Array, width: float) -> Array:
    """Cells whose centre lies within half a width [m] of a path (any, 2): bool (rows, columns)."""
    resolution = ground.plan.resolution
    corner = ground.nodes(np.array([path.min(axis=0), path.max(axis=0)]))
    size = int(np.ceil(width / resolution)) + 1
    top, left = np.maximum(corner[0] - size, 0)
    bottom, right = np.minimum(corner[1] + size, np.array(ground.clearance.shape) - 1)
    fine = np.ones((2 * (bottom - top) + 1, 2 * (right - left) + 1), np.bool_)  # nodes, centres and what lies between
    dense = resampled(path, 0.5 * resolution)
    marks = np.rint((dense - ground.plan.origin) / (0.5 * resolution)).astype(np.intp)[:, ::-1] - (2 * top, 2 * left)
    marks = np.clip(marks, 0, np.array(fine.shape) - 1)
    fine[marks[:, 0], marks[:, 1]] = False
    near = ndimage.distance_transform_edt(fine)[1::2, 1::2] * 0.5 * resolution <= 0.5 * width
    cells = np.zeros(ground.plan.occupancy.shape, np.bool_)
    cells[top:bottom, left:right] = near
    return cells


def resampled(path: Array, spacing: float) -> Array:
    """A path (any, 2) [m] with waypoints that are about a spacing [m] apart, all the way along."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    along = np.linspace(0.0, lengths[-1], max(int(lengths[-1] / spacing), 1) + 1)
    return np.stack([np.interp(along, lengths, path[:, axis]) for axis in (0, 1)], axis=1)


def _by_region(contour: Array, ground: Ground, labels: Array) -> Iterator[Wall]:
    """The parts of a contour (any, 2) [m], region by region."""
    is_closed = bool(np.allclose(contour[0], contour[-1]))
    path = resampled(contour, SPACING)
    if len(path) * SPACING < SHORTEST:
        return
    nodes = ground.standing(ground.nodes(path))
    of_path = labels[nodes[:, 0], nodes[:, 1]]
    cuts = np.flatnonzero(np.diff(of_path)) + 1
    if len(cuts) == 0:
        yield Wall(path, int(of_path[0]), is_closed)
        return
    if is_closed:
        path, of_path = _rotated(path, cuts[0]), _rotated(of_path, cuts[0])
        cuts = np.flatnonzero(np.diff(of_path)) + 1
    for part in np.split(np.arange(len(of_path)), cuts):
        if len(part) * SPACING >= SHORTEST:
            yield Wall(path[part], int(of_path[part[0]]), False)


def _rotated(ring: Array, index: int) -> Array:
    """A ring, whose last element equals its first, that begins at another element."""
    return np.concatenate([ring[index:-1], ring[:index + 1]])


def _needed(wall: Wall, ground: Ground, missed: Array, brush: float) -> Iterator[Wall]:
    """The parts of a path on which the brush sweeps what was missed."""
    needed = _finds(wall.waypoints, ground, missed, brush)
    if needed.mean() > WHOLE:
        yield wall
        return
    size = int(GAP / SPACING)
    needed = ndimage.binary_closing(np.pad(needed, size), np.ones(size))[size:-size] | needed
    path = wall.waypoints
    if wall.is_closed and needed[0] and needed[-1]:
        index = int(np.argmin(needed))
        path, needed = _rotated(path, index), _rotated(needed, index)
    parts, _ = ndimage.label(needed)
    for part in ndimage.find_objects(parts):
        if part[0].stop - part[0].start >= FEWEST:
            yield Wall(path[part[0]], wall.region, False)


def _finds(path: Array, ground: Ground, missed: Array, brush: float) -> Array:
    """At which waypoints of a path (any, 2) enough of the floor below the brush was missed: bool (any)."""
    along = np.gradient(path, axis=0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(np.hypot(*along.T)[:, np.newaxis], 1e-9)
    offsets = np.linspace(-0.5 * brush, 0.5 * brush, SAMPLES)
    points = path[:, np.newaxis] + offsets[np.newaxis, :, np.newaxis] * across[:, np.newaxis]
    cells = np.floor((points - ground.plan.origin) / ground.plan.resolution).astype(np.intp)
    rows, columns = np.clip(cells[..., 1], 0, missed.shape[0] - 1), np.clip(cells[..., 0], 0, missed.shape[1] - 1)
    return np.asarray(missed[rows, columns].mean(axis=1) >= NEEDED)
