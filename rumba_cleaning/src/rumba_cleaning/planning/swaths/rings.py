"""Rings: paths along the walls, and parallel to them farther inside: contours of the clearance, a pass apart.

Machining knows them as contour-parallel paths (M. Held, On the Computational Geometry of Pocket Machining, 1991).
A robot follows them at full speed, whatever the direction of the walls, and the outermost ones sweep along the walls.
"""

import math
from typing import Iterator, List, NamedTuple

import numpy as np
from scipy import ndimage, spatial
from skimage import measure

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.common.polyline import SPACING, resampled
from rumba_cleaning.planning.common.stretches import Stretch, Variant, pair
from rumba_cleaning.planning.decompose.regions import Shapes
from rumba_cleaning.planning.simulate.paper import drive
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
WALL_MARGIN = 0.0003  # [m] between robot and wall: small sweeps more of the rim, large touches the wall less often
# Of the brush's width from ring to ring: small leaves less where corners are cut, large drives less.
PASS, OPEN_PASS = 0.93, 0.995  # usually, and in open regions, where few rings have corners
SMOOTH = 0.07  # [m] along a ring that are averaged: takes out the steps of the grid, and cuts corners
# [m] The corners of a ring reach farther out by what such an average cuts off, as a robot does that goes round them.
BLUR = 0.21
# [m] of a ring, of its parts, and of gaps between these: a shorter part is left to the crumbs, a shorter gap is driven.
SHORTEST = 0.25
WHOLE = 0.85  # share of a ring's waypoints that are needed, for all of it to be driven: saves turns
# [m] from a ring to the next one in its chain, anywhere, at most: large makes fewer stretches, but beyond two radii of
# the robot there may be a wall in between. So far along the next ring that is entered: large bends gently.
BESIDE = 0.32
NEEDED = 0.25  # share of the brush's width that was missed, for a waypoint to be needed: small drives over swept floor
RIDGE = 0.03  # [m] by which the floor must get wider inside a ring: else one pass in the middle is enough
POINTS = 9  # across the brush: one for each 2 cm of a brush of 17 cm
ROTATIONS = 12  # points at which a ring is entered, at most: more give shorter tours, and take more time to compare
APART = 0.3  # [m] between those points, at least


class Ring(NamedTuple):
    """A closed path, or a part of one."""

    waypoints: Array  # float64 (any, 2) [m], SPACING apart; a closed one ends where it begins
    region: int  # in which it lies
    level: int  # 0 beside the walls, 1 next to that, ...
    is_closed: bool


def rings(ground: Ground, swept: Swept, labels: Array, shape: Shapes, brush: float, ring_pass: float,
          spare: float) -> List[Ring]:
    """Rings on which something was missed, from the walls inward; only along the walls, where lanes suit a region.

    In passages hardly wider than the robot one pass in the middle takes the place of both sides of a ring, unless that
    leaves too much.

    Args:
        ground: where the robot can stand.
        swept: what was swept; the rings are driven on it, on paper.
        labels: the region of each node, int (rows + 1, columns + 1).
        shape: of the regions.
        brush: width of the brush [m].
        ring_pass: from ring to ring in regions that are not open, as a share of that.
        spare: area that passes in the middle may leave beside them [m^2].
    """
    found: List[Ring] = []
    depth = _depth(ground)
    is_steep = ndimage.maximum_filter(depth, 2 * math.ceil(RIDGE / ground.plan.resolution) + 3) > depth + RIDGE
    apart = np.where(shape.is_open, OPEN_PASS, ring_pass)[labels] * brush
    passes = (depth - WALL_MARGIN) / apart  # of which level the ring through each node is, with fractions
    level = 0
    while True:
        lines = measure.find_contours(passes, level)
        if not lines:
            return found
        pieces = [_shaped(piece, shape.is_open[piece.region]) for line in lines
                  for piece in _by_region(line, ground, labels, level)]
        if level == 0 and _left_beside_ridges(ground, pieces, is_steep) > spare:
            is_steep[:] = True
        missing = swept.missing_share()
        needed = [ring for piece in sorted(pieces, key=lambda ring: -len(ring.waypoints))
                  for ring in _needed(piece, is_needed(ground, missing, is_steep, piece.waypoints, brush))]
        for ring in needed:
            drive(swept, ring.waypoints)
        found += needed
        if level == 0:
            passes = np.where(shape.has_lanes[labels], -1.0, passes)
        level += 1


def outlines(ground: Ground) -> List[Array]:
    """The paths beside the walls, whole: float64 (any, 2) [m] each; closed ones end where they begin."""
    return [resampled(ground.points(line), SPACING) for line in measure.find_contours(_depth(ground), WALL_MARGIN)]


def _depth(ground: Ground) -> Array:
    """How much farther each node is from the obstacles than the robot needs [m]; negative where it cannot stand."""
    near = ndimage.binary_dilation(ground.fits, np.ones((3, 3)), iterations=2)
    return np.where(near, ground.clearance - ground.reach, -ground.reach)


def _left_beside_ridges(ground: Ground, pieces: List[Ring], is_steep: Array) -> float:
    """Area that one pass in the middle leaves beside it on ridges, where each side of a ring is within RIDGE [m^2]."""
    nodes = ground.nodes(np.concatenate([np.empty((0, 2)), *(piece.waypoints for piece in pieces)]))
    return 0.5 * RIDGE * SPACING * float(np.count_nonzero(~is_steep[nodes[:, 0], nodes[:, 1]]))


def _shaped(ring: Ring, is_open: bool) -> Ring:
    """A ring with round corners in an open region; elsewhere with sharp ones, except along the walls."""
    if not ring.is_closed or not (is_open or ring.level):
        return ring
    path = ring.waypoints[:-1]
    smooth = ndimage.uniform_filter1d(path, int((SMOOTH if is_open else BLUR) / SPACING), axis=0, mode='wrap')
    path = smooth if is_open else 2.0 * path - smooth
    return ring._replace(waypoints=np.concatenate([path, path[:1]]))


def _by_region(contour: Array, ground: Ground, labels: Array, level: int) -> Iterator[Ring]:
    """The parts of a contour (any, 2) [nodes], region by region."""
    is_closed = bool(np.allclose(contour[0], contour[-1]))
    path = resampled(ground.points(contour), SPACING)
    if len(path) * SPACING < SHORTEST:
        return
    nodes = ground.standing(ground.nodes(path))
    of_path = labels[nodes[:, 0], nodes[:, 1]]
    cuts = np.flatnonzero(np.diff(of_path)) + 1
    if len(cuts) == 0:
        yield Ring(path, int(of_path[0]), level, is_closed)
        return
    if is_closed:
        path, of_path = rotated(path, cuts[0]), rotated(of_path, cuts[0])
        cuts = np.flatnonzero(np.diff(of_path)) + 1
    for part in np.split(np.arange(len(of_path)), cuts):
        if len(part) * SPACING >= SHORTEST:
            yield Ring(path[part], int(of_path[part[0]]), level, False)


def rotated(ring: Array, index: int) -> Array:
    """A ring, whose last element equals its first, that begins at another element."""
    return np.concatenate([ring[index:-1], ring[:index + 1]])


def is_needed(ground: Ground, missing: Array, is_steep: Array, path: Array, brush: float) -> Array:
    """At which waypoints of a path the brush finds much that was missed, except on ridges: bool (any).

    On a ridge the two sides of a ring almost touch, and a pass in the middle sweeps what both would.

    Args:
        ground: on which the path lies.
        missing: share of each cell that was missed, float32 (rows, columns).
        is_steep: which nodes are not on ridges of the clearance, bool (rows + 1, columns + 1).
        path: float64 (2 or more, 2) [m].
        brush: its width [m].
    """
    along = np.concatenate([path[1:], path[-1:]]) - np.concatenate([path[:1], path[:-1]])
    left = along[:, ::-1] * (-1.0, 1.0) / np.hypot(*along.T)[:, np.newaxis]
    across = path[:, np.newaxis] + brush * np.linspace(-0.5, 0.5, POINTS)[:, np.newaxis] * left[:, np.newaxis]
    columns, rows = np.moveaxis((across - ground.plan.origin) / ground.plan.resolution, -1, 0).astype(np.intp)
    nodes = ground.nodes(path)
    return np.asarray((missing[rows, columns].mean(axis=1) >= NEEDED) & is_steep[nodes[:, 0], nodes[:, 1]])


def _needed(ring: Ring, needed: Array) -> Iterator[Ring]:
    """The parts of a ring on which waypoints are needed, bool (any)."""
    path = ring.waypoints
    if needed.mean() > WHOLE:
        yield ring
        return
    size = int(SHORTEST / SPACING)
    if ring.is_closed and needed.any():
        index = int(np.argmin(needed))
        path, needed = rotated(path, index), rotated(needed, index)
    needed = ndimage.binary_closing(np.pad(needed, size), np.ones(size))[size:-size] | needed
    parts, _ = ndimage.label(needed)
    for (part,) in ndimage.find_objects(parts):
        if (part.stop - part.start) * SPACING >= SHORTEST:
            yield Ring(path[part], ring.region, ring.level, False)


# --- chains ---------------------------------------------------------------------------------------------------------

def chains(found: List[Ring]) -> List[List[Ring]]:
    """Closed rings one inside the other, each list from the walls inward; every other ring is a list of its own."""
    lists: List[List[Ring]] = []
    for ring in found:
        outer = next((chain for chain in lists if ring.is_closed and _is_inside(ring, chain[-1])), None)
        if outer is None:
            lists.append([ring])
        else:
            outer.append(ring)
    return lists


def _is_inside(ring: Ring, outer: Ring) -> bool:
    """Whether a ring lies beside another one, a level farther out, all the way around that."""
    if not (outer.is_closed and outer.level + 1 == ring.level and outer.region == ring.region):
        return False
    tree = spatial.cKDTree(ring.waypoints)
    return bool(tree.query(outer.waypoints[0])[0] < BESIDE and tree.query(outer.waypoints)[0].max() < BESIDE)


def stretch(chain: List[Ring], brush: float) -> Stretch:
    """The paths along a chain: in both directions, from outside and from inside, from several points."""
    area = brush * SPACING * sum(len(ring.waypoints) for ring in chain)
    if not chain[0].is_closed:
        return Stretch(pair([chain[0].waypoints]), chain[0].region, area)
    first = chain[0].waypoints
    step = max(int(APART / SPACING), math.ceil((len(first) - 1) / ROTATIONS))
    found: List[Variant] = []
    for is_turned in (False, True)[:len(chain)]:
        paths = [ring.waypoints[::-1] if is_turned else ring.waypoints for ring in chain]
        twice = [np.concatenate([path[:-1], path]) for path in paths]
        for index in range(0, len(first) - 1, step):
            found += pair(_spiral(twice, index))
    return Stretch(found, chain[0].region, area)


def _spiral(twice: List[Array], index: int) -> List[Array]:
    """The path along rings, the first of which is entered at a waypoint; each is given twice round, and not copied."""
    parts: List[Array] = []
    for path in twice:
        size = len(path) // 2
        if parts:
            index = int(np.argmin(np.hypot(*(path[:size] - parts[-1][-1]).T)))
            index = (index + int(BESIDE / SPACING)) % size
        parts.append(path[index:index + size + 1])
    return parts
