"""What the brush passes over while a robot moves."""

import math
from typing import Tuple

import numpy as np

from rumba_sim.model.kernel import Array, Record, Triple
from rumba_sim.model.kernel.geometry import wrap
from rumba_sim.model.kernel.hashing import scrambled
from rumba_sim.model.kernel.sweeping.samples import across_of, clean, up_of

Place = Tuple[float, float, float, float]  # see `to_squares`
BEND = 0.15  # [rad] turns are swept in pieces of at most this: the brush is up to 0.3 % longer or shorter in them
STRIDE = 0.03  # [m] the floor is swept in strides of about this: sweeping in each tick takes several times longer
TURN_STRIDE = 0.12  # [rad] the same in turns: less than BEND, so that each stride is swept in one piece


def brush(robot: Record, k: Record, samples: Array, dirt: Array, tally: Record, start: Triple) -> None:
    """Sweep the floor if the brush works, stride by stride; `start` is the pose at the beginning of the tick.

    `swept_x`, `swept_y` and `swept_theta` are the pose up to which the floor is swept.
    """
    works = not robot.brushes_up and robot.charge > 0.0
    if robot.sweeps and (not works or is_reversing(robot, start)):
        sweep(k, samples, dirt, tally, (robot.swept_x, robot.swept_y, robot.swept_theta), start)
        robot.sweeps = False
    if not works:
        return
    robot.brush_time += k.dt
    if not robot.sweeps:
        robot.sweeps = True
        robot.swept_x, robot.swept_y, robot.swept_theta = start
        robot.swept_distance = robot.distance
    if robot.distance - robot.swept_distance >= STRIDE or abs(wrap(robot.theta - robot.swept_theta)) >= TURN_STRIDE:
        end = robot.x, robot.y, robot.theta
        sweep(k, samples, dirt, tally, (robot.swept_x, robot.swept_y, robot.swept_theta), end)
        robot.swept_x, robot.swept_y, robot.swept_theta = end
        robot.swept_distance = robot.distance


def is_reversing(robot: Record, start: Triple) -> bool:
    """Whether a robot went back, in a tick that began with the pose `start`, over floor that is not swept yet."""
    return bool((start[0] - robot.swept_x) * (robot.x - start[0])
                + (start[1] - robot.swept_y) * (robot.y - start[1]) < 0.0)


def sweep_moves(constants: Array, samples: Array, dirt: Array, tallies: Array, starts: Array, ends: Array) -> None:
    """As `sweep`, for callers that are not compiled: for them, one call takes longer than the sweeping.

    Args:
        constants, tallies: one record each, in arrays.
        samples, dirt: as for `sweep`.
        starts, ends: poses (x [m], y [m], theta [rad]) between which the brush passes, float64 (any, 3) each.
    """
    for move in range(len(starts)):
        sweep(constants[0], samples, dirt, tallies[0], (starts[move, 0], starts[move, 1], starts[move, 2]),
              (ends[move, 0], ends[move, 1], ends[move, 2]))


def sweep(k: Record, samples: Array, dirt: Array, tally: Record, start: Triple, end: Triple) -> None:
    """Clean what the brush, a segment across the middle of the robot, passes over from one pose to another.

    Each pass takes the same share of the dirt.
    """
    turn = wrap(end[2] - start[2])
    pieces = 1 + int(abs(turn) / BEND)
    before = start
    for piece in range(1, pieces):
        share = piece / pieces
        after = (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]),
                 start[2] + share * turn)
        pass_over(k, samples, dirt, tally, before, after)
        before = after
    pass_over(k, samples, dirt, tally, before, end)


def pass_over(k: Record, samples: Array, dirt: Array, tally: Record, start: Triple, end: Triple) -> None:
    """Let the brush pass from one pose to another; the headings differ by BEND at most.

    First the squares near the brush are listed, then those whose samples it passes, then these are cleaned. In one loop
    this takes twice as long: the second step neither branches nor writes to the floor, so that the processor computes
    several samples at a time.
    """
    half = 0.5 * k.brush_width / k.sample_pitch
    from_squares, to = to_squares(k, start), to_squares(k, end)
    rows, columns, near = near_squares(samples, from_squares, to, abs(wrap(end[2] - start[2])), half)
    passed = keep_passed(rows, columns, near, from_squares, to, half)
    swept, taken, cells = 0, 0.0, dirt.shape[0] / samples.shape[0]
    for index in range(passed):
        row, column = rows[index], columns[index]
        fresh, share = clean(k, samples, row, column)
        amount = float(dirt[np.uint32((row + 0.5) * cells), np.uint32((column + 0.5) * cells)])
        swept, taken = swept + fresh, taken + share * amount
    tally.swept += swept
    tally.dirt -= taken


def near_squares(samples: Array, start: Place, end: Place, turn: float, half: float) -> Tuple[Array, Array, int]:
    """The squares whose samples the brush may pass on its way.

    These are near the brush in the middle of its movement: they are listed line by line (rows, or columns if the brush
    lies more along x), and in each line from the first to the last that the brush can pass.

    Args:
        samples: as for the package.
        start, end: where the brush passes from and to, as `to_squares` gives them.
        turn: angle between both [rad].
        half: half the width of the brush [squares].

    Returns:
        Rows and columns, uint32 (any) each, and how many of them count: what follows has no meaning.
    """
    (x, y, cos, sin), (to_x, to_y, to_cos, to_sin) = start, end
    distance = math.hypot(to_x - x, to_y - y)
    middle_cos, middle_sin = cos + to_cos, sin + to_sin
    is_upright = abs(middle_cos) >= abs(middle_sin)  # the lines are rows
    slope = -middle_sin / middle_cos if is_upright else -middle_cos / middle_sin  # of the brush, from line to line
    steep = math.sqrt(1.0 + slope * slope)
    middle_x, middle_y = 0.5 * (x + to_x), 0.5 * (y + to_y)
    middle_line, middle_across = (middle_y, middle_x) if is_upright else (middle_x, middle_y)
    count, length = (samples.shape[0], samples.shape[1]) if is_upright else (samples.shape[1], samples.shape[0])
    reach = half / steep + 0.5 * (distance + turn * half)
    first, last = max(int(middle_line - reach), 0), min(int(middle_line + reach) + 1, count)
    widest = int(1.01 * (distance + turn * (reach + 1.5) * steep) * steep + abs(slope)) + 2
    squares, listed = np.empty((2, (max(last - first, 0) + 1) * widest), np.uint32), 0
    lines, across = squares[0], squares[1]
    for line in range(first, last):
        off = line + 0.5 - middle_line
        centre = middle_across + slope * off
        margin = 0.505 * (distance + turn * (abs(off) + 0.5) * steep) * steep + 0.5 * abs(slope)
        begin, end_before = max(int(centre - margin), 0), min(int(centre + margin) + 1, length)
        for place in range(widest):  # always as many, which is quicker; the next line overwrites those in excess
            lines[listed + place], across[listed + place] = line, begin + place
        listed += max(end_before - begin, 0)
    return (lines, across, listed) if is_upright else (across, lines, listed)


def keep_passed(rows: Array, columns: Array, count: int, start: Place, end: Place, half: float) -> int:
    """Move the squares whose samples the brush passes to the front of a list; returns how many these are.

    The brush passes over a sample point if the point changes from one side of the line through the brush to the other
    while it is at most half the brush's width from the middle.

    Args:
        rows, columns, count: as `near_squares` returns them.
        start, end, half: as for `near_squares`.
    """
    (x, y, cos, sin), (to_x, to_y, to_cos, to_sin) = start, end
    is_passed = np.empty(count, np.uint8)
    for index in range(count):
        row, column = int(rows[index]), int(columns[index])
        bits = scrambled(row, column)
        u, v = across_of(column, bits), up_of(row, bits)
        ahead = (u - x) * cos + (v - y) * sin
        ahead_after = (u - to_x) * to_cos + (v - to_y) * to_sin
        beside = (v - y) * cos - (u - x) * sin
        beside_after = (v - to_y) * to_cos - (u - to_x) * to_sin
        crosses = (ahead > 0.0) != (ahead_after > 0.0)
        is_within = abs(ahead * beside_after - ahead_after * beside) <= half * abs(ahead - ahead_after)
        is_passed[index] = crosses & is_within
    kept = 0
    for index in range(count):
        rows[kept], columns[kept] = rows[index], columns[index]
        kept += int(is_passed[index])
    return kept


def to_squares(k: Record, pose: Triple) -> Place:
    """The position of a pose in squares of samples from the corner of the floor, and cosine and sine of its heading."""
    return ((pose[0] - k.origin_x) / k.sample_pitch, (pose[1] - k.origin_y) / k.sample_pitch,
            math.cos(pose[2]), math.sin(pose[2]))
