"""Parts a floor into regions, such as the rooms of a flat, at doors and other narrow passages.

A watershed of the clearance: each region grows from a wide part of the floor, and two regions meet where the passage
between them is narrowest.
"""

import itertools
from typing import Dict, List, NamedTuple, Tuple

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
OPEN, NARROW = 1.0, 0.17
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


def shapes(ground: Ground, labels: Array) -> Shapes:
    """How wide the regions are: in open ones and in corridors rings are best, in rooms with furniture lanes.

    Args:
        ground: where the robot can stand.
        labels: the region of each node, int (rows + 1, columns + 1).
    """
    counts = np.maximum(np.bincount(labels.ravel()), 1)
    room = np.bincount(labels.ravel(), ground.clearance.ravel()) / counts - ground.reach
    return Shapes(room > OPEN, (room > NARROW) & (room <= OPEN))


def doors(ground: Ground, labels: Array) -> Tuple[Array, Array]:
    """The widest place of each border between two regions, float64 (any, 2) [m], and their labels, int (any, 2)."""
    sides, nodes = [], []
    for one, other in ((labels[1:], labels[:-1]), (labels[:, 1:], labels[:, :-1])):
        where = np.argwhere((one != other) & (one > 0) & (other > 0))
        pairs = np.stack([one[where[:, 0], where[:, 1]], other[where[:, 0], where[:, 1]]], axis=1)
        sides.append(np.sort(pairs, axis=1))
        nodes.append(where)
    pairs, places = np.concatenate(sides), np.concatenate(nodes)
    widest = np.argsort(-ground.clearance[places[:, 0], places[:, 1]], kind='stable')
    found, first = distinct(pairs[widest])
    return ground.points(places[widest[first]]), found


def distances(ground: Ground, labels: Array, places: Array) -> Array:
    """Lengths of the ways from place to place over doors, as if each region were open floor [m]; inf: there is none.

    Args:
        ground: where the robot can stand.
        labels: the region of each node, int (rows + 1, columns + 1).
        places: float64 (places, 2) [m].

    Returns:
        float64 (places, places)
    """
    borders, sides_of = doors(ground, labels)
    points = np.concatenate([places, borders])
    nodes = ground.standing(ground.nodes(places))
    of_region: Dict[int, List[int]] = {}
    for index, sides in enumerate([*labels[nodes[:, 0], nodes[:, 1], np.newaxis].tolist(), *sides_of.tolist()]):
        for label in sides:
            of_region.setdefault(label, []).append(index)
    one, other = np.array([pair for members in of_region.values() for pair in itertools.permutations(members, 2)],
                          np.intp).reshape(-1, 2).T
    lengths = np.hypot(*(points[one] - points[other]).T) + 1e-6  # 0 means: no edge
    graph = sparse.csr_matrix((lengths, (one, other)), (len(points), len(points)))
    return np.asarray(csgraph.dijkstra(graph, indices=np.arange(len(places)))[:, :len(places)])
