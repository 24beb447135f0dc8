"""Follows a route: pure pursuit along lines and bends, turns on the spot at hairpins.

Pure pursuit steers along the circle that touches the robot's heading and meets the route a little ahead
(R. C. Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01, 1992).
"""

import bisect
import itertools
import math
from typing import List, NamedTuple, Optional, Tuple

import numpy as np

from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import DriveConfig

HAIRPIN = 2.6  # [rad] a corner so sharp is driven to, and turned in
AHEAD = 0.5  # [s] how far ahead the pursued place is
LEAST_AHEAD = 0.08  # [m]
BEHIND, BESIDE = 2.0, 0.5  # [rad] off the heading: turn on the spot beyond the first, until within the second
WINDOW = 0.3  # [m] along the route in which the nearest place is looked for
LOST = 0.35  # [m] off the route: somebody put the robot elsewhere
ARRIVED = 0.01  # [m]
STALL = 3.0  # [s] of turning without a step along the route: it bends back to the robot, which spins beside it
CREEP = 0.03  # [m/s] no slower to the end
TENDERNESS = 0.7  # share of the acceleration that is counted on for stopping
SHORTEST = 1e-3  # [m] of a part of a route
LEAST_DT = 0.02  # [s]
HEADING, RESTS = 0.02, 0.005  # [rad] so near a heading, and turned by so little since the last look, a turn is done
SLOWEST = 2.5  # times the rate at which wheels begin to move

Place = Tuple[float, float]


class Route(NamedTuple):
    """Where to drive."""

    places: Array  # float64 (any, 2) [m], map frame
    speeds: Array  # float64 (any - 1) [m/s] from place to place


class _Piece:
    """Part of a route without hairpins: the lengths along it, to each of its places, begin with 0."""

    def __init__(self, places: List[Place], speeds: List[float]) -> None:
        self.places = places
        self.speeds = speeds
        self.steps = [math.hypot(end[0] - start[0], end[1] - start[1]) for start, end in zip(places, places[1:])]
        self.lengths = [0.0, *itertools.accumulate(self.steps)]

    @property
    def length(self) -> float:
        return self.lengths[-1]

    def index(self, way: float) -> int:
        """The part in which a way along it ends."""
        return min(max(bisect.bisect_right(self.lengths, way) - 1, 0), len(self.steps) - 1)

    def at(self, way: float) -> Place:
        """Where a way along it ends; beyond the last place it goes straight on."""
        index = self.index(way)
        share = (way - self.lengths[index]) / self.steps[index]
        (x, y), (to_x, to_y) = self.places[index], self.places[index + 1]
        return x + share * (to_x - x), y + share * (to_y - y)

    def nearest(self, pose: Pose, since: float) -> Tuple[float, float]:
        """Way to the place nearest to a pose, not long after `since`, and how far away that is."""
        best, distance = since, math.inf
        for index in range(self.index(since), len(self.steps)):
            if self.lengths[index] > since + WINDOW:
                break
            (x, y), (to_x, to_y) = self.places[index], self.places[index + 1]
            step = self.steps[index]
            share = ((pose.x - x) * (to_x - x) + (pose.y - y) * (to_y - y)) / (step * step)
            share = min(max(share, (since - self.lengths[index]) / step, 0.0), 1.0)
            off = math.hypot(x + share * (to_x - x) - pose.x, y + share * (to_y - y) - pose.y)
            if off < distance - 1e-9:
                best, distance = self.lengths[index] + share * step, off
        return best, distance


class Follower:
    """Drives a robot along a route.

    Attributes:
        is_done: the end is reached.
        is_lost: the robot is far off the route; a new one is needed.
    """

    def __init__(self, route: Route, drive: DriveConfig) -> None:
        """Follow a route of two places or more with a drive's limits."""
        self._pieces = _pieces(route)
        self._drive = drive
        self._way = 0.0
        self._turned = 0.0  # [s] on the spot, since the last step along the route
        self._is_turning = True
        self.is_done = not self._pieces
        self.is_lost = False
        self._after = sum(piece.length for piece in self._pieces[1:])

    @property
    def remaining(self) -> float:
        """Way left to the end [m]."""
        return self._after + self._pieces[0].length - self._way if self._pieces else 0.0

    def rest(self) -> Optional[Route]:
        """What of the route is left; None where nothing is."""
        if not self._pieces:
            return None
        piece, *others = self._pieces
        first = piece.index(self._way) + 1
        places, speeds = piece.places[first:], piece.speeds[first:]
        for piece in others:
            places, speeds = places + piece.places[1:], speeds + piece.speeds
        return Route(np.array(places), np.array(speeds, np.float64))

    def update(self, pose: Pose, dt: float) -> Tuple[float, float]:
        """Velocity forward [m/s] and counter-clockwise [rad/s] that leads along the route from a pose."""
        dt = max(dt, LEAST_DT)
        while self._pieces:
            piece = self._pieces[0]
            way, off = piece.nearest(pose, self._way)
            self._go_along(way)
            self.is_lost = off > LOST
            left = piece.length - self._way
            if left < SHORTEST or (left < LEAST_AHEAD and math.hypot(
                    piece.places[-1][0] - pose.x, piece.places[-1][1] - pose.y) < ARRIVED):
                self._next_piece()
                continue
            return self._pursue(piece, pose, dt, left)
        self.is_done = True
        return 0.0, 0.0

    def _go_along(self, way: float) -> None:
        if way > self._way + SHORTEST:
            self._turned = 0.0
        self._way = way
        if self._turned > STALL:
            self._turned = 0.0
            self._way = min(way + LEAST_AHEAD, self._pieces[0].length)

    def _next_piece(self) -> None:
        del self._pieces[0]
        self._way = self._turned = 0.0
        self._is_turning = True
        self._after = sum(piece.length for piece in self._pieces[1:])

    def _pursue(self, piece: _Piece, pose: Pose, dt: float, left: float) -> Tuple[float, float]:
        limit = min(piece.speeds[piece.index(self._way)], self._drive.max_speed)
        x, y = piece.at(self._way + max(AHEAD * limit, LEAST_AHEAD))
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


def turn_rate(angle: float, dt: float, drive: DriveConfig) -> float:
    """The rate [rad/s] at which to turn on the spot while an angle [rad] is left, so as to stop there."""
    spin = 2.0 * drive.acceleration / drive.wheel_base  # [rad/s^2]
    slowest = SLOWEST * drive.dead_band / drive.wheel_base
    rate = max(min(drive.max_turn_rate, fastest(abs(angle), dt, spin)), slowest)
    return math.copysign(rate, angle)


def fastest(way: float, dt: float, acceleration: float) -> float:
    """The speed at which one can go on for dt and still stop at the end of a way [m, or rad]."""
    counted = TENDERNESS * acceleration
    return math.sqrt((counted * dt) ** 2 + 2.0 * counted * way) - counted * dt


class Turn:
    """Turns to a heading on the spot, and comes to rest there.

    Attributes:
        is_done: the heading is reached, and the robot turns no more.
    """

    def __init__(self, heading: float, drive: DriveConfig) -> None:
        """Turn to a heading [rad], map frame, or whatever frame the poses are in."""
        self.heading = heading
        self._drive = drive
        self._last = math.inf
        self.is_done = False

    def update(self, pose: Pose, dt: float) -> float:
        """Turn rate [rad/s] for now."""
        angle = wrap_angle(self.heading - pose.theta)
        is_there, rests = abs(angle) < HEADING, abs(pose.theta - self._last) < RESTS
        self._last = pose.theta
        self.is_done = is_there and rests
        return 0.0 if is_there else turn_rate(angle, max(dt, LEAST_DT), self._drive)


def _pieces(route: Route) -> List[_Piece]:
    """The parts of a route between its hairpins."""
    pieces: List[_Piece] = []
    places: List[Place] = [(float(route.places[0][0]), float(route.places[0][1]))]
    speeds: List[float] = []
    heading = 0.0
    for (x, y), speed in zip(route.places[1:].tolist(), route.speeds.tolist()):
        dx, dy = x - places[-1][0], y - places[-1][1]
        if math.hypot(dx, dy) < SHORTEST:
            continue
        if speeds and abs(wrap_angle(math.atan2(dy, dx) - heading)) > HAIRPIN:
            pieces.append(_Piece(places, speeds))
            places, speeds = places[-1:], []
        heading = math.atan2(dy, dx)
        places.append((x, y))
        speeds.append(speed)
    if speeds:
        pieces.append(_Piece(places, speeds))
    return pieces
