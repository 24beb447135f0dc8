"""What the window remembers of a robot's motion: the path that it drove, and where it was a moment ago."""

import itertools
import math
import threading
from typing import NamedTuple, Optional

import numpy as np

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_viewer.scene.snapshot import Path

STEP = 0.02  # [m] points that are nearer to the last one are left out
JUMP = 0.5  # [m] between two readings: the robot was put elsewhere
MAX_POINTS = 40_000  # then every second one of the older half is dropped
GLIDE = 0.5  # [s] between two readings; if it is longer, the robot jumps to the new one


class Trail:
    """The path of one robot. Several threads may extend, clear and read it at the same time."""

    _numbers = itertools.count()

    def __init__(self) -> None:
        """Start with an empty path."""
        self._lock = threading.Lock()
        self._points = np.empty((1024, 2))
        self.clear()

    def clear(self) -> None:
        """Forget the path."""
        with self._lock:
            self._count = 0
            self._last: Optional[Pose] = None
            self._number = next(self._numbers)
            self._points = np.empty((1024, 2))  # another array: a snapshot may still show the old one

    @property
    def path(self) -> Path:
        """The path so far; what is added later does not change it."""
        with self._lock:
            return Path(self._points[:self._count], self._number)

    def add(self, pose: Pose) -> None:
        """Extend the path to the pose where the robot is now."""
        with self._lock:
            last = self._last
            distance = math.inf if last is None else math.hypot(pose.x - last.x, pose.y - last.y)
            if distance < STEP:
                return
            if last is not None and distance > JUMP:
                self._append(math.nan, math.nan)
            self._append(pose.x, pose.y)
            self._last = pose

    def _append(self, x: float, y: float) -> None:
        if self._count == MAX_POINTS:
            self._thin()
        if self._count == len(self._points):
            self._points = np.concatenate([self._points, np.empty_like(self._points)])
        self._points[self._count] = x, y
        self._count += 1

    def _thin(self) -> None:
        half = MAX_POINTS // 2
        older, newer = self._points[:half], self._points[half:self._count]
        keep = np.isnan(older[:, 0])
        keep[::2] = True
        points = np.concatenate([older[keep], newer])
        self._count, self._number = len(points), next(self._numbers)
        self._points = points


class _Segment(NamedTuple):
    """From where to where the robot glides: it begins at a time of the wall clock and takes a period [s]."""

    start: Pose
    end: Pose
    begin: float
    period: float

    def is_under_way(self, now: float) -> bool:
        return self.start != self.end and now < self.begin + self.period

    def at(self, now: float) -> Pose:
        if not self.is_under_way(now):
            return self.end
        start, end, share = self.start, self.end, max(now - self.begin, 0.0) / self.period
        return Pose(start.x + share * (end.x - start.x), start.y + share * (end.y - start.y),
                    wrap_angle(start.theta + share * wrap_angle(end.theta - start.theta)))


class Glide:
    """Moves a robot smoothly from reading to reading, one reading late, if pictures are more frequent than readings.

    One thread adds readings; others may ask at the same time.
    """

    def __init__(self) -> None:
        """Start without a reading."""
        self._segment: Optional[_Segment] = None  # replaced as a whole, so that no thread sees half of a change

    def add(self, pose: Pose, now: float) -> None:
        """Take a reading that came at a time of the wall clock [s]."""
        last = self._segment
        if last is None:
            self._segment = _Segment(pose, pose, now, 0.0)
            return
        shown, period = last.at(now), now - last.begin
        is_jump = not 0.0 < period <= GLIDE or math.hypot(pose.x - shown.x, pose.y - shown.y) > JUMP
        self._segment = _Segment(pose if is_jump else shown, pose, now, period)

    def is_under_way(self, now: float) -> bool:
        """Whether the robot is not yet shown at the last reading."""
        segment = self._segment
        return segment is not None and segment.is_under_way(now)

    def at(self, now: float) -> Optional[Pose]:
        """Where to show the robot at a time [s]; None before the first reading."""
        segment = self._segment
        return None if segment is None else segment.at(now)
