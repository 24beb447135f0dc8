"""Straits: passages through which a robot fits although the clearance, interpolated between the nodes, shows none.

Between two corners that are aslant, the middle of a passage lies anywhere between the nodes, and the interpolated
clearance is too small there by up to a cell. So it may show two parts of the floor, between which a closer look finds a
way.
"""

import math
from typing import List, NamedTuple, Tuple

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_matrix, csgraph

from rumba_sim.model.kernel import Array

ALL_AROUND = np.ones((3, 3), np.bool_)
SHORT = 16  # steps of the lattice from one part to the other, at most twice: longer straits are not looked for
LONGEST = 64  # points of the lattice from end to end of what may hold straits: a closer look at more takes seconds
FINER = 16  # times smaller than a cell is the step of the closer look
HIDDEN = 1.07  # [cells] by which the interpolated clearance at a point of the lattice can be less than that on a way
#                nearby: half a diagonal of the lattice, and half one of a cell
CLOSER = 0.01  # [cells] more than distances that are the same differ by rounding

Window = Tuple[slice, slice]


class Floor(NamedTuple):
    """A floor, with a cell as the unit of length."""

    cells: Array  # bool (rows, columns): floor on which a robot can be
    clearance: Array  # float64 (rows + 1, columns + 1), distance from each node to the nearest obstacle
    wide: float  # distance to obstacles that a robot needs


def exact(floor: Floor) -> Array:
    """Distance to obstacles at a lattice of half cells, float64 (2 * rows + 1, 2 * columns + 1), in cells.

    The interpolated clearance shows half a cell too little in the middle of a passage of an odd number of cells. The
    distance is 0 near obstacles that the cells do not show.
    """
    away = _exact(floor.cells, 2, beyond=False)
    hidden = np.zeros(away.shape, np.bool_)
    hidden[::2, ::2] = floor.clearance < away[::2, ::2] - CLOSER
    away[ndimage.binary_dilation(hidden, ALL_AROUND)] = 0.0
    return away


def joined(labels: Array, number: int, floor: Floor) -> Array:
    """The labels of parts, the same for parts between which there is a strait.

    Args:
        labels: int (2 * rows + 1, 2 * columns + 1), the part of each point of a lattice of half cells, 0 for none.
        number: of parts.
        floor: on which they lie.

    Returns:
        The labels, or others in their place; each is that of one of the parts that are joined.
    """
    pairs: List[Tuple[int, int]] = []
    sizes = np.bincount(labels.ravel(), minlength=number + 1)
    largest = int(np.argmax(sizes[1:])) + 1
    for label, box in enumerate(ndimage.find_objects(labels), 1):
        if label != largest:
            pairs += _neighbours(labels, label, _grown(box, 2 * SHORT, labels.shape), floor)
    if not pairs:
        return labels
    one, other = np.array(pairs).T
    links = coo_matrix((np.ones(len(one)), (one, other)), (number + 1, number + 1))
    _, groups = csgraph.connected_components(links, directed=False)
    first = np.zeros(groups.max() + 1, labels.dtype)
    first[groups[::-1]] = np.arange(number, -1, -1)  # the least label of each group
    return np.asarray(first[groups][labels])


def _neighbours(labels: Array, label: int, window: Window, floor: Floor) -> List[Tuple[int, int]]:
    """Pairs of parts, one of which is that with a label, that a strait in its window joins."""
    here = labels[window]
    theirs = (here > 0) & (here != label)
    if not theirs.any():
        return []
    near = _around(here == label) & _around(theirs)
    rows, columns = (np.arange(span.start, span.stop) // 2 for span in window)  # nodes near the points
    near &= floor.clearance[rows[:, np.newaxis], columns] >= floor.wide - HIDDEN
    straits, _ = ndimage.label(near, ALL_AROUND)
    found = []
    for box in ndimage.find_objects(straits):
        if max(span.stop - span.start for span in box) > LONGEST:
            continue
        top, left = window[0].start + box[0].start, window[1].start + box[1].start
        strait = slice(top, top + box[0].stop - box[0].start), slice(left, left + box[1].stop - box[1].start)
        groups = _through(labels, _grown(strait, SHORT + 1, labels.shape), floor)
        found += [(label, other) for group in groups if label in group for other in group if other != label]
    return found


def _around(mask: Array) -> Array:
    """The points within SHORT steps of some."""
    return np.asarray(ndimage.maximum_filter(mask, 2 * SHORT + 1))


def _through(labels: Array, window: Window, floor: Floor) -> List[List[int]]:
    """The parts in a small window of the lattice that hang together there, by exact distances: groups of labels."""
    cells = tuple(slice(span.start // 2, (span.stop + 1) // 2) for span in window)
    beyond = math.ceil(floor.wide) + 1
    outer = tuple(slice(max(span.start - beyond, 0), min(span.stop + beyond, size))
                  for span, size in zip(cells, floor.cells.shape))
    inner = tuple(slice((span.start - out.start) * FINER, (span.stop - out.start) * FINER + 1)
                  for span, out in zip(cells, outer))
    away = _exact(floor.cells[outer], FINER)[inner]
    nodes = floor.clearance[cells[0].start:cells[0].stop + 1, cells[1].start:cells[1].stop + 1]
    if (nodes < np.minimum(away[::FINER, ::FINER], floor.wide) - CLOSER).any():
        return []  # obstacles stand there that the cells do not show
    parts, _ = ndimage.label(away >= floor.wide, ALL_AROUND)
    at_points = parts[::FINER // 2, ::FINER // 2]
    there = labels[2 * cells[0].start:2 * cells[0].stop + 1, 2 * cells[1].start:2 * cells[1].stop + 1]
    known = (there > 0) & (at_points > 0)
    return [np.unique(there[known & (at_points == part)]).tolist() for part in np.unique(at_points[known])]


def _exact(cells: Array, finer: int, beyond: bool = True) -> Array:
    """Distance to the nearest cell that is not floor, in cells, at points so many times as dense as the nodes.

    It is exact, since the nearest point of a cell is such a point too. Beyond the cells, there is floor or not.
    """
    floor = np.pad(cells.repeat(finer, 0).repeat(finer, 1), 1, mode='constant', constant_values=beyond)
    inside = floor[:-1, :-1] & floor[:-1, 1:] & floor[1:, :-1] & floor[1:, 1:]
    return np.asarray(ndimage.distance_transform_edt(inside)) / finer


def _grown(box: Window, by: int, shape: Tuple[int, ...]) -> Window:
    rows, columns = (slice(max(span.start - by, 0), min(span.stop + by, size)) for span, size in zip(box, shape))
    return rows, columns
