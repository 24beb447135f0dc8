"""The scans that a map shows, where they were taken, and how one was found from another."""

import math
from typing import Dict, List, NamedTuple, Tuple

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from rumba_localisation.compiled_matrices import inverse as inverted
from rumba_localisation.mapping.grids.grid import Grid, ends_of, placed
from rumba_localisation.mapping.pose_graph import Link, optimised
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan
from rumba_localisation.systematic import lengthened
from rumba_sim.model.common.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array


class Ways(NamedTuple):
    """The shortest ways from a frame to all, along links."""

    lengths: Array  # float64 (frames) [m]
    before: Array  # int32 (frames), the number before each frame on its way; negative if there is none


class KeyFrames:
    """Scans with their poses, which links connect: they grow with the area of the map, as scans are added to that.

    Attributes:
        poses: of the laser, map frame.
    """

    def __init__(self) -> None:
        """Have none."""
        self.poses: List[Pose] = []
        self._scans: List[Scan] = []
        self._links: List[Link] = []
        self._variances: Dict[Tuple[int, int], Tuple[float, float]] = {}  # of place [m^2] and heading, by both ends
        self._before: List[Pose] = []  # poses before the newest `optimise`

    def add(self, pose: Pose, scan: Scan) -> int:
        """Keep a scan; returns its number."""
        self.poses.append(pose)
        self._scans.append(scan._replace(points=scan.points.astype(np.float32), beyond=scan.beyond.astype(np.float32)))
        return len(self.poses) - 1

    def link(self, one: int, other: int, pose: Pose, covariance: Array, is_robust: bool = False) -> None:
        """Remember where a frame was found from another.

        Args:
            one: number of the frame from which it was found.
            other: its own number.
            pose: where it was found, map frame.
            covariance: float64 (3, 3) of that, map frame.
            is_robust: whether that may be wrong.
        """
        frame = self.poses[one]
        cos, sin = math.cos(frame.theta), math.sin(frame.theta)
        turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
        information = inverted(turn @ covariance @ turn.T)
        self._links.append(Link(one, other, compose(inverse(frame), pose), information, is_robust))
        self._variances[min(one, other), max(one, other)] = float(covariance[0, 0] + covariance[1, 1]), float(
            covariance[2, 2])

    def near(self, x: float, y: float, distance: float) -> Array:
        """Numbers of the frames within a distance of a point [m], the nearest first: int64 (any)."""
        away = self._away(x, y)
        order = np.argsort(away, kind='stable')
        return order[away[order] < distance]

    def nearest(self, x: float, y: float) -> int:
        """Number of the frame that is nearest to a point [m]."""
        return int(np.argmin(self._away(x, y)))

    def _away(self, x: float, y: float) -> Array:
        poses = np.array(self.poses)
        return np.hypot(poses[:, 0] - x, poses[:, 1] - y)

    def ways(self, frame: int) -> Ways:
        """The shortest ways along links from a frame to all."""
        count, poses = len(self.poses), np.array(self.poses)
        one, other = (np.array([link[end] for link in self._links], np.int64) for end in (0, 1))
        lengths = np.hypot(*(poses[one, :2] - poses[other, :2]).T) + 1e-6  # a 0 would be no link
        matrix = sparse.coo_matrix((lengths, (one, other)), shape=(count, count)).tocsr()
        return Ways(*csgraph.dijkstra(matrix, directed=False, indices=frame, return_predecessors=True))

    def doubt(self, ways: Ways, frame: int) -> float:
        """Standard deviation of where the beginning of a way is, seen from a frame at its end [m].

        Errors of headings add up, and move what is far away: by a third of the square of the way, as on a straight one.
        """
        places, headings, number = 0.0, 0.0, frame
        while ways.before[number] >= 0:
            before = int(ways.before[number])
            place, heading = self._variances[min(before, number), max(before, number)]
            places, headings, number = places + place, headings + heading, before
        return math.sqrt(places + headings * float(ways.lengths[frame]) ** 2 / 3.0)

    def cloud(self, frame: int, way: float) -> Array:
        """Where beams of a frame and of those before it ended, back to a way [m]: float64 (any, 2), in its frame."""
        pose, found, left = self.poses[frame], [], way
        for number in range(frame, -1, -1):
            other = self.poses[number]
            if number < frame:
                left -= math.hypot(other.x - self.poses[number + 1].x, other.y - self.poses[number + 1].y)
            if left < 0.0:
                break
            found.append(placed(compose(inverse(pose), other), self._scan(number).points))
        return np.concatenate(found)

    def _scan(self, number: int) -> Scan:
        scan = self._scans[number]
        return scan._replace(points=scan.points.astype(np.float64), beyond=scan.beyond.astype(np.float64))

    def lengthen(self, by: float) -> None:
        """Make all beams longer by a length [m]."""
        for number in range(len(self._scans)):
            points, beyond, laser = lengthened(self._scan(number), by)
            self._scans[number] = Scan(points.astype(np.float32), beyond.astype(np.float32), laser)

    def drawn(self, numbers: Array, resolution: float, noise: Noise) -> Grid:
        """A map of some of the scans alone, with cells of a side [m], by the noise of their laser."""
        grid = Grid(resolution)
        shown = [(self.poses[number], self._scan(number)) for number in numbers.tolist()]
        # At once: each time that it grows all cells are copied.
        grid.cover(np.concatenate([ends for pose, scan in shown for ends in ends_of(pose, scan)]))
        for pose, scan in shown:
            grid.add(pose, scan, noise)
        grid.measure()
        return grid

    def optimise(self) -> None:
        """Move all frames but the first so that they satisfy all links as well as possible."""
        self._before = self.poses
        self.poses = [Pose(x, y, wrap_angle(theta))
                      for x, y, theta in optimised(np.array(self.poses), self._links).tolist()]

    def moved(self, pose: Pose) -> Pose:
        """Where what was at a pose before the newest `optimise` is now: it stays at the frame that was nearest."""
        before = np.array(self._before)
        nearest = int(np.argmin(np.hypot(before[:, 0] - pose.x, before[:, 1] - pose.y)))
        return compose(self.poses[nearest], compose(inverse(self._before[nearest]), pose))
