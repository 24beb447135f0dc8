"""The way by which a robot came. Back along it, its wheels are on floor that they know, and its body where it fits."""

import math
from typing import List, Optional, Tuple

import numpy as np

from rumba_localisation.edges import JUMP
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.kernel import Array

# All figures below are our choice.
SPACING = 0.01  # [m] of the wheels between poses, about: less than a cell of the floor that is known
LENGTH = 200  # poses that are remembered: two metres straight on, and a robot backs off by 0.15 m
SAME = 0.01  # [m] of the wheels; poses nearer to each other are the same, and the loop between them is left out
RECENT = 20  # poses among which the robot is, as it goes back: it backs off by a few of them from look to look
AHEAD = 3  # poses from there to the one that it heads for: small swerves, large cuts corners
OFF = 0.03  # [m] from the trail, a robot was pushed, or slid: it is not on it any more
AIM = 0.3  # [rad] that it turns to come back onto the trail, at most

Motion = Tuple[float, float]  # forward [m] and counter-clockwise [rad]


class Trail:
    """Poses of a robot on its way, in the frame of its poses."""

    def __init__(self, half: float) -> None:
        """Have no pose of a robot whose wheels are so far off its middle [m]."""
        self._half = half
        self.forget()

    def forget(self) -> None:
        """The robot was put elsewhere, or somebody else drove it."""
        self._poses: List[Pose] = []
        self._has_loops = False

    def note(self, pose: Pose) -> None:
        """Remember a pose of a robot that does not go back."""
        if self._poses:
            last = self._poses[-1]
            away = hypot(pose.x - last.x, pose.y - last.y)
            if away > JUMP:
                self.forget()
            elif away + self._half * abs(wrap_angle(pose.theta - last.theta)) < SPACING:
                return
        self._poses.append(pose)
        self._has_loops = True
        if len(self._poses) >= 2 * LENGTH:
            del self._poses[:LENGTH]

    def back(self, pose: Pose) -> Optional[Motion]:
        """The next motion back along the trail, from a pose on it; None: there is no more of it.

        What the robot has left behind is forgotten.
        """
        if self._has_loops:
            self._leave_out_loops()
        poses = np.array(self._poses[-RECENT:])
        if len(poses) < 2:
            return None
        away = self._away(poses, pose)
        nearest = int(np.argmin(away))
        del self._poses[len(self._poses) - len(poses) + nearest + 1:]
        target = Pose(*poses[max(nearest - AHEAD, 0)].tolist())
        if away[nearest] > OFF or self._away(np.array([target]), pose)[0] < SAME:
            self.forget()
            return None
        return _motion(pose, target)

    def _leave_out_loops(self) -> None:
        """Have each place on the trail once: a robot that came back to it need not go where it was meanwhile."""
        poses, kept, index = np.array(self._poses), [], len(self._poses) - 1
        while index >= 0:
            kept.append(self._poses[index])
            same = np.flatnonzero(self._away(poses[:index], poses[index]) < SAME)
            index = int(same[0]) - 1 if len(same) else index - 1
        self._poses = kept[::-1]
        self._has_loops = False

    def _away(self, poses: Array, pose: Pose) -> Array:
        """How far a wheel at most moves from one of the poses (any, 3) to another pose, about [m]: float64 (any)."""
        x, y, turn = (poses - pose).T
        return np.asarray(np.hypot(x, y) + self._half * np.abs(np.arctan2(np.sin(turn), np.cos(turn))))


def _motion(pose: Pose, target: Pose) -> Motion:
    """How to drive from a pose to another one nearby: on the arc to its heading, turned a little to meet its place."""
    dx, dy, turn = target.x - pose.x, target.y - pose.y, wrap_angle(target.theta - pose.theta)
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    ahead, aside = dx * cos + dy * sin, dy * cos - dx * sin
    if abs(ahead) > SAME:
        turn += min(max(2.0 * aside / ahead - turn, -AIM), AIM)
    return ahead, turn
