"""When samples are passed on a trace, and what is gained by another part of it, are as the brush itself shows."""

import numpy as np
import pytest
from floors import knowing, wiped
from rooms import room

from rumba_cleaning.planning.simulate.compiled_passes import BEFORE, NEVER, gain, passed
from rumba_cleaning.planning.simulate.compiled_rehearsal import SPEED
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE, SWEEPABLE

START = Pose(0.5, 0.5, 0.0)
SPEED_LIMIT = 0.3  # [m/s]
THERE_AND_BACK = Route(np.array([[0.5, 0.5], [1.6, 0.5], [1.6, 0.6], [0.6, 0.6], [0.6, 1.5]]),
                       np.array([0.3, 0.3, 0.3, 0.45]))


@pytest.fixture
def context():
    return wiped(knowing(room(3.0, 2.0, 0.05), START), (1.2, 0.0, 1.4, 2.0))


@pytest.fixture
def trace(context):
    return Rehearsal(context, START, THERE_AND_BACK)._trace


def drive(swept, trace):
    """Sweep along a trace, step by step, where the brushes are down; yields after each step."""
    for here, there in zip(trace, trace[1:]):
        if here[SPEED] <= SPEED_LIMIT:
            swept.sweep(here[:3], there[:3])
        yield


def swept_after(swept, *traces):
    """How many samples are swept after drives along traces."""
    swept = swept.copy()
    for trace in traces:
        for _ in drive(swept, trace):
            pass
    return round(swept.coverage * swept.reachable)


def steps_of(context, trace):
    """For each step of a trace, the samples that the brush passes, in one move: bool (rows, columns)."""
    swept = context.swept.copy()
    before = swept.brush.samples.copy()
    for _ in drive(swept, trace):
        yield swept.brush.samples != before
        before = swept.brush.samples.copy()


def test_each_sample_is_passed_first_and_last_when_the_brush_passes_it(context, trace):
    samples = context.swept.brush.samples
    first = np.where((samples & REACHABLE > 0) & (samples < PASS), NEVER, BEFORE)
    last = np.full(samples.shape, BEFORE)
    for step, is_passed in enumerate(steps_of(context, trace)):
        first[is_passed] = np.minimum(first[is_passed], step)
        last[is_passed] = step
    passes = passed(context.swept.brush, trace, SPEED_LIMIT)
    assert (passes.first == first).all() and (passes.last == last).all()
    assert (last >= 0).any() and (first == NEVER).any() and ((first == BEFORE) & (samples & REACHABLE > 0)).any()


def test_what_is_swept_at_no_other_time_is_counted_where_the_brush_passes_it(context, trace):
    times = np.zeros(context.swept.brush.samples.shape, int)
    fresh = (context.swept.brush.samples & REACHABLE > 0) & (context.swept.brush.samples < PASS)
    by_step = list(steps_of(context, trace))
    for is_passed in by_step:
        times += is_passed
    counted = Rehearsal(context, START, THERE_AND_BACK).alone * context.swept.reachable / context.swept.reachable_area
    expected = np.cumsum([0, *(np.count_nonzero(fresh & is_passed & (times == 1)) for is_passed in by_step)])
    assert expected[-1] > 1000 and counted[-1] == pytest.approx(expected[-1])
    assert all(np.abs(expected - each).min() < 1e-6 for each in counted) and (np.diff(counted) >= 0.0).all()


@pytest.mark.parametrize('low, high', [(0, 30), (20, 21), (25, 60), (70, 95)])
def test_a_part_of_a_trace_gains_what_no_other_part_sweeps(context, trace, low, high):
    brush = context.swept.brush
    passes, scratch = passed(brush, trace, SPEED_LIMIT), np.full(brush.samples.shape, SWEEPABLE, np.uint8)
    aside = trace[low:high + 1].copy()
    aside[:, 1] += 0.25
    rest = trace[:low + 1], trace[high:]
    whole, without, with_it = (swept_after(context.swept, *parts) for parts in ((trace,), rest, (*rest, aside)))
    assert gain(brush, passes, scratch, trace, low, high, trace[low:low + 1], SPEED_LIMIT) == without - whole
    found = gain(brush, passes, scratch, trace, low, high, aside, SPEED_LIMIT)
    assert found == pytest.approx(with_it - whole, abs=8)  # strides are longer than steps
    assert (scratch == SWEEPABLE).all()
