"""What the window remembers of a robot's way: the path that it drove, and where it was a moment ago."""

import itertools
import math
from typing import Optional

import numpy as np

from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_viewer.scene.snapshot import Path

STEP = 0.02  # [m] nearer points are left out
LEAP = 0.5  # [m] between two readings: somebody put the robot elsewhere
MOST_POINTS = 40_000  # then every second one of the older half is dropped
GLIDE = 0.5  # [s] between two readings; after more of them the robot leaps


class Trail:
    """The path of one robot."""

    _numbers = itertools.count()

    def __init__(self) -> None:
        """Begin with none."""
        self._points = np.empty((1024, 2))
        self.clear()

    def clear(self) -> None:
        """Forget it."""
        self._count = 0
        self._last: Optional[Pose] = None
        self._number = next(self._numbers)
        self._points = np.empty((1024, 2))  # another array: a snapshot may still show the old one

    @property
    def path(self) -> Path:
        """The path so far; what is added later does not change it."""
        return Path(self._points[:self._count], self._number)

    def add(self, pose: Pose) -> None:
        """The robot is here now."""
        last = self._last
        way = math.inf if last is None else math.hypot(pose.x - last.x, pose.y - last.y)
        if way < STEP:
            return
        if last is not None and way > LEAP:
            self._append(math.nan, math.nan)
        self._append(pose.x, pose.y)
        self._last = pose

    def _append(self, x: float, y: float) -> None:
        if self._count == MOST_POINTS:
            self._thin()
        if self._count == len(self._points):
            self._points = np.concatenate([self._points, np.empty_like(self._points)])
        self._points[self._count] = x, y
        self._count += 1

    def _thin(self) -> None:
        half = MOST_POINTS // 2
        older, newer = self._points[:half], self._points[half:self._count]
        keep = np.isnan(older[:, 0])
        keep[::2] = True
        points = np.concatenate([older[keep], newer])
        self._count, self._number = len(points), next(self._numbers)
        self._points = points


class Glide:
    """Lets a robot glide from reading to reading, one reading late, where they come more seldom than pictures."""

    def __init__(self) -> None:
        """Begin without any reading."""
        self._before: Optional[Pose] = None
        self._last: Optional[Pose] = None
        self._came = self._period = 0.0

    def add(self, pose: Pose, now: float) -> None:
        """A reading came at a time of the wall clock [s]."""
        before = self.at(now)
        self._period = now - self._came
        self._before, self._last, self._came = before, pose, now
        if before is None or self._period > GLIDE or math.hypot(pose.x - before.x, pose.y - before.y) > LEAP:
            self._before = pose

    def is_under_way(self, now: float) -> bool:
        """Whether it is not yet where the last reading says."""
        return self._before != self._last and now < self._came + self._period

    def at(self, now: float) -> Optional[Pose]:
        """Where to show the robot at a time [s]; None before the first reading."""
        before, last = self._before, self._last
        if before is None or last is None or not self.is_under_way(now):
            return last
        share = (now - self._came) / self._period
        return Pose(before.x + share * (last.x - before.x), before.y + share * (last.y - before.y),
                    wrap_angle(before.theta + share * wrap_angle(last.theta - before.theta)))
