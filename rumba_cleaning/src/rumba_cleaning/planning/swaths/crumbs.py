"""Paths past crumbs, which rings do not clean. A long one is driven along its middle, a spot is passed over."""

import math
from typing import Dict, List, Set, Tuple

import numpy as np
from scipy import ndimage
from skimage import morphology

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common.polyline import simplified
from rumba_cleaning.planning.common.stretches import Stretch, Variant, pair
from rumba_cleaning.route import lengths_along
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
MISSED = 0.3  # share of a cell, for it to belong to a crumb: large makes fewer detours, small meets high targets
LEAST = 0.0004  # [m^2] of a crumb: large makes fewer detours, small meets high targets
STRIP = 0.3  # [m] length of a crumb that is driven along its middle; a shorter one is passed over in any direction
TWIG = 0.12  # [m] length of a side branch of the middle that is driven too
HEADINGS = 8  # in which a spot may be passed over; more take more time to compare
OVER = 0.02  # [m] before and behind a spot: large passes over all of it, small takes less time
AVERAGED = 5  # [cells] along the middle of a strip, which goes from cell to cell in steps
# [m] from where the robot can stand to the middle of a spot, which is at the rim beyond that: the robot drives so far
# straight toward it, and turns to come back.
RIM = 0.05
STRAIGHT = 0.012  # [m] by which the path along a strip may leave its middle
NEIGHBOURS = tuple((row, column) for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column)

Pixel = Tuple[int, int]


def crumbs(ground: Ground, share: Array, regions: Array, least: float = 0.0, apart: float = 0.0) -> List[Stretch]:
    """The crumbs: strips and spots.

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
        if areas[number] < max(least, LEAST):
            continue
        cells = labels[window] == number
        corner = np.array([window[0].start, window[1].start])
        node = ground.standing(np.argwhere(cells)[:1] + corner)[0]
        region = int(regions[node[0], node[1]])
        if max(cells.shape) * res >= STRIP:
            found += _strips(ground, cells, corner, region, areas[number])
        else:
            found.append(_spot(ground, cells, corner, region, areas[number]))
    return found


def _joined(cells: Array, reach: int) -> Array:
    """Cells, bool (rows, columns), and all that are so near to one [cells]."""
    if reach == 0:
        return cells
    across = np.arange(-reach, reach + 1)
    disc = across ** 2 + across[:, np.newaxis] ** 2 <= reach ** 2
    return np.asarray(ndimage.binary_dilation(cells, disc))


def _strips(ground: Ground, cells: Array, corner: Array, region: int, area: float) -> List[Stretch]:
    """Paths along the middle of a crumb and of its branches."""
    paths: List[Array] = []
    for pixels in middle_lines(cells, int(TWIG / ground.plan.resolution)):
        points = ground.points(pixels + corner + 0.5)
        if len(points) > AVERAGED:
            points = ndimage.uniform_filter1d(points, AVERAGED, axis=0, mode='nearest')
        paths += _parted(ground, _standing(ground, points))
    lengths = [float(lengths_along(path)[-1]) for path in paths]
    found = [Stretch(pair([simplified(path, STRAIGHT)]), region, area * length / sum(lengths))
             for path, length in zip(paths, lengths) if length >= 2.0 * OVER]
    return found or [_spot(ground, cells, corner, region, area)]


def _parted(ground: Ground, path: Array) -> List[Array]:
    """The parts of a path whose points were moved to both sides of what stands there, as the two of a wall."""
    return np.split(path, np.flatnonzero(~ground.are_free(0.5 * (path[:-1] + path[1:]))) + 1)


def _standing(ground: Ground, points: Array) -> Array:
    """Points (any, 2) [m], each that is too near to a wall moved to the nearest point where the robot can stand."""
    near = ground.points(ground.standing(ground.nodes(points)))
    off = np.hypot(*(near - points).T) > 1.5 * ground.plan.resolution
    return np.where((off | ~ground.are_free(points))[:, np.newaxis], near, points)


def _spot(ground: Ground, cells: Array, corner: Array, region: int, area: float) -> Stretch:
    """Over the middle of a spot, in any direction; if it is at the rim, into it, and back after a turn on the spot."""
    middle = ground.points(np.argwhere(cells).mean(axis=0)[np.newaxis] + corner + 0.5)
    point = _standing(ground, middle)[0]
    away = point - middle[0]
    distance = float(np.hypot(*away))
    if distance > RIM:
        outside = point + RIM / distance * away
        outside = outside if ground.are_free(outside[np.newaxis])[0] else point
        return Stretch(pair([np.array([outside, point, outside])]), region, area)
    half = 0.5 * max(cells.shape) * ground.plan.resolution + OVER
    variants: List[Variant] = []
    for number in range(HEADINGS // 2):
        angle = math.pi * number / (HEADINGS // 2)
        step = half * np.array([math.cos(angle), math.sin(angle)])
        line = np.array([point - step, point + step])
        line = np.where(ground.are_free(line)[:, np.newaxis], line, point)
        variants += pair([line])
    return Stretch(variants, region, area)


def middle_lines(cells: Array, twig: int) -> List[Array]:
    """Lines of cells, int (any, 2), in the middle of bool (rows, columns); side branches have `twig` cells or more."""
    lines: List[Array] = []
    skeleton = morphology.skeletonize(np.pad(cells, 1))[1:-1, 1:-1]
    left: Set[Pixel] = {(row, column) for row, column in np.argwhere(skeleton).tolist()}
    while left:
        reached, _ = _spread(left, min(left))
        end, before = _spread(left, reached[-1])
        line = [end[-1]]
        while before[line[-1]] != line[-1]:
            line.append(before[line[-1]])
        if len(line) >= twig or not lines:
            lines.append(np.array(line))
        left -= set(line) if len(line) >= twig else set(reached)
    return lines


def _spread(cells: Set[Pixel], start: Pixel) -> Tuple[List[Pixel], Dict[Pixel, Pixel]]:
    """All cells that are connected to a start, the farthest last, and for each the cell before it on the way."""
    before, reached = {start: start}, [start]
    for row, column in reached:
        for down, right in NEIGHBOURS:
            cell = (row + down, column + right)
            if cell in cells and cell not in before:
                before[cell] = row, column
                reached.append(cell)
    return reached, before
