"""Ways to small places that neither lanes nor ways along walls clean."""

from typing import Dict, List, NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.behaviours.follower import Route
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

TOGETHER = 0.1  # [m] crumbs so near each other are one
STEP = 0.06  # [m] between the places of a way past a crumb
SURPLUS = 0.002  # of coverage that is planned beyond the target, since no robot drives just as planned
DETOUR = 0.6  # [m] to a crumb that is worth it on the way
TRIES = 50  # places of a route from which a crumb is looked at, ...
APART = 0.2  # [m] ... so far from each other at most
RESOLUTION = 0.05  # [m] from pose to pose of what is planned
SHARP = 0.3  # [rad] a turn that sweeps more than the way before and after it
PIROUETTE = 0.03  # [m] out and back again, so that the robot turns on the spot and its brush sweeps a disc


class Crumb(NamedTuple):
    """A small place that was missed."""

    places: Array  # float64 (any, 2) [m] from which the brush reaches it, along its longer side
    area: float  # [m^2]


def with_crumbs(context: Context, route: Optional[Route]) -> Optional[Route]:
    """The route, with detours to the largest crumbs that it would leave, until the target is met."""
    if route is None:
        return None
    dense, legs = _dense(route.places, APART)
    route = Route(dense, route.speeds[legs])
    expected = context.swept.copy()
    drive(expected, dense)
    missing = (context.config.target_coverage + SURPLUS - expected.coverage) * expected.reachable_area
    detours: Dict[int, List[Array]] = {}
    near = context.ground.within(0.5 * context.robot.brush.width)
    for crumb in crumbs(context.ground, expected.missed() & near):
        if missing <= 0.0:
            break
        index = _nearest(context.ground, route.places, crumb.places)
        if index is not None:
            detours.setdefault(index, []).append(crumb.places)
            missing -= crumb.area
    places, speeds = [], []
    for index, place in enumerate(route.places):
        places.append(place[np.newaxis])
        for detour in detours.get(index, []):
            places += [detour, place[np.newaxis]]
            speeds.append(np.full(len(detour) + 1, context.config.speed))
        speeds.append(route.speeds[index:index + 1])
    return Route(np.concatenate(places), np.concatenate(speeds))


def _nearest(ground: Ground, places: Array, crumb: Array) -> Optional[int]:
    """The place of a route from which a crumb is near, and straight ahead; None where there is none."""
    distances = np.hypot(*(places - crumb[0]).T)
    for index in np.argsort(distances, kind='stable')[:TRIES]:
        if distances[index] > DETOUR:
            break
        if ground.is_straight(places[index], crumb[0]) and ground.is_straight(crumb[-1], places[index]):
            return int(index)
    return None


def _dense(places: Array, step: float) -> Tuple[Array, Array]:
    """A way with more places, a step [m] apart at most; and on which of its legs each of them, but the first, lies."""
    legs = np.diff(places, axis=0)
    counts = np.ceil(np.hypot(*legs.T) / step).astype(np.intp)  # 0 for a leg without length
    indices = np.repeat(np.arange(len(legs)), counts)
    shares = (np.arange(len(indices)) - np.repeat(np.cumsum(counts) - counts, counts) + 1) / counts[indices]
    between = places[indices + 1] - (1.0 - shares)[:, np.newaxis] * legs[indices]
    return np.concatenate([places[:1], between]), indices


def drive(swept: Swept, places: Array) -> None:
    """Sweep along a way as if it were driven."""
    places, _ = _dense(places, RESOLUTION)
    headings = np.arctan2(*np.diff(places, axis=0).T[::-1]).tolist()
    before = Pose(float(places[0, 0]), float(places[0, 1]), headings[0])
    for (x, y), theta in zip(places[1:].tolist(), headings):
        turned = before._replace(theta=theta)
        if abs(wrap_angle(theta - before.theta)) > SHARP:
            swept.sweep(before, turned)
        before = Pose(x, y, theta)
        swept.sweep(turned, before)


def crumbs(ground: Ground, missed: Array) -> List[Crumb]:
    """What was missed, bool (rows, columns), from the largest to the smallest."""
    size = max(int(TOGETHER / ground.plan.resolution), 1)
    labels, _ = ndimage.label(ndimage.binary_dilation(missed, np.ones((3, 3)), iterations=(size + 1) // 2))
    found = []
    for number, (rows, columns) in enumerate(ndimage.find_objects(labels), 1):
        cells = np.argwhere(missed[rows, columns] & (labels[rows, columns] == number)) + (rows.start, columns.start)
        ways = _past(ground, cells)
        area = len(cells) * ground.plan.resolution ** 2 / len(ways)
        found += [Crumb(way, area) for way in ways]
    return sorted(found, key=lambda crumb: -crumb.area)


def _past(ground: Ground, cells: Array) -> List[Array]:
    """Ways past cells (any, 2), by the places nearest to them at which the robot can stand."""
    places = ground.places(np.unique(ground.standing(cells), axis=0))
    middle = places.mean(axis=0)
    axis = np.linalg.svd(places - middle, full_matrices=False)[2][0]
    along = (places - middle) @ axis
    groups: List[List[int]] = []
    for index in np.argsort(along, kind='stable'):
        if not groups or not ground.is_straight(places[groups[-1][-1]], places[index]):
            groups.append([])
        groups[-1].append(index)
    return [_way(ground, places[group], along[group]) for group in groups]


def _way(ground: Ground, places: Array, along: Array) -> Array:
    """Past places that are sorted by how far along they lie [m]: a line, or a turn in the middle of a few."""
    if along[-1] - along[0] < 2.0 * STEP:
        return _pirouette(ground, places[int(np.argmin(np.hypot(*(places - places.mean(axis=0)).T)))])
    steps = ((along - along[0]) / STEP).astype(np.intp)
    return _eased(ground, places[np.unique(steps, return_index=True)[1]])


def _eased(ground: Ground, way: Array) -> Array:
    """The straight line along a way, where the robot can drive on it and it leads past nearly the same places."""
    middle = way.mean(axis=0)
    axis = np.linalg.svd(way - middle, full_matrices=False)[2][0]
    along = (way - middle) @ axis
    ends = middle + np.outer([along[0], along[-1]], axis)
    off = np.abs((way - middle) @ np.array([-axis[1], axis[0]])).max()
    return ends if off < STEP and ground.is_straight(ends[0], ends[1]) else way


def _pirouette(ground: Ground, place: Array) -> Array:
    """Out and back again, to the side where there is most room."""
    sides = place + PIROUETTE * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    nodes = ground.nodes(sides)
    return np.array([place, sides[int(np.argmax(ground.room[nodes[:, 0], nodes[:, 1]]))], place])
