"""Follows a route: pure pursuit along lines and bends, turns on the spot at hairpins.

Pure pursuit steers along the circle that is tangent to the robot's heading and meets the route a little ahead
(R. C. Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01, 1992).

`Follower` and `Turn` are controllers, not behaviours: each is made for one route or one heading, answers a velocity for
a pose, and is thrown away at the end.
"""

import math
from typing import List, Optional, Tuple

import numpy as np

from rumba_cleaning.behaviours import compiled_follower
from rumba_cleaning.behaviours.compiled_follower import DISTANCE, LEAST_AHEAD, V, W, Drive, Piece
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.robot_config import DriveConfig

# Our choice; `compiled_follower` has what concerns the way along a piece.
LOST = 0.35  # [m] off the route: twice the robot's radius; it cannot slip so far, somebody moved it
LEAST_DT = 0.02  # [s]: one tick of a simulator at 50 Hz
HEADING = 0.02  # [rad] so near its heading a turn is done ...
AT_REST = 0.005  # [rad] ... if the robot turned by less since the last look


class Follower:
    """Drives a robot along a route.

    Attributes:
        is_done: the end is reached.
        is_lost: the robot is far off the route; a new one is needed.
    """

    def __init__(self, route: Route, drive: DriveConfig) -> None:
        """Follow a route of two waypoints or more with a drive's limits."""
        self._drive = drive_of(drive)
        self._pieces = _pieces(route, self._drive)
        self._state = compiled_follower.start(0.0, 0.0)  # on the first piece
        self.is_done = not self._pieces
        self.is_lost = False
        self._after = sum(_length(piece) for piece in self._pieces[1:])

    @property
    def remaining(self) -> float:
        """Distance left to the end [m]."""
        return self._after + _length(self._pieces[0]) - self._distance if self._pieces else 0.0

    @property
    def speed(self) -> float:
        """Speed of the route where the robot is [m/s]; 0 at its end."""
        return float(self._pieces[0].speeds[self._leg]) if self._pieces else 0.0

    @property
    def _distance(self) -> float:
        """Driven along the first piece [m]."""
        return float(self._state[DISTANCE])

    @property
    def _leg(self) -> int:
        """The leg of the first piece on which the robot is."""
        return compiled_follower.leg_at(self._pieces[0].lengths, self._distance)

    def ahead(self, length: float) -> Array:
        """Points on the next part of the route, up to a length, or a hairpin: float64 (any, 2) [m]."""
        if not self._pieces:
            return np.empty((0, 2))
        piece = self._pieces[0]
        ends = min(self._distance + length, _length(piece))
        along = np.append(np.arange(self._distance, ends, LEAST_AHEAD), ends)
        return np.stack([np.interp(along, piece.lengths, piece.waypoints[:, axis]) for axis in range(2)], axis=-1)

    def rest(self) -> Optional[Route]:
        """What is left of the route, from the next waypoint on; None if nothing is left."""
        if not self._pieces:
            return None
        first = self._leg + 1
        waypoints = [self._pieces[0].waypoints[first:], *(piece.waypoints[1:] for piece in self._pieces[1:])]
        speeds = [self._pieces[0].speeds[first:], *(piece.speeds for piece in self._pieces[1:])]
        return Route(np.concatenate(waypoints), np.concatenate(speeds))

    def rest_from_here(self) -> Optional[Route]:
        """What is left of the route, from the point on it that was reached; None if nothing is left."""
        rest = self.rest()
        if rest is None:
            return None
        here = np.array([compiled_follower.at(self._pieces[0], self._distance)])
        return Route(np.concatenate([here, rest.waypoints]), np.concatenate([[self.speed], rest.speeds]))

    def velocity(self, pose: Pose, dt: float) -> Tuple[float, float]:
        """Velocity forward [m/s] and counter-clockwise [rad/s] that leads along the route from a pose.

        Args:
            pose: where the robot is.
            dt: time until the next call, by the time since the last one [s].
        """
        while self._pieces:
            is_at_end, off = compiled_follower.follow_flat(*self._pieces[0], *self._drive, self._state, *pose,
                                                           max(dt, LEAST_DT))
            self.is_lost = off > LOST
            if not is_at_end:
                return float(self._state[V]), float(self._state[W])
            del self._pieces[0]
            self._state = compiled_follower.start(self._state[V], self._state[W])
            self._after = sum(_length(piece) for piece in self._pieces[1:])
        self.is_done = True
        return 0.0, 0.0


def drive_of(config: DriveConfig) -> Drive:
    """The limits of a drive, for compiled code."""
    return Drive(config.max_speed, config.max_turn_rate, config.acceleration, config.wheel_base, config.dead_band)


def _length(piece: Piece) -> float:
    return float(piece.lengths[-1])


def turn_rate(angle: float, dt: float, drive: DriveConfig) -> float:
    """The rate [rad/s] at which to turn on the spot while an angle [rad] is left, so as to stop at its end."""
    return compiled_follower.turn_rate(angle, dt, drive_of(drive))


class Turn:
    """Turns a robot to a heading on the spot, until it is at rest there.

    Attributes:
        is_done: the heading is reached, and the robot has stopped turning.
    """

    def __init__(self, heading: float, drive: DriveConfig) -> None:
        """Turn to a heading [rad], in the frame of the poses, with a drive's limits."""
        self.heading = heading
        self._drive = drive
        self._last = math.inf
        self.is_done = False

    def rate(self, pose: Pose, dt: float) -> float:
        """Turn rate for now [rad/s], counter-clockwise."""
        angle = wrap_angle(self.heading - pose.theta)
        is_there, is_at_rest = abs(angle) < HEADING, abs(pose.theta - self._last) < AT_REST
        self._last = pose.theta
        self.is_done = is_there and is_at_rest
        return 0.0 if is_there else turn_rate(angle, max(dt, LEAST_DT), self._drive)


def _pieces(route: Route, drive: Drive) -> List[Piece]:
    """The parts of a route between its hairpins."""
    waypoints, speeds = (np.ascontiguousarray(each, np.float64) for each in route)
    kept, cuts = compiled_follower.split(waypoints)
    return [compiled_follower.piece_of(waypoints[part], speeds[part[1:] - 1], drive)
            for part in (kept[first:last + 1] for first, last in zip(cuts, cuts[1:]))]
