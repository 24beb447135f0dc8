"""A rehearsal of a route, compiled by numba: how a robot would drive along it.

The controller of the robot follows the route, with wheels that take time to change their speeds, and a body that slides
along the walls. A trace is float64 (any, 7): a row for the beginning and for each DT after it.
"""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.behaviours.compiled_follower import (DISTANCE, IS_TURNING, Drive, Piece, V, W, follow, leg_at,
                                                         piece_of, split, start)
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray
arc, interpolated = fast.arc, fast.interpolated

DT, TICKS = 0.1, 5  # [s] from command to command, and the parts in each of which the wheels change their speeds
LOST = 0.35  # [m] off the route, beyond which the robot would not follow it
SLOWEST = 0.05  # [m/s] on average, beyond the time for turns: a rehearsal that is slower is given up
PATIENCE = 10.0  # [s] that it may take longer
PUSHES = 3  # how often a body is pushed out of the walls of a corner
# Columns of a trace: pose [m, rad], wheels [m/s], driven of the route [m], speed of the route there [m/s].
X, Y, THETA, LEFT, RIGHT, ALONG, SPEED = range(7)
COLUMNS = 7


class Walls(NamedTuple):
    """What the body slides along."""

    clearance: Array  # float64 (rows + 1, columns + 1), at the nodes [m]
    origin: Tuple[float, float]  # of the nodes [m]
    resolution: float  # [m]
    radius: float  # of the body [m]


@compiled
def rehearse(waypoints: Array, speeds: Array, drive: Drive, walls: Walls, begin: Array, is_first: bool,
             until: float) -> Tuple[bool, Array]:
    """Drive along a route.

    Args:
        waypoints, speeds: as in `Route`.
        drive: as in `compiled_follower`.
        walls: see above.
        begin: where the robot is, a row of a trace.
        is_first: whether it turns along the route before it drives; otherwise it is already on it.
        until: distance along the route [m] at which the rehearsal ends.

    Returns:
        whether the robot gets there; its trace.
    """
    drive, walls = Drive(*drive), Walls(*walls)
    kept, cuts = split(waypoints)
    trace, count, before = np.empty((0, COLUMNS)), 0, 0.0
    here, is_there = begin.copy(), True
    here[ALONG] = 0.0
    for number in range(len(cuts) - 1):
        part = kept[cuts[number]:cuts[number + 1] + 1]
        piece = piece_of(waypoints[part], speeds[part[1:] - 1], drive)
        is_there, found = drive_piece(piece, drive, walls, here, is_first or number > 0, until - before)
        found[:, ALONG] += before
        if count + len(found) > len(trace):
            longer = np.empty((2 * (count + len(found)), COLUMNS))
            longer[:count] = trace[:count]
            trace = longer
        trace[count:count + len(found)] = found
        count += len(found) - 1  # the last row is the first one of the next piece
        here = trace[count]
        before += piece.lengths[-1]
        if not is_there or before >= until:
            break
    return is_there, trace[:count + 1].copy()


@compiled
def drive_piece(piece: Piece, drive: Drive, walls: Walls, begin: Array, is_first: bool,
                until: float) -> Tuple[bool, Array]:
    """As `rehearse`, along a piece."""
    steps = int((piece.lengths[-1] / SLOWEST + PATIENCE) / DT)
    trace = np.empty((steps + 1, COLUMNS))
    trace[0] = begin
    state = start(0.5 * (begin[LEFT] + begin[RIGHT]), (begin[RIGHT] - begin[LEFT]) / drive.wheel_base)
    state[IS_TURNING] = 1.0 if is_first else 0.0
    for step in range(steps):
        here = trace[step]
        is_at_end, off = follow(piece, drive, state, *pose_of(here), DT)
        here[ALONG] = state[DISTANCE]
        here[SPEED] = piece.speeds[leg_at(piece.lengths, state[DISTANCE])]
        if is_at_end or state[DISTANCE] >= until:
            return True, trace[:step + 1]
        if off > LOST:
            return False, trace[:step + 1]
        trace[step + 1] = here
        advance(drive, walls, trace[step + 1], state[V], state[W])
    return False, trace[:steps]


@compiled
def pose_of(row: Array) -> Tuple[float, float, float]:
    """The pose in a row of a trace: x [m], y [m], theta [rad]."""
    return row[X], row[Y], row[THETA]


@compiled
def advance(drive: Drive, walls: Walls, robot: Array, v: float, w: float) -> None:
    """Move a robot, a row of a trace, for DT after a command [m/s, rad/s]."""
    w = min(max(w, -drive.max_turn_rate), drive.max_turn_rate)
    left, right = v - 0.5 * w * drive.wheel_base, v + 0.5 * w * drive.wheel_base
    fastest = max(abs(left), abs(right), drive.max_speed)
    left, right = left * drive.max_speed / fastest, right * drive.max_speed / fastest
    left = 0.0 if abs(left) < drive.dead_band else left
    right = 0.0 if abs(right) < drive.dead_band else right
    dt = DT / TICKS
    change = drive.acceleration * dt
    for _ in range(TICKS):
        robot[LEFT] = min(max(left, robot[LEFT] - change), robot[LEFT] + change)
        robot[RIGHT] = min(max(right, robot[RIGHT] - change), robot[RIGHT] + change)
        x, y, robot[THETA] = arc(robot[X], robot[Y], robot[THETA], 0.5 * (robot[LEFT] + robot[RIGHT]) * dt,
                                 (robot[RIGHT] - robot[LEFT]) / drive.wheel_base * dt)
        robot[X], robot[Y] = pushed_out(walls, x, y)


@compiled
def pushed_out(walls: Walls, x: float, y: float) -> Tuple[float, float]:
    """Where a body that would be at (x, y) [m] is beside the walls."""
    for _ in range(PUSHES):
        gap, along_u, along_v = interpolated(walls.clearance, (x - walls.origin[0]) / walls.resolution,
                                             (y - walls.origin[1]) / walls.resolution)
        slope = math.hypot(along_u, along_v)
        if gap >= walls.radius or slope == 0.0:
            break
        push = (walls.radius - gap) / slope
        x, y = x + push * along_u, y + push * along_v
    return x, y
