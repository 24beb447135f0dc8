"""Notices that a robot has come back to where it was long ago, by another way than it went."""

import math
from typing import NamedTuple, Optional, Tuple

import numpy as np

from rumba_localisation.mapping.clear_match import INDEPENDENT, Match, Sought, clear_match
from rumba_localisation.mapping.key_frames import KeyFrames
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan, is_blind
from rumba_sim.model.common.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array

# All these are our choice:
LOOP = 12.0  # [m] of way along links from which on frames are old: shorter loops close by matching with the map
DOUBT = 0.05  # [m] of standard deviation along that way, below which no error is looked for: a smaller one looks for it
#               in each room, and missions take longer to compute; a larger one leaves loops open
NEAR = 5.0  # [m] to an old frame, at most: a longer way off, the laser sees too little of the same
PAUSE, REST = 0.4, 2.0  # [m] between two scans that are compared with old ones, if the first needs one that agrees, and
#                         if it does not: nearer ones err alike, and each takes 0.1 s
LOCAL = 4.0  # [m] of way before a scan, from where scans are compared together with it: alone, it sees too little
TURN = 0.2  # [rad] of error that is looked for
DRIFT, LEAST, MOST = 0.06, 0.3, 4.0  # errors that are looked for: share of the way, at least and at most [m]
SAME = (0.2, 0.06)  # [m], [rad] by which two scans may differ on what is wrong
SMALL = (0.03, 0.01)  # [m], [rad] of error that the map bears; smaller ones are not worth a new map


class Found(NamedTuple):
    """Where a key frame is by old ones."""

    old: int  # number of the one among them that is nearest
    frame: int  # its number
    match: Match
    change: Pose  # of the map frame, that would correct its pose


class LoopClosure:
    """Compares new key frames with a map of old ones alone; two must agree before frames are moved."""

    def __init__(self, frames: KeyFrames, noise: Noise) -> None:
        """Look after key frames, to which links are added, by the scans of a laser."""
        self._frames, self._noise = frames, noise
        self._tried: Optional[Pose] = None  # where a frame was compared last
        self._doubted: Optional[Found] = None  # which needs another that agrees

    def closes(self, frame: int, scan: Scan, resolution: float) -> bool:
        """Compare the newest key frame with old ones near it, and link them if it fits.

        Args:
            frame: its number.
            scan: that it shows.
            resolution: of maps [m].

        Returns:
            Whether the links contradict each other, so that frames must be moved.
        """
        pose = self._frames.poses[frame]
        if is_blind(scan.points) or self._is_near_the_last(pose):
            return False
        self._tried = pose
        near, ways = self._frames.near(pose.x, pose.y, NEAR), self._frames.ways(frame)
        old = near[ways.lengths[near] > LOOP]
        if not len(old) or self._frames.doubt(ways, int(old[0])) < DOUBT:
            return False
        reach = min(max(DRIFT * float(ways.lengths[old[0]]), LEAST), MOST)
        found = self._found(frame, old, reach, scan, resolution)
        before, self._doubted = self._doubted, None
        if found is None:
            return False
        if _is_small(found.change, pose, SMALL):
            self._link(found)
            return False
        if before is None or not _is_small(compose(found.change, inverse(before.change)), found.match.pose, SAME):
            self._doubted = found
            return False
        self._link(before)
        self._link(found)
        return True

    def _is_near_the_last(self, pose: Pose) -> bool:
        """Whether a frame at a pose would tell what the last one that was compared told."""
        pause, tried = REST if self._doubted is None else PAUSE, self._tried
        return tried is not None and math.hypot(pose.x - tried.x, pose.y - tried.y) < pause

    def _link(self, found: Found) -> None:
        covariance = INDEPENDENT * found.match.covariance  # that is told as too large, with care
        self._frames.link(found.old, found.frame, found.match.pose, covariance, is_robust=True)

    def _found(self, frame: int, old: Array, reach: float, scan: Scan, resolution: float) -> Optional[Found]:
        """Where a key frame is by old ones, as far off as `reach` [m] at most; None if nowhere, or not clear."""
        frames, nearest = self._frames, int(old[0])
        centre, pose = frames.poses[nearest], frames.poses[frame]
        around = np.sort(np.intersect1d(frames.near(centre.x, centre.y, NEAR), old))
        sought = Sought(pose, reach, TURN, frames.cloud(frame, LOCAL), scan)
        best = clear_match(frames.drawn(around, resolution, self._noise), sought, self._noise,
                           None if self._doubted is None else compose(self._doubted.change, pose))
        return None if best is None else Found(nearest, frame, best, compose(best.pose, inverse(pose)))


def _is_small(change: Pose, pose: Pose, most: Tuple[float, float]) -> bool:
    """Whether a change of the map frame moves a pose by no more than a distance [m] and an angle [rad]."""
    moved = compose(change, pose)
    return (math.hypot(moved.x - pose.x, moved.y - pose.y) <= most[0]
            and abs(wrap_angle(moved.theta - pose.theta)) <= most[1])
