"""What is swept on traces of rehearsals, and when, compiled by numba.

Arguments that many functions share:
    brush: of the floor.
    trace: see `compiled_rehearsal`.
    speed: a route that is faster is driven with the brushes up [m/s].
"""

from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.planning.simulate.compiled_rehearsal import SPEED, THETA, X, Y, pose_of
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.compiling.jit import compiled
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE, SWEEPABLE

sweep = fast.sweep

Array = Any  # numpy.ndarray
Brush = Any  # rumba_sim.model.floors.sweep.Brush
Window = Tuple[Tuple[int, int], Tuple[int, int]]  # rows and columns: each the first, and the one after the last

STRIDE, STRAIGHT = 4, 0.02  # rows that are swept at once, at most, if the robot turns by less [rad]: large is fast
BEFORE, NEVER = -1, 2 ** 31 - 1  # a pass before the trace, and none


class Passes(NamedTuple):
    """When each sample of a floor is passed on a trace: each time between a row and the next one."""

    first: Array  # int32 (rows, columns), the row of the first pass; NEVER; BEFORE also for what nobody can reach
    last: Array  # int32 (rows, columns), that of the last one on the trace; BEFORE if there is none


@compiled
def sweep_trace(brush: Brush, samples: Array, trace: Array, speed: float) -> None:
    """Sweep along a trace, except where the route is faster than a speed [m/s]: there the brushes are up.

    Args:
        brush, trace, speed: see above.
        samples: uint8 (rows, columns), those of the brush, or others.
    """
    step = 0
    while step < len(trace) - 1:
        last = step + 1
        if trace[step, SPEED] <= speed:
            while last < min(len(trace) - 1, step + STRIDE) and trace[last, SPEED] <= speed and (
                    abs(trace[last + 1, THETA] - trace[step, THETA]) < STRAIGHT):
                last += 1
            sweep(brush.constants[0], samples, brush.no_dirt, brush.tally[0], pose_of(trace[step]),
                  pose_of(trace[last]))
        step = last


@compiled
def passed(brush: Brush, trace: Array, speed: float) -> Passes:
    """When the samples are passed on a trace; the brush is as before it."""
    first, last = np.full(brush.samples.shape, NEVER, np.int32), np.full(brush.samples.shape, BEFORE, np.int32)
    samples = np.full(brush.samples.shape, SWEEPABLE, np.uint8)
    for row in range(samples.shape[0]):
        for column in range(samples.shape[1]):
            if brush.samples[row, column] & REACHABLE == 0 or brush.samples[row, column] >= PASS:
                first[row, column] = BEFORE
    for step in range(len(trace) - 1):
        part = trace[step:step + 2]
        sweep_trace(brush, samples, part, speed)
        rows, columns = window(brush, part)
        for row in range(rows[0], rows[1]):
            for column in range(columns[0], columns[1]):
                if samples[row, column] >= PASS:
                    samples[row, column] = SWEEPABLE
                    first[row, column] = min(first[row, column], step)
                    last[row, column] = step
    return Passes(first, last)


@compiled
def gain(brush: Brush, passes: Passes, scratch: Array, trace: Array, low: int, high: int, other: Array,
         speed: float) -> int:
    """How many more samples are swept if the part of a trace between two rows is replaced by another trace.

    Args:
        brush, trace, speed: see above.
        passes: those on the trace.
        scratch: SWEEPABLE samples, uint8 of the shape of the brush's; they are so again afterwards.
        low, high: the rows.
        other: that trace.
    """
    sweep_trace(brush, scratch, other, speed)
    (bottom, top), (left, right) = window(brush, np.concatenate((trace[low:high + 1], other)))
    more = 0
    for row in range(bottom, top):
        for column in range(left, right):
            first, last = passes.first[row, column], passes.last[row, column]
            is_swept = int(first < low) | int(last >= high) | int(scratch[row, column] >= PASS)
            more += is_swept - int(first < NEVER)
            scratch[row, column] = SWEEPABLE
    return more


@compiled
def window(brush: Brush, trace: Array) -> Window:
    """The samples around those that are swept on a trace."""
    k, (rows, columns) = brush.constants[0], brush.samples.shape
    margin = 0.5 * k.brush_width + 2.0 * k.sample_pitch
    left, right = trace[:, X].min() - margin - k.origin_x, trace[:, X].max() + margin - k.origin_x
    bottom, top = trace[:, Y].min() - margin - k.origin_y, trace[:, Y].max() + margin - k.origin_y
    return ((max(int(bottom / k.sample_pitch), 0), min(int(top / k.sample_pitch), rows)),
            (max(int(left / k.sample_pitch), 0), min(int(right / k.sample_pitch), columns)))
