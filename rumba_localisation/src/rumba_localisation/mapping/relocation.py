"""Looks all over a map for a robot that was carried away; the map stays as it is meanwhile."""

import math
from typing import List, NamedTuple, Optional

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.localiser import Estimate
from rumba_localisation.mapping.clear_match import WRONG
from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan, is_blind, thinned
from rumba_sim.model.common.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array

# All these are our choice:
SPACING, HEADINGS = 0.15, 60  # [m] between the places that are tried, and headings at each
WIDTH = 0.3  # [m] from a wall, at which the end of a beam counts nothing: a place that is tried is up to 0.11 m off
BEAMS, MATCHED = 40, 180  # by which places are tried, and matched
AT_ONCE = 2500  # places that are tried with a scan: others with the next, so that none takes long
KEPT = 40  # places that are followed
APART = (0.5, 0.4)  # [m], [rad] from there on, a place is another
SPREAD = np.diag([0.15, 0.15, 0.1]) ** 2  # covariance of a place that is followed [m^2, m^2, rad^2]
SCANS, WAY = 5, 1.0  # scans, and [m] of way, at least, over which a place must fit
FITS = 0.6  # quality that scans must have there ...
MARGIN = 0.15  # ... and by so much more than at any other place
HARDLY = 0.3  # quality at the best place, below which all are tried again


class Place(NamedTuple):
    """Where the robot may be."""

    pose: Pose  # map frame
    covariance: Array  # float64 (3, 3)
    score: float  # sum over scans
    scans: int

    @property
    def mean(self) -> float:
        """How well scans fit there."""
        return self.score / max(self.scans, 1)


class Relocation:
    """Tries places with one scan after the other, follows the best, and tells which fits far better than all others.

    If none of them fits after some way, it tries all again: the map may be wrong where they were tried first. For the
    same reason, the place where the robot would be if nobody had carried it is followed all the time. It is chosen if
    scans fit there, and nowhere far better.
    """

    def __init__(self, grid: Grid, noise: Noise, correction: Pose) -> None:
        """Look on a map.

        Args:
            grid: the map.
            noise: of the laser.
            correction: pose of the frame of the odometry in the map frame, if nobody has carried the robot.
        """
        self._grid, self._noise = grid, noise
        step = max(round(SPACING / grid.resolution), 1)
        free = np.argwhere(grid.odds[step // 2::step, step // 2::step] < 0.0)[:, ::-1] * step + step // 2 + 0.5
        self._free = free * grid.resolution + np.array(grid.origin)
        self._here = Place(correction, SPREAD, 0.0, 0)  # of a robot at the origin of its odometry
        self._begin()
        self._last: Optional[Pose] = None

    def _begin(self) -> None:
        """Try all places, from the next scan on."""
        self._untried = self._free
        self._places: List[Place] = []
        self._here = self._here._replace(score=0.0, scans=0)
        self._way = 0.0

    def observe(self, odometry: Pose, scan: Scan) -> Optional[Estimate]:
        """Use a scan; returns where the robot is, if that is clear.

        Args:
            odometry: pose by odometry when the scan was taken.
            scan: what the laser told.
        """
        last, self._last = self._last, odometry
        movement = odometry if last is None else compose(inverse(last), odometry)
        here = self._here._replace(pose=compose(self._here.pose, movement))
        moved = [place._replace(pose=compose(place.pose, movement)) for place in self._places]
        if is_blind(scan.points):
            self._places, self._here = moved, here
            return None
        if len(self._untried):
            moved += self._tried(scan.points)
        elif last is not None:
            self._way += math.hypot(movement.x, movement.y)
        self._places, self._here = _best([self._matched(place, scan) for place in moved]), self._matched(here, scan)
        return self._clear()

    def _tried(self, ends: Array) -> List[Place]:
        """The best of some places that were not tried yet."""
        now, self._untried = self._untried[:AT_ONCE], self._untried[AT_ONCE:]
        grid, turns = self._grid, np.arange(HEADINGS) * (2.0 * math.pi / HEADINGS)
        scores = np.empty((HEADINGS, len(now)))
        compiled_matching.look_around(np.zeros(3), thinned(ends, BEAMS), grid.field, *grid.origin, grid.resolution, now,
                                      turns, WIDTH, scores)
        best = np.argsort(-scores, axis=None, kind='stable')[:KEPT]
        rows, columns = np.unravel_index(best, scores.shape)
        poses = np.column_stack([now[columns], turns[rows]]).tolist()
        return [Place(Pose(x, y, wrap_angle(theta)), SPREAD, 0.0, 0) for x, y, theta in poses]

    def _matched(self, place: Place, scan: Scan) -> Place:
        """Where a scan fits near a place."""
        few, noise = thinned(scan.points, MATCHED), self._noise
        found = self._grid.matched(place.pose, SPREAD, few, noise.kernels(few, scan.laser), noise.steps, 1.0)
        score = found.fit - WRONG * self._grid.share_wrong(found.pose, scan, noise)
        return Place(found.pose, found.covariance, place.score + score, place.scans + 1)

    def _clear(self) -> Optional[Estimate]:
        """The place, if all were tried, enough was seen, and it is far better than the others."""
        if len(self._untried) or self._here.scans < SCANS or self._way < WAY:
            return None
        best, other, *_ = [place.mean for place in self._places] + 2 * [-math.inf]
        if self._here.mean >= max(FITS, best - MARGIN):
            return _estimate(self._here)
        if best >= FITS and other <= best - MARGIN and self._places[0].scans >= SCANS:
            return _estimate(self._places[0])
        if best < HARDLY:
            self._begin()
        return None


def _estimate(place: Place) -> Estimate:
    """A place that was chosen."""
    return Estimate(place.pose, place.covariance, place.mean, True)


def _best(places: List[Place]) -> List[Place]:
    """The best places, the best first, of which none is near another."""
    kept: List[Place] = []
    for place in sorted(places, key=lambda each: -each.mean):
        if len(kept) < KEPT and all(_are_apart(place.pose, other.pose) for other in kept):
            kept.append(place)
    return kept


def _are_apart(one: Pose, other: Pose) -> bool:
    return (math.hypot(one.x - other.x, one.y - other.y) > APART[0]
            or abs(wrap_angle(one.theta - other.theta)) > APART[1])
