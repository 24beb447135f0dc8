"""Paths past crumbs: small spots that neither the lanes nor the paths along the walls clean."""

from typing import Dict, List, NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.behaviours.follower import Route
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
MERGE = 0.1  # [m] between missed cells of one crumb: large makes fewer detours, small makes shorter paths past each
SPACING = 0.06  # [m] between waypoints past a crumb: a third of a brush, so that the brush misses nothing in a bend
SURPLUS = 0.002  # of coverage that is planned beyond the target, since no robot drives exactly as planned
DETOUR = 0.6  # [m] from the route to a crumb, at most: large meets high targets, small saves distance
TRIES = 50  # waypoints of the route from which a straight line to a crumb is looked for, at most: saves time
APART = 0.2  # [m] between waypoints from which a detour may start, at most: small makes detours shorter
PLAN_STEP = 0.05  # [m] between the poses of a drive on paper: one cell of a usual map
SHARP = 0.3  # [rad] a turn by more is swept on its own, on paper: below that the strips before and after it overlap
PIROUETTE = 0.03  # [m] forth and back, so that the robot makes half a turn on the spot and its brush sweeps a disc


class Crumb(NamedTuple):
    """A small spot that was missed."""

    waypoints: Array  # float64 (any, 2) [m] of a path past it, from which the brush reaches it
    area: float  # [m^2]


def with_crumbs(context: Context, route: Optional[Route]) -> Optional[Route]:
    """A route with detours to the largest crumbs that it would leave, as many as the target needs.

    Args:
        context: with the floor that was swept before; it is not changed.
        route: without detours; None is answered with None.
    """
    if route is None:
        return None
    dense, legs = _dense(route.waypoints, APART)
    route = Route(dense, route.speeds[legs])
    expected = context.swept.copy()
    drive(expected, dense)
    missing = (context.target_coverage + SURPLUS - expected.coverage) * expected.reachable_area  # [m^2]
    detours: Dict[int, List[Array]] = {}
    near = context.ground.within(0.5 * context.robot.brush.width)
    for crumb in crumbs(context.ground, expected.missed() & near):
        if missing <= 0.0:
            break
        index = _nearest(context.ground, route.waypoints, crumb.waypoints)
        if index is not None:
            detours.setdefault(index, []).append(crumb.waypoints)
            missing -= crumb.area
    waypoints, speeds = [], []
    for index, waypoint in enumerate(route.waypoints):
        waypoints.append(waypoint[np.newaxis])
        for detour in detours.get(index, []):
            waypoints += [detour, waypoint[np.newaxis]]
            speeds.append(np.full(len(detour) + 1, context.config.speed))
        speeds.append(route.speeds[index:index + 1])
    return Route(np.concatenate(waypoints), np.concatenate(speeds))


def _nearest(ground: Ground, waypoints: Array, crumb: Array) -> Optional[int]:
    """Index of the nearest waypoint from which straight lines lead to both ends of a crumb's path; None: not one."""
    distances = np.hypot(*(waypoints - crumb[0]).T)
    for index in np.argsort(distances, kind='stable')[:TRIES]:
        if distances[index] > DETOUR:
            break
        if ground.is_straight(waypoints[index], crumb[0]) and ground.is_straight(crumb[-1], waypoints[index]):
            return int(index)
    return None


def _dense(path: Array, spacing: float) -> Tuple[Array, Array]:
    """A path with more waypoints.

    Args:
        path: float64 (any, 2) [m]
        spacing: between the waypoints, at most [m].

    Returns:
        The waypoints, float64 (n, 2) [m], and for each but the first the leg of the path on which it lies, int (n - 1).
    """
    legs = np.diff(path, axis=0)
    counts = np.ceil(np.hypot(*legs.T) / spacing).astype(np.intp)  # 0 for a leg without length
    indices = np.repeat(np.arange(len(legs)), counts)
    shares = (np.arange(len(indices)) - np.repeat(np.cumsum(counts) - counts, counts) + 1) / counts[indices]
    between = path[indices + 1] - (1.0 - shares)[:, np.newaxis] * legs[indices]
    return np.concatenate([path[:1], between]), indices


def drive(swept: Swept, path: Array) -> None:
    """Sweep along a path (any, 2) [m] as if a robot had driven on it exactly ("on paper")."""
    points, _ = _dense(path, PLAN_STEP)
    headings = np.arctan2(*np.diff(points, axis=0).T[::-1]).tolist()
    before = Pose(float(points[0, 0]), float(points[0, 1]), headings[0])
    for (x, y), theta in zip(points[1:].tolist(), headings):
        turned = before._replace(theta=theta)
        if abs(wrap_angle(theta - before.theta)) > SHARP:
            swept.sweep(before, turned)
        before = Pose(x, y, theta)
        swept.sweep(turned, before)


def crumbs(ground: Ground, missed: Array) -> List[Crumb]:
    """The crumbs in what was missed, bool (rows, columns), from the largest to the smallest."""
    size = max(int(MERGE / ground.plan.resolution), 1)
    labels, _ = ndimage.label(ndimage.binary_dilation(missed, np.ones((3, 3)), iterations=(size + 1) // 2))
    found = []
    for number, (rows, columns) in enumerate(ndimage.find_objects(labels), 1):
        cells = np.argwhere(missed[rows, columns] & (labels[rows, columns] == number)) + (rows.start, columns.start)
        paths = _paths_past(ground, cells)
        area = len(cells) * ground.plan.resolution ** 2 / len(paths)
        found += [Crumb(path, area) for path in paths]
    return sorted(found, key=lambda crumb: -crumb.area)


def _paths_past(ground: Ground, cells: Array) -> List[Array]:
    """Paths past cells (any, 2), over the points nearest to them at which the robot can stand.

    The points are sorted along the axis in which they are spread most; a path ends where the robot cannot drive
    straight to the next point, and another path begins there.
    """
    points = ground.points(np.unique(ground.standing(cells), axis=0))
    along = _along(points)[0]
    groups: List[List[int]] = []
    for index in np.argsort(along, kind='stable'):
        if not groups or not ground.is_straight(points[groups[-1][-1]], points[index]):
            groups.append([])
        groups[-1].append(index)
    return [_path_over(ground, points[group], along[group]) for group in groups]


def _along(points: Array) -> Tuple[Array, Array, Array]:
    """The main axis of points (any, 2) [m]: their positions along it (any) [m], their mean (2) [m] and the axis (2)."""
    middle = points.mean(axis=0)
    axis = np.linalg.svd(points - middle, full_matrices=False)[2][0]
    return (points - middle) @ axis, middle, axis


def _path_over(ground: Ground, points: Array, along: Array) -> Array:
    """A path over points (any, 2) [m] sorted by their positions along an axis [m]: a line, or a turn on the spot."""
    if along[-1] - along[0] < 2.0 * SPACING:
        return _pirouette(ground, points[int(np.argmin(np.hypot(*(points - points.mean(axis=0)).T)))])
    steps = ((along - along[0]) / SPACING).astype(np.intp)
    return _simplified(ground, points[np.unique(steps, return_index=True)[1]])


def _simplified(ground: Ground, path: Array) -> Array:
    """The straight line along a path, if the robot can drive on it and no waypoint is far from it; else the path."""
    along, middle, axis = _along(path)
    ends = middle + np.outer([along[0], along[-1]], axis)
    off = np.abs((path - middle) @ np.array([-axis[1], axis[0]])).max()
    return ends if off < SPACING and ground.is_straight(ends[0], ends[1]) else path


def _pirouette(ground: Ground, point: Array) -> Array:
    """From a point (2) [m] forth and back again, to the side with the largest clearance: float64 (3, 2) [m]."""
    sides = point + PIROUETTE * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    nodes = ground.nodes(sides)
    return np.array([point, sides[int(np.argmax(ground.clearance[nodes[:, 0], nodes[:, 1]]))], point])
