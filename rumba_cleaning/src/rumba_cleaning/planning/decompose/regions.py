"""Parts a floor into regions, such as the rooms of a flat, at doors and other narrow passages.

A watershed of the clearance: each region grows from a wide part of the floor, and two regions meet where the passage
between them is narrowest.
"""

from typing import Dict, List, NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common.rows import distinct
from rumba_cleaning.planning.decompose.watershed import watershed
from rumba_sim.model.kernel import Array

# Our choice: 2 * WIDE is wider than the doors of dwellings (0.7 to 0.9 m), and narrower than a room.
WIDE = 0.5  # [m] clearance that no point in a door has
NODES = 0.05  # [m] between the nodes that are looked at: large is fast, small is exact
# [m] by which the mean clearance of an open region, and of one that is no corridor, is larger than the robot needs.
OPEN, NARROW = 1.0, 0.15
LEAST = 0.6  # [m^2] with such clearance make a region of their own; less belongs to the region beside it


def regions(ground: Ground) -> Array:
    """The region of each node: int (rows + 1, columns + 1), from 1; 0 if the robot cannot stand there."""
    step = max(int(NODES / ground.plan.resolution + 0.5), 1)
    clearance, fits = ground.clearance[::step, ::step], ground.fits[::step, ::step]
    seeds, _ = ndimage.label(clearance >= WIDE)
    seeds[(np.bincount(seeds.ravel()) * (step * ground.plan.resolution) ** 2 < LEAST)[seeds]] = 0
    connected, count = ndimage.label(fits, np.ones((3, 3)))
    has_seed = np.zeros(count + 1, np.bool_)
    has_seed[connected[seeds > 0]] = True
    narrow = fits & ~has_seed[connected]
    seeds = np.where(narrow, connected + seeds.max(), seeds)
    coarse = watershed(-clearance, seeds, fits)
    if step == 1:
        return coarse
    if not coarse.any():
        return ground.fits.astype(coarse.dtype)
    nearest = ndimage.distance_transform_edt(coarse == 0, return_distances=False, return_indices=True)
    filled = coarse[nearest[0], nearest[1]]
    rows, columns = ((np.arange(size) + step // 2) // step for size in ground.fits.shape)
    rows, columns = np.minimum(rows, len(coarse) - 1), np.minimum(columns, len(coarse[0]) - 1)
    return np.where(ground.fits, filled[rows[:, np.newaxis], columns], 0)


class Shapes(NamedTuple):
    """What suits each region, by its label."""

    is_open: Array  # bool (labels): it is so wide that the rings in it are long and have few corners
    has_lanes: Array  # bool (labels): lanes suit it better than rings, except along its walls


def shapes(ground: Ground, labels: Array, narrow: float = NARROW) -> Shapes:
    """How wide the regions are: in open ones and in corridors rings are best, in rooms with furniture lanes.

    Args:
        ground: where the robot can stand.
        labels: the region of each node, int (rows + 1, columns + 1).
        narrow: mean clearance of a corridor beyond what the robot needs, at most [m].
    """
    counts = np.maximum(np.bincount(labels.ravel()), 1)
    room = np.bincount(labels.ravel(), ground.clearance.ravel()) / counts - ground.reach
    return Shapes(room > OPEN, (room > narrow) & (room <= OPEN))


class Doors(NamedTuple):
    """Where regions meet."""

    points: Array  # float64 (doors, 2) [m]
    sides: Array  # int (doors, 2), the labels of the two regions


def doors(ground: Ground, labels: Array) -> Doors:
    """The widest place of each border between two regions."""
    sides, nodes = [], []
    for one, other in ((labels[1:], labels[:-1]), (labels[:, 1:], labels[:, :-1])):
        where = np.argwhere((one != other) & (one > 0) & (other > 0))
        pairs = np.stack([one[where[:, 0], where[:, 1]], other[where[:, 0], where[:, 1]]], axis=1)
        sides.append(np.sort(pairs, axis=1))
        nodes.append(where)
    pairs, places = np.concatenate(sides), np.concatenate(nodes)
    widest = np.argsort(-ground.clearance[places[:, 0], places[:, 1]], kind='stable')
    found, first = distinct(pairs[widest])
    return Doors(ground.points(places[widest[first]]), found)


class Ways:
    """Ways from region to region, over the doors between them, as if each region were open floor.

    Attributes:
        metres: float64 (places, places), from place to place; inf if there is no way.
    """

    def __init__(self, borders: Doors, places: Array, labels: List[int]) -> None:
        """Find the ways.

        Args:
            borders: where regions meet.
            places: float64 (places, 2) [m].
            labels: the region of each place.
        """
        self._places = len(places)
        self._points = np.concatenate([places, borders.points])
        of_region: Dict[int, List[int]] = {}
        for index, label in enumerate(labels):
            of_region.setdefault(label, []).append(index)
        for index, sides in enumerate(borders.sides.tolist(), len(places)):
            for label in sides:
                of_region.setdefault(label, []).append(index)
        pairs = np.array([(one, other) for members in of_region.values() for one in members for other in members
                          if one != other], np.intp).reshape(-1, 2)
        lengths = np.hypot(*(self._points[pairs[:, 0]] - self._points[pairs[:, 1]]).T) + 1e-6  # 0 means: no edge
        size = len(self._points)
        graph = sparse.csr_matrix((lengths, (pairs[:, 0], pairs[:, 1])), (size, size))
        metres, self._before = csgraph.dijkstra(graph, indices=np.arange(self._places), return_predecessors=True)
        self.metres = metres[:, :self._places]

    def doors(self, start: int, end: int) -> Tuple[Optional[Array], Optional[Array]]:
        """The first door and the last one on the way from a place to another: points (2) [m]; None: there is none."""
        way = [end]
        while way[-1] != start and self._before[start, way[-1]] >= 0:
            way.append(int(self._before[start, way[-1]]))
        between = [point for point in way[::-1] if point >= self._places]
        return (self._points[between[0]], self._points[between[-1]]) if between else (None, None)
