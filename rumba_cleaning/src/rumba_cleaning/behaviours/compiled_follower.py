"""How a robot follows one piece of a route, compiled by numba: for the robot, and for a rehearsal of the route.

Arguments that many functions share:
    piece: what is followed.
    drive: limits of the wheels.
    state: float64 (5), how far the robot has come; `start` makes it, and `follow` changes it.
"""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

# "Time" below is what boustrophedon took to 99 % of the maps studio and apartment in rumba_evaluation, before it slowed
# down for bends. Where nothing is said of time, a figure is our choice.
AHEAD = 0.3  # [s] how far ahead the pursued point is, at the speed of the route: small swerves, large cuts corners and
#              leaves a rim along the walls, so that the last 1 % of a floor takes twice as long with 0.45
LAG = 0.075  # [s] that the wheels are behind the command, about: without it, so small an AHEAD swerves
LEAST_AHEAD = 0.06  # [m] the same, at least: a third of the brush
# [rad] off the heading: turn on the spot beyond the first, until within the second; half or twice as much costs no time
BEHIND, BESIDE = 2.0, 0.5
HAIRPIN = 2.6  # [rad] a corner as sharp as this is driven to its end, and turned in; 1.5 costs 5 % more time
WINDOW = 0.3  # [m] along the route in which the nearest point is looked for; 0.6 costs up to 15 % more time
ARRIVED = 0.01  # [m]: half a cell of a fine map
STALL = 3.0  # [s] of turning without progress along the route, longer than any turn takes: the robot circles a bend
CREEP = 0.03  # [m/s] not slower than this, so that the robot reaches the end
STOPPING = 0.7  # share of the acceleration that is counted on for stopping, the rest makes up for late commands; 0.4
#                 makes no difference to the time, 1.0 costs up to 8 %
SHORTEST = 1e-3  # [m] of a leg of a route; a shorter one has no direction
SAMPLE = 0.02  # [m] along a route between the points for which a speed is found: as far as the waypoints of a ring
# Samples before and behind a point, that show how sharp a bend is: small sees corners, large sees bends. Nearer than
# half of them to an end there is no bend.
BEND, HALF_BEND = 5, 3
BENDING = 2.5  # times the largest turn rate that a bend would take at its speed, if it were driven exactly; small cuts
#                fewer corners, large loses less time
SLOWEST_BEND = 0.08  # [m/s] in a bend, however sharp it is: small cuts fewer corners, large loses less time
SLOWING = 0.6  # share of the acceleration that is counted on for slowing down before a bend
SLOWEST = 2.5  # times the rate at which wheels begin to move: well clear of the dead band
TIE = 1e-9  # [m] a leg farther on must be nearer by this

# Indices of a state: [m] driven along the piece, [s] turned on the spot since the last progress along it, whether it
# turns on the spot (0 or 1), and the last command [m/s, rad/s].
DISTANCE, TURNED, IS_TURNING, V, W = range(5)


class Drive(NamedTuple):
    """Limits of the wheels, as in `DriveConfig`."""

    max_speed: float  # [m/s]
    max_turn_rate: float  # [rad/s]
    acceleration: float  # [m/s^2]
    wheel_base: float  # [m]
    dead_band: float  # [m/s]


class Piece(NamedTuple):
    """Part of a route without hairpins."""

    waypoints: Array  # float64 (n, 2) [m], no two in a row at the same place
    legs: Array  # float64 (n - 1), lengths of the lines between them [m]
    lengths: Array  # float64 (n), from the first waypoint to each, along the piece [m]
    speeds: Array  # float64 (n - 1), on the lines, at most [m/s]
    limits: Array  # float64 (any), speeds at samples, from which the robot can still slow down for bends ahead [m/s]


@compiled
def split(waypoints: Array) -> Tuple[Array, Array]:
    """Where the pieces of a route between its hairpins begin and end, without legs that have no direction.

    Args:
        waypoints: float64 (any, 2) [m].

    Returns:
        the waypoints that are kept, int (any); the indices among these at which pieces begin and end, int (pieces + 1).
    """
    kept, cuts = [0], [0]
    heading = 0.0
    for index in range(1, len(waypoints)):
        dx, dy = waypoints[index, 0] - waypoints[kept[-1], 0], waypoints[index, 1] - waypoints[kept[-1], 1]
        if math.hypot(dx, dy) < SHORTEST:
            continue
        here = len(kept) - 1
        if here > cuts[-1] and abs(wrapped(math.atan2(dy, dx) - heading)) > HAIRPIN:
            cuts.append(here)
        heading = math.atan2(dy, dx)
        kept.append(index)
    if len(kept) > 1:
        cuts.append(len(kept) - 1)
    return np.array(kept), np.array(cuts)


@compiled
def piece_of(waypoints: Array, speeds: Array, drive: Drive) -> Piece:
    """A piece over waypoints at speeds, as in `Piece`."""
    along = waypoints[1:] - waypoints[:-1]
    legs = np.hypot(along[:, 0], along[:, 1])
    lengths = np.zeros(len(waypoints))
    lengths[1:] = np.cumsum(legs)
    return Piece(waypoints, legs, lengths, speeds, limits(waypoints, speeds, lengths, drive))


@compiled
def limits(waypoints: Array, speeds: Array, lengths: Array, drive: Drive) -> Array:
    """Speeds at samples along a piece, with time to slow down before its bends: float64 (any) [m/s].

    Args:
        waypoints, speeds, lengths: of the piece.
        drive: see above.
    """
    count, leg, last = math.ceil(lengths[-1] / SAMPLE) + 1, 0, len(speeds) - 1
    points, found = np.empty((count, 2)), np.empty(count)
    for index in range(count):
        along = min(index * SAMPLE, lengths[-1])
        while leg < last and lengths[leg + 1] <= along:
            leg += 1
        share = (along - lengths[leg]) / (lengths[leg + 1] - lengths[leg])
        points[index] = waypoints[leg] + share * (waypoints[leg + 1] - waypoints[leg])
        found[index] = min(speeds[leg], drive.max_speed)
    for index in range(HALF_BEND, count - HALF_BEND):
        before, after = points[max(index - BEND, 0)], points[min(index + BEND, count - 1)]
        turn = abs(wrapped(math.atan2(after[1] - points[index, 1], after[0] - points[index, 0])
                           - math.atan2(points[index, 1] - before[1], points[index, 0] - before[0])))
        bending = BENDING * drive.max_turn_rate * BEND * SAMPLE / max(turn, 1e-9)
        found[index] = min(found[index], max(bending, SLOWEST_BEND))
    change = 2.0 * SLOWING * drive.acceleration * SAMPLE
    for index in range(count - 2, -1, -1):
        found[index] = min(found[index], math.sqrt(found[index + 1] ** 2 + change))
    return found


@compiled
def start(v: float, w: float) -> Array:
    """The state of a robot at the beginning of a piece, before it turns along that, after a command [m/s, rad/s]."""
    return np.array([0.0, 0.0, 1.0, v, w])


@compiled
def follow(piece: Piece, drive: Drive, state: Array, x: float, y: float, theta: float,
           dt: float) -> Tuple[bool, float]:
    """Put the velocity that leads along a piece from a pose into the state.

    Args:
        piece, drive, state: see above.
        x, y, theta: the pose [m, rad].
        dt: time until the next call [s].

    Returns:
        whether the end is reached, and how far off the piece the robot is [m].
    """
    distance, off = nearest(piece, x, y, state[DISTANCE], WINDOW)
    go_along(piece, state, distance)
    left = piece.lengths[-1] - state[DISTANCE]
    if left < SHORTEST or (left < LEAST_AHEAD and math.hypot(
            piece.waypoints[-1, 0] - x, piece.waypoints[-1, 1] - y) < ARRIVED):
        return True, off
    middle = theta + 0.5 * state[W] * LAG  # where the robot is once its wheels do what they are told
    pursue(piece, drive, state, x + state[V] * LAG * math.cos(middle), y + state[V] * LAG * math.sin(middle),
           theta + state[W] * LAG, dt)
    return False, off


@compiled
def follow_flat(waypoints: Array, legs: Array, lengths: Array, speeds: Array, limits_: Array, max_speed: float,
                max_turn_rate: float, acceleration: float, wheel_base: float, dead_band: float, state: Array, x: float,
                y: float, theta: float, dt: float) -> Tuple[bool, float]:
    """As `follow`, for Python: numba 0.56 takes 70 us longer for every second or third call with tuples from there.

    Args:
        waypoints, legs, lengths, speeds, limits_: the piece.
        max_speed, max_turn_rate, acceleration, wheel_base, dead_band: the drive.
        state, x, y, theta, dt: see `follow`.
    """
    return follow(Piece(waypoints, legs, lengths, speeds, limits_),
                  Drive(max_speed, max_turn_rate, acceleration, wheel_base, dead_band), state, x, y, theta, dt)


@compiled
def go_along(piece: Piece, state: Array, distance: float) -> None:
    """Take note of a distance along a piece [m]; a robot that circles a bend is taken to be past it."""
    if distance > state[DISTANCE] + SHORTEST:
        state[TURNED] = 0.0
    state[DISTANCE] = distance
    if state[TURNED] > STALL:
        state[TURNED] = 0.0
        state[DISTANCE] = min(distance + LEAST_AHEAD, piece.lengths[-1])


@compiled
def pursue(piece: Piece, drive: Drive, state: Array, x: float, y: float, theta: float, dt: float) -> None:
    """Put the velocity that leads to the pursued point from a pose [m, rad] into the state."""
    distance, _ = nearest(piece, x, y, state[DISTANCE], WINDOW)
    limit = speed_at(piece, distance)
    limit = min(limit, speed_at(piece, distance + limit * dt))
    to_x, to_y = at(piece, distance + max(AHEAD * limit, LEAST_AHEAD))
    bearing = wrapped(math.atan2(to_y - y, to_x - x) - theta)
    if abs(bearing) > (BESIDE if state[IS_TURNING] else BEHIND):
        state[IS_TURNING] = 1.0
        state[TURNED] += dt
        state[V], state[W] = 0.0, turn_rate(bearing, dt, drive)
        return
    state[IS_TURNING] = 0.0
    curvature = 2.0 * math.sin(bearing) / max(math.hypot(to_x - x, to_y - y), 0.5 * LEAST_AHEAD)
    v = min(limit, drive.max_turn_rate / max(abs(curvature), 1e-6))
    left = piece.lengths[-1] - state[DISTANCE]
    v = min(v, max(fastest(left, dt, drive.acceleration), CREEP))
    state[V], state[W] = v, v * curvature


@compiled
def turn_rate(angle: float, dt: float, drive: Drive) -> float:
    """The rate [rad/s] at which to turn on the spot while an angle [rad] is left, so as to stop at its end."""
    spin = 2.0 * drive.acceleration / drive.wheel_base  # [rad/s^2]
    slowest = SLOWEST * drive.dead_band / drive.wheel_base
    return math.copysign(max(min(drive.max_turn_rate, fastest(abs(angle), dt, spin)), slowest), angle)


@compiled
def fastest(distance: float, dt: float, acceleration: float) -> float:
    """The speed that can be kept for dt with time to stop afterwards within a distance [m, or rad]."""
    counted = STOPPING * acceleration
    return math.sqrt((counted * dt) ** 2 + 2.0 * counted * distance) - counted * dt


@compiled
def wrapped(angle: float) -> float:
    """The same direction as an angle, in [-pi, pi) [rad]."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


@compiled
def speed_at(piece: Piece, distance: float) -> float:
    """The speed at a distance along a piece [m] from which the robot can still slow down for the bends ahead [m/s]."""
    return float(piece.limits[min(int(distance / SAMPLE), len(piece.limits) - 1)])


@compiled
def leg_at(lengths: Array, distance: float) -> int:
    """The number of the leg that a distance along a piece with these lengths leads to [m]."""
    return min(max(int(np.searchsorted(lengths, distance, side='right')) - 1, 0), len(lengths) - 2)


@compiled
def at(piece: Piece, distance: float) -> Tuple[float, float]:
    """The point at a distance along a piece [m]; beyond the last waypoint it goes straight on."""
    leg = leg_at(piece.lengths, distance)
    share = (distance - piece.lengths[leg]) / piece.legs[leg]
    x, y = piece.waypoints[leg, 0], piece.waypoints[leg, 1]
    return x + share * (piece.waypoints[leg + 1, 0] - x), y + share * (piece.waypoints[leg + 1, 1] - y)


@compiled
def nearest(piece: Piece, x: float, y: float, since: float, span: float) -> Tuple[float, float]:
    """The point of a piece that is nearest to another point, on a part of it.

    Args:
        piece: see above.
        x, y: the other point [m].
        since: distance along the piece at which the part begins [m].
        span: the part ends with the last leg that begins within this distance of its beginning [m].

    Returns:
        its distance along the piece, and its distance from the other point [m]
    """
    best, least = since, math.inf
    for leg in range(leg_at(piece.lengths, since), len(piece.legs)):
        if piece.lengths[leg] > since + span:
            break
        from_x, from_y, size = piece.waypoints[leg, 0], piece.waypoints[leg, 1], piece.legs[leg]
        dx, dy = piece.waypoints[leg + 1, 0] - from_x, piece.waypoints[leg + 1, 1] - from_y
        share = ((x - from_x) * dx + (y - from_y) * dy) / (size * size)
        share = min(max(share, (since - piece.lengths[leg]) / size, 0.0), 1.0)
        off = math.hypot(from_x + share * dx - x, from_y + share * dy - y)
        if off < least - TIE:
            best, least = piece.lengths[leg] + share * size, off
    return best, least
