"""Follows a route: pure pursuit along lines and bends, turns on the spot at hairpins.

Pure pursuit steers along the circle that is tangent to the robot's heading and meets the route a little ahead
(R. C. Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01, 1992).

`Follower` and `Turn` are controllers, not behaviours: each is made for one route or one heading, answers a velocity for
a pose, and is thrown away at the end.
"""

import bisect
import itertools
import math
from typing import List, Optional, Tuple

import numpy as np

from rumba_cleaning.behaviours.compiled_follower import nearest
from rumba_cleaning.route import Route
from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import DriveConfig

# "Time" below is what boustrophedon took to 99 % of the maps studio and apartment in rumba_evaluation, before it slowed
# down for bends. Where nothing is said of time, a figure is our choice.
HAIRPIN = 2.6  # [rad] a corner as sharp as this is driven to its end, and turned in; 1.5 costs 5 % more time
AHEAD = 0.3  # [s] how far ahead the pursued point is, at the speed of the route: small swerves, large cuts corners and
#              leaves a rim along the walls, so that the last 1 % of a floor takes twice as long with 0.45
LAG = 0.075  # [s] that the wheels are behind the command, about: without it, so small an AHEAD swerves
LEAST_AHEAD = 0.06  # [m] the same, at least: a third of the brush
# [rad] off the heading: turn on the spot beyond the first, until within the second; half or twice as much costs no time
BEHIND, BESIDE = 2.0, 0.5
WINDOW = 0.3  # [m] along the route in which the nearest point is looked for; 0.6 costs up to 15 % more time
LOST = 0.35  # [m] off the route: twice the robot's radius; it cannot slip so far, somebody moved it
ARRIVED = 0.01  # [m]: half a cell of a fine map
STALL = 3.0  # [s] of turning without progress along the route, longer than any turn takes: the robot circles a bend
CREEP = 0.03  # [m/s] not slower than this, so that the robot reaches the end
STOPPING = 0.7  # share of the acceleration that is counted on for stopping, the rest makes up for late commands; 0.4
#                 makes no difference to the time, 1.0 costs up to 8 %
SHORTEST = 1e-3  # [m] of a leg of a route; a shorter one has no direction
SAMPLE = 0.02  # [m] along a route between the points for which a speed is found: as far as the waypoints of a ring
BEND = 0.1  # [m] before and behind a point, that show how sharp a bend is: small sees corners, large sees bends
BENDING = 2.5  # times the largest turn rate that a bend would take at its speed, if it were driven exactly; small cuts
#                fewer corners, large loses less time
SLOWEST_BEND = 0.08  # [m/s] in a bend, however sharp it is: small cuts fewer corners, large loses less time
SLOWING = 0.6  # share of the acceleration that is counted on for slowing down before a bend
LEAST_DT = 0.02  # [s]: one tick of a simulator at 50 Hz
HEADING = 0.02  # [rad] so near its heading a turn is done ...
AT_REST = 0.005  # [rad] ... if the robot turned by less since the last look
SLOWEST = 2.5  # times the rate at which wheels begin to move: well clear of the dead band

Point = Tuple[float, float]


class _Piece:
    """Part of a route without hairpins; `lengths` are those along it from its first waypoint to each of them [m]."""

    def __init__(self, waypoints: List[Point], speeds: List[float], drive: DriveConfig) -> None:
        self.waypoints = waypoints
        self.speeds = speeds
        self.legs = [math.hypot(end[0] - start[0], end[1] - start[1]) for start, end in zip(waypoints, waypoints[1:])]
        self.lengths = [0.0, *itertools.accumulate(self.legs)]
        self._corners, self._legs, self._lengths = np.array(waypoints), np.array(self.legs), np.array(self.lengths)
        self._limits = _limits(self._corners, np.array(speeds), self._lengths, drive)

    def speed_at(self, distance: float) -> float:
        """The speed at a distance along the piece [m] from which the robot can still slow down for the bends ahead."""
        index = min(int(distance / SAMPLE), len(self._limits) - 1)
        return float(self._limits[index])

    @property
    def length(self) -> float:
        return self.lengths[-1]

    def index(self, distance: float) -> int:
        """The leg that a distance along the piece [m] leads to."""
        return min(max(bisect.bisect_right(self.lengths, distance) - 1, 0), len(self.legs) - 1)

    def at(self, distance: float) -> Point:
        """The point at a distance along the piece [m]; beyond the last waypoint it goes straight on."""
        index = self.index(distance)
        share = (distance - self.lengths[index]) / self.legs[index]
        (x, y), (to_x, to_y) = self.waypoints[index], self.waypoints[index + 1]
        return x + share * (to_x - x), y + share * (to_y - y)

    def nearest(self, pose: Pose, since: float) -> Tuple[float, float]:
        """Distance along the piece to the point nearest to a pose, not long after `since`, and how far off it is."""
        return nearest(self._corners, self._legs, self._lengths, self.index(since), pose.x, pose.y, since, WINDOW)


class Follower:
    """Drives a robot along a route.

    Attributes:
        is_done: the end is reached.
        is_lost: the robot is far off the route; a new one is needed.
    """

    def __init__(self, route: Route, drive: DriveConfig) -> None:
        """Follow a route of two waypoints or more with a drive's limits."""
        self._pieces = _pieces(route, drive)
        self._drive = drive
        self._distance = 0.0  # [m] driven along the first piece
        self._turned = 0.0  # [s] on the spot, since the last progress along the route
        self._is_turning = True
        self._command = 0.0, 0.0  # [m/s, rad/s] the last one
        self.is_done = not self._pieces
        self.is_lost = False
        self._after = sum(piece.length for piece in self._pieces[1:])

    @property
    def remaining(self) -> float:
        """Distance left to the end [m]."""
        return self._after + self._pieces[0].length - self._distance if self._pieces else 0.0

    @property
    def speed(self) -> float:
        """Speed of the route where the robot is [m/s]; 0 at its end."""
        return self._pieces[0].speeds[self._pieces[0].index(self._distance)] if self._pieces else 0.0

    def ahead(self, length: float) -> Array:
        """Points on the next part of the route, up to a length, or a hairpin: float64 (any, 2) [m]."""
        if not self._pieces:
            return np.empty((0, 2))
        piece = self._pieces[0]
        ends = min(self._distance + length, piece.length)
        along = np.append(np.arange(self._distance, ends, LEAST_AHEAD), ends)
        return np.array([piece.at(distance) for distance in along.tolist()])

    def rest(self) -> Optional[Route]:
        """What is left of the route, from the next waypoint on; None if nothing is left."""
        if not self._pieces:
            return None
        piece, *others = self._pieces
        first = piece.index(self._distance) + 1
        waypoints, speeds = piece.waypoints[first:], piece.speeds[first:]
        for piece in others:
            waypoints, speeds = waypoints + piece.waypoints[1:], speeds + piece.speeds
        return Route(np.array(waypoints), np.array(speeds, np.float64))

    def rest_from_here(self) -> Optional[Route]:
        """What is left of the route, from the point on it that was reached; None if nothing is left."""
        rest = self.rest()
        if rest is None:
            return None
        piece = self._pieces[0]
        here = np.array([piece.at(self._distance)])
        speed = piece.speeds[piece.index(self._distance)]
        return Route(np.concatenate([here, rest.waypoints]), np.concatenate([[speed], rest.speeds]))

    def velocity(self, pose: Pose, dt: float) -> Tuple[float, float]:
        """Velocity forward [m/s] and counter-clockwise [rad/s] that leads along the route from a pose.

        Args:
            pose: where the robot is.
            dt: time until the next call, by the time since the last one [s].
        """
        dt = max(dt, LEAST_DT)
        while self._pieces:
            piece = self._pieces[0]
            distance, off = piece.nearest(pose, self._distance)
            self._go_along(distance)
            self.is_lost = off > LOST
            left = piece.length - self._distance
            if left < SHORTEST or (left < LEAST_AHEAD and math.hypot(
                    piece.waypoints[-1][0] - pose.x, piece.waypoints[-1][1] - pose.y) < ARRIVED):
                self._next_piece()
                continue
            self._command = self._pursue(piece, _after(pose, self._command, LAG), dt, left)
            return self._command
        self.is_done = True
        return 0.0, 0.0

    def _go_along(self, distance: float) -> None:
        if distance > self._distance + SHORTEST:
            self._turned = 0.0
        self._distance = distance
        if self._turned > STALL:
            self._turned = 0.0
            self._distance = min(distance + LEAST_AHEAD, self._pieces[0].length)

    def _next_piece(self) -> None:
        del self._pieces[0]
        self._distance = self._turned = 0.0
        self._is_turning = True
        self._after = sum(piece.length for piece in self._pieces[1:])

    def _pursue(self, piece: _Piece, pose: Pose, dt: float, left: float) -> Tuple[float, float]:
        distance, _ = piece.nearest(pose, self._distance)
        limit = piece.speed_at(distance)
        limit = min(limit, piece.speed_at(distance + limit * dt))
        x, y = piece.at(distance + max(AHEAD * limit, LEAST_AHEAD))
        bearing = wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)
        if abs(bearing) > (BESIDE if self._is_turning else BEHIND):
            self._is_turning = True
            self._turned += dt
            return 0.0, turn_rate(bearing, dt, self._drive)
        self._is_turning = False
        curvature = 2.0 * math.sin(bearing) / max(math.hypot(x - pose.x, y - pose.y), 0.5 * LEAST_AHEAD)
        v = min(limit, self._drive.max_turn_rate / max(abs(curvature), 1e-6))
        v = min(v, max(fastest(left, dt, self._drive.acceleration), CREEP))
        return v, v * curvature


def _after(pose: Pose, command: Tuple[float, float], seconds: float) -> Pose:
    """Where a robot is after a short time [s] at a velocity [m/s, rad/s]."""
    (v, w), middle = command, pose.theta + 0.5 * command[1] * seconds
    return Pose(pose.x + v * seconds * math.cos(middle), pose.y + v * seconds * math.sin(middle),
                pose.theta + w * seconds)


def turn_rate(angle: float, dt: float, drive: DriveConfig) -> float:
    """The rate [rad/s] at which to turn on the spot while an angle [rad] is left, so as to stop at its end."""
    spin = 2.0 * drive.acceleration / drive.wheel_base  # [rad/s^2]
    slowest = SLOWEST * drive.dead_band / drive.wheel_base
    rate = max(min(drive.max_turn_rate, fastest(abs(angle), dt, spin)), slowest)
    return math.copysign(rate, angle)


def fastest(distance: float, dt: float, acceleration: float) -> float:
    """The speed that can be kept for dt with time to stop afterwards within a distance [m, or rad]."""
    counted = STOPPING * acceleration
    return math.sqrt((counted * dt) ** 2 + 2.0 * counted * distance) - counted * dt


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


def _pieces(route: Route, drive: DriveConfig) -> List[_Piece]:
    """The parts of a route between its hairpins."""
    pieces: List[_Piece] = []
    waypoints: List[Point] = [(float(route.waypoints[0][0]), float(route.waypoints[0][1]))]
    speeds: List[float] = []
    heading = 0.0
    for (x, y), speed in zip(route.waypoints[1:].tolist(), route.speeds.tolist()):
        dx, dy = x - waypoints[-1][0], y - waypoints[-1][1]
        if math.hypot(dx, dy) < SHORTEST:
            continue
        if speeds and abs(wrap_angle(math.atan2(dy, dx) - heading)) > HAIRPIN:
            pieces.append(_Piece(waypoints, speeds, drive))
            waypoints, speeds = waypoints[-1:], []
        heading = math.atan2(dy, dx)
        waypoints.append((x, y))
        speeds.append(speed)
    if speeds:
        pieces.append(_Piece(waypoints, speeds, drive))
    return pieces


def _limits(waypoints: Array, speeds: Array, lengths: Array, drive: DriveConfig) -> Array:
    """Speeds at samples along a piece, with time to slow down before its bends: float64 (any) [m/s].

    Args:
        waypoints: float64 (any, 2) [m].
        speeds: on the legs between them, at most, float64 (any - 1) [m/s].
        lengths: along the piece from its first waypoint to each of them, float64 (any) [m].
        drive: limits of the drive.
    """
    along = np.arange(0.0, lengths[-1] + SAMPLE, SAMPLE)
    x, y = (np.stack([np.interp(along + off, lengths, waypoints[:, axis]) for off in (-BEND, 0.0, BEND)])
            for axis in (0, 1))
    turn = np.abs(np.diff(np.arctan2(np.diff(y, axis=0), np.diff(x, axis=0)), axis=0)[0])
    turn = np.minimum(turn, 2.0 * math.pi - turn)
    turn[(along < 0.5 * BEND) | (along > lengths[-1] - 0.5 * BEND)] = 0.0
    legs = np.clip(np.searchsorted(lengths, along, side='right') - 1, 0, len(speeds) - 1)
    limits = np.minimum(np.minimum(speeds[legs], drive.max_speed),
                        np.maximum(BENDING * drive.max_turn_rate * BEND / np.maximum(turn, 1e-9), SLOWEST_BEND))
    twice = 2.0 * SLOWING * drive.acceleration
    squares = limits ** 2 + twice * along
    return np.asarray(np.minimum(limits, np.sqrt(np.minimum.accumulate(squares[::-1])[::-1] - twice * along)))
