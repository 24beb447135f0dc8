"""A rehearsal of a route, compiled by numba: how a robot would drive along it, and what other ways would change.

The controller of the robot follows the route, with wheels that take time to change their speeds, and a body that slides
along the walls. A trace is float64 (any, 7): a row for the beginning and for each DT after it.
"""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.behaviours.compiled_follower import (DISTANCE, IS_TURNING, Drive, Piece, V, W, follow, leg_at,
                                                         piece_of, split, start)
from rumba_sim.model.compiled import fast
from rumba_sim.model.jit import compiled
from rumba_sim.model.kernel.samples import PASS, REACHABLE, SWEEPABLE

Array = Any  # numpy.ndarray
Brush = Any  # rumba_sim.model.sweep.Brush
arc, interpolated, sweep = fast.arc, fast.interpolated, fast.sweep

DT, TICKS = 0.1, 5  # [s] from command to command, and the parts in each of which the wheels change their speeds
LOST = 0.35  # [m] off the route, beyond which the robot would not follow it
SLOWEST = 0.05  # [m/s] on average, beyond the time for turns: a rehearsal that is slower is given up
PATIENCE = 10.0  # [s] that it may take longer
# [m] before and behind an edit, within which the robot drives otherwise because of it: large is exact, small is fast.
LEAD, TAIL = 0.25, 0.5
STRIDE, STRAIGHT = 4, 0.02  # rows that are swept at once, at most, if the robot turns by less [rad]: large is fast
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
        is_at_end, off = follow(piece, drive, state, here[X], here[Y], here[THETA], DT)
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


@compiled
def sweep_trace(brush: Brush, samples: Array, trace: Array, speed: float) -> None:
    """Sweep along a trace, except where the route is faster than a speed [m/s]: there the brushes are up.

    Args:
        brush: see above.
        samples: uint8 (rows, columns), those of the brush, or others.
        trace: see above.
        speed: see above.
    """
    step = 0
    while step < len(trace) - 1:
        last = step + 1
        if trace[step, SPEED] <= speed:
            while last < min(len(trace) - 1, step + STRIDE) and trace[last, SPEED] <= speed and (
                    abs(trace[last + 1, THETA] - trace[step, THETA]) < STRAIGHT):
                last += 1
            sweep(brush.constants[0], samples, brush.no_dirt, brush.tally[0],
                  (trace[step, X], trace[step, Y], trace[step, THETA]),
                  (trace[last, X], trace[last, Y], trace[last, THETA]))
        step = last


@compiled
def alone(brush: Brush, trace: Array, speed: float) -> Array:
    """How many reachable samples are swept up to each row of a trace, and at no other time: int (rows).

    Args:
        brush: after all of the trace; its samples are changed.
        trace, speed: as for `sweep_trace`.
    """
    samples = brush.samples
    for row in range(samples.shape[0]):
        for column in range(samples.shape[1]):
            is_once = samples[row, column] // PASS == 1 and samples[row, column] & REACHABLE
            samples[row, column] = (SWEEPABLE | REACHABLE) if is_once else 0
    found = np.zeros(len(trace), np.int64)
    before = brush.tally[0].swept
    for step in range(len(trace) - 1):
        sweep_trace(brush, samples, trace[step:step + 2], speed)
        found[step + 1] = brush.tally[0].swept - before
    return found


@compiled
def changes(waypoints: Array, speeds: Array, drive: Drive, walls: Walls, speed: float, trace: Array, brush: Brush,
            scratch: Array, spans: Array, paths: Array, stops: Array) -> Tuple[Array, Array]:
    """What each of several edits of a route would change, if it were the only one.

    Args:
        waypoints, speeds, drive, walls, trace: as for `rehearse`; the trace is that of the route.
        speed: at which what replaces a part is driven [m/s]; a faster route is driven with the brushes up.
        brush: after all of the trace.
        scratch: uint8 (2, rows, columns of the samples), all 0; it is so again afterwards.
        spans: int (edits, 2), the waypoints between which each edit replaces those of the route.
        paths: float64 (any, 2) [m], what it replaces them by, one path behind the other.
        stops: int (edits + 1), where each path begins, and the end of the last.

    Returns:
        how much longer the route takes: float64 (edits) [s], inf if the robot would not follow it; how many more
        samples are swept: int (edits).
    """
    seconds, samples = np.full(len(spans), np.inf), np.zeros(len(spans), np.int64)
    along, lengths = trace[:, ALONG].copy(), np.zeros(len(waypoints))
    for index in range(1, len(waypoints)):
        lengths[index] = lengths[index - 1] + distance(waypoints[index - 1], waypoints[index])
    for edit in range(len(spans)):
        first, last = spans[edit]
        low = max(np.searchsorted(along, lengths[first] - LEAD) - 1, 0)
        high = min(np.searchsorted(along, lengths[last] + TAIL), len(along) - 1)
        points, fast_at, until = edited(waypoints, speeds, lengths, along[low], first, last,
                                        paths[stops[edit]:stops[edit + 1]], speed)
        is_end = high == len(along) - 1
        is_there, found = rehearse(points, fast_at, drive, walls, trace[low], low == 0, np.inf if is_end else until)
        if not is_there:
            continue
        seconds[edit] = (len(found) - 1 - (high - low)) * DT
        if not is_end:
            off = found[-1, ALONG] - until - (along[high] - lengths[last] - TAIL)
            seconds[edit] -= off / found[-1, SPEED]
        samples[edit] = gain(brush, scratch, trace[low:high + 1], found, speed)
    return seconds, samples


@compiled
def edited(waypoints: Array, speeds: Array, lengths: Array, here: float, first: int, last: int, path: Array,
           speed: float) -> Tuple[Array, Array, float]:
    """The part of a route around an edit, from a distance `here` along the route on [m].

    Returns:
        its waypoints, float64 (any, 2) [m], and speeds, float64 (any - 1) [m/s]; the length up to TAIL beyond the edit.
    """
    begin = min(max(int(np.searchsorted(lengths, here, side='right')), 1), max(first, 1))
    end = min(np.searchsorted(lengths, lengths[last] + 2.0 * TAIL), len(waypoints) - 1)
    before = waypoints[begin:first + 1]
    points = np.empty((1 + len(before) + len(path) + end + 1 - last, 2))
    share = (here - lengths[begin - 1]) / max(lengths[begin] - lengths[begin - 1], 1e-9)
    points[0] = waypoints[begin - 1] + min(share, 1.0) * (waypoints[begin] - waypoints[begin - 1])
    points[1:1 + len(before)] = before
    points[1 + len(before):len(points) - (end + 1 - last)] = path
    points[len(points) - (end + 1 - last):] = waypoints[last:end + 1]
    fast_at = np.full(len(points) - 1, speed)
    fast_at[:len(before)] = speeds[begin - 1:begin - 1 + len(before)]
    fast_at[len(fast_at) - (end - last):] = speeds[last:end]
    length = 0.0
    for index in range(1, len(points)):
        length += distance(points[index - 1], points[index])
    return points, fast_at, length - (lengths[end] - lengths[last] - TAIL)


@compiled
def distance(one: Array, other: Array) -> float:
    """The distance between two points (2)."""
    return math.hypot(other[0] - one[0], other[1] - one[1])


@compiled
def gain(brush: Brush, scratch: Array, before: Array, after: Array, speed: float) -> int:
    """How many more samples are swept if a part of a trace is replaced by another.

    Args:
        brush, scratch, speed: as for `changes`.
        before, after: the part of the trace, and what replaces it.
    """
    rows, columns = window(brush, before, after)
    scratch[:, rows[0]:rows[1], columns[0]:columns[1]] = SWEEPABLE
    sweep_trace(brush, scratch[0], before, speed)
    sweep_trace(brush, scratch[1], after, speed)
    more = 0
    for row in range(rows[0], rows[1]):
        for column in range(columns[0], columns[1]):
            sample = int(brush.samples[row, column])
            passes = sample // PASS
            others = passes - int(scratch[0, row, column]) // PASS
            is_swept = int(others + int(scratch[1, row, column]) // PASS > 0)
            more += (sample // REACHABLE & 1) * (is_swept - int(passes > 0))
    scratch[:, rows[0]:rows[1], columns[0]:columns[1]] = 0
    return more


@compiled
def window(brush: Brush, one: Array, other: Array) -> Tuple[Tuple[int, int], Tuple[int, int]]:
    """The rows and the columns of samples that are swept on two traces: each the first, and the one after the last."""
    k, (rows, columns) = brush.constants[0], brush.samples.shape
    margin = 0.5 * k.brush_width + 2.0 * k.sample_pitch
    left, right = min(one[:, X].min(), other[:, X].min()) - margin, max(one[:, X].max(), other[:, X].max()) + margin
    bottom, top = min(one[:, Y].min(), other[:, Y].min()) - margin, max(one[:, Y].max(), other[:, Y].max()) + margin
    return ((max(int((bottom - k.origin_y) / k.sample_pitch), 0), min(int((top - k.origin_y) / k.sample_pitch), rows)),
            (max(int((left - k.origin_x) / k.sample_pitch), 0),
             min(int((right - k.origin_x) / k.sample_pitch), columns)))
