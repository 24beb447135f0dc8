"""Paths past crumbs, which rings and lanes do not clean: a long crumb is driven piece by piece, a spot passed over."""

import math
from typing import Iterator, List

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.search import path_lengths
from rumba_cleaning.planning.common.stretches import Stretch, Variant, pair
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
MISSED = 0.3  # share of a cell, for it to belong to a crumb: large makes fewer detours, small meets high targets
LEAST = 0.0004  # [m^2] of a crumb: large makes fewer detours, small meets high targets
PIECE = 0.3  # [m] along a piece of a crumb, at most: a large one is bent, small ones take more time to compare
LONG = 0.15  # [m] of a piece that is driven from end to end; a shorter one is passed over in any direction
HEADINGS = 8  # in which a spot may be passed over; more take more time to compare
OVER = 0.02  # [m] before and behind a spot: large passes over all of it, small takes less time
RIM = 0.045  # [m] from where the robot can stand to the middle of a spot: beyond that it turns to reach it
INTO = 0.06  # [m] that the robot drives straight toward a spot at the rim


def crumbs(ground: Ground, share: Array, regions: Array, least: float = 0.0, apart: float = 0.0) -> List[Stretch]:
    """The pieces of crumbs.

    Args:
        ground: where the robot can stand.
        share: of each cell that was missed, float32 (rows, columns).
        regions: the region of each node, int (rows + 1, columns + 1).
        least: area of a crumb [m^2]; there is a least one in any case.
        apart: how far apart cells may be that belong together [m].
    """
    res = ground.plan.resolution
    labels, _ = ndimage.label(_joined(share >= MISSED, int(0.5 * apart / res)), np.ones((3, 3)))
    areas = np.bincount(labels.ravel(), share.ravel()) * res * res
    found: List[Stretch] = []
    for number, window in enumerate(ndimage.find_objects(labels), 1):
        if areas[number] >= max(least, LEAST):
            corner = np.array([window[0].start, window[1].start])
            found += [_over(ground, cells + corner, regions, share) for cells in _pieces(labels[window] == number, res)]
    return found


def _pieces(cells: Array, resolution: float) -> Iterator[Array]:
    """The cells, int (any, 2), of pieces of connected ones, bool (rows, columns), by their distance from an end."""
    lengths = np.zeros(cells.shape)
    for _ in range(2):  # from any cell to the one farthest from it, and from there to all others
        end = np.argmax(np.where(cells, lengths, -1.0))
        lengths = path_lengths(cells, *np.unravel_index(end, cells.shape))
    count = int(lengths[cells].max() * resolution / PIECE) + 1
    numbers = np.where(cells, np.minimum(lengths * count / max(lengths[cells].max(), 1.0), count - 1), -1).astype(int)
    for number in range(count):
        parts, _ = ndimage.label(numbers == number, np.ones((3, 3)))
        for part, window in enumerate(ndimage.find_objects(parts), 1):
            yield np.argwhere(parts[window] == part) + [side.start for side in window]


def _joined(cells: Array, reach: int) -> Array:
    """Cells, bool (rows, columns), and all that are so near to one [cells]."""
    if reach == 0:
        return cells
    across = np.arange(-reach, reach + 1)
    disc = across ** 2 + across[:, np.newaxis] ** 2 <= reach ** 2
    return np.asarray(ndimage.binary_dilation(cells, disc))


def _over(ground: Ground, cells: Array, regions: Array, share: Array) -> Stretch:
    """Along a long piece of cells, int (any, 2), or over the middle of a spot in any direction.

    If a spot is at the rim, the robot drives toward it, and back after a turn on the spot.
    """
    res = ground.plan.resolution
    node = ground.standing(cells[:1])[0]
    region, area = int(regions[node[0], node[1]]), float(share[cells[:, 0], cells[:, 1]].sum()) * res * res
    points = ground.points(cells + 0.5)
    middle = points.mean(axis=0)
    x, y = (points - middle).T
    angle = 0.5 * math.atan2(2.0 * (x * y).sum(), (x * x - y * y).sum())  # of the main axis
    ahead = x * math.cos(angle) + y * math.sin(angle)
    if np.ptp(ahead) >= LONG:
        line = _standing(ground, middle + np.array([[ahead.min()], [ahead.max()]]) * (math.cos(angle), math.sin(angle)))
        if ground.is_straight(*line):
            return Stretch(pair([line]), region, area)
    point = _standing(ground, middle[np.newaxis])[0]
    away = point - middle
    distance = float(np.hypot(*away))
    if distance > RIM:
        outside = point + INTO / distance * away
        outside = outside if ground.are_free(outside[np.newaxis])[0] else point
        return Stretch(pair([np.array([outside, point, outside])]), region, area)
    half = 0.5 * (np.ptp(cells, axis=0).max() + 1) * res + OVER
    variants: List[Variant] = []
    for number in range(HEADINGS // 2):
        angle = math.pi * number / (HEADINGS // 2)
        step = half * np.array([math.cos(angle), math.sin(angle)])
        line = np.array([point - step, point + step])
        line = np.where(ground.are_free(line)[:, np.newaxis], line, point)
        variants += pair([line])
    return Stretch(variants, region, area)


def _standing(ground: Ground, points: Array) -> Array:
    """Points (any, 2) [m], each that is too near to a wall moved to the nearest point where the robot can stand."""
    near = ground.points(ground.standing(ground.nodes(points)))
    off = np.hypot(*(near - points).T) > 1.5 * ground.plan.resolution
    return np.where((off | ~ground.are_free(points))[:, np.newaxis], near, points)
