"""A context hands out work on copies of what it knows, and gives a mission a target of its own."""

import concurrent.futures

import numpy as np
import pytest
from rooms import quiet, room

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.common.geometry import Pose

PLAN = room(4.0, 3.0)


def knowing(executor=None):
    """A context that begins at a pose."""
    context = Context(PLAN, quiet(), CleaningConfig(target_coverage=0.7), executor=executor)
    context.swept.begin(1.0, 1.0)
    return context


def test_without_an_executor_work_is_done_at_once():
    future = knowing().submit(lambda context, *numbers: (context.plan, sum(numbers)), 2, 3)
    assert future.done() and future.result() == (PLAN.refined(), 5)


def test_an_exception_comes_with_the_result():
    future = knowing().submit(lambda context: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        future.result()


def test_work_is_given_to_the_executor():
    with concurrent.futures.ThreadPoolExecutor(1) as executor:
        context = knowing(executor)
        assert context.executor is executor
        assert context.submit(lambda other: other.target_coverage).result(10.0) == 0.7


def test_work_does_not_see_what_the_robot_meets_and_sweeps_later():
    context = knowing()
    other = context.submit(lambda copy: copy).result()
    context.ground.mark(2.0, 1.5, 0.1)
    context.swept.sweep(Pose(1.0, 1.0, 0.0), Pose(1.4, 1.0, 0.0))
    assert (other.ground.clearance == PLAN.refined().safe_clearance).all() and not other.ground.has_marks
    assert other.swept.coverage == 0.0 < context.swept.coverage


@pytest.mark.parametrize('name', ['sight', 'cliff_map', 'generator'])
def test_work_cannot_use_what_changes_meanwhile_and_is_not_copied(name):
    context = knowing()
    with pytest.raises(AttributeError, match=name):
        context.submit(lambda other: getattr(other, name)).result()
    assert hasattr(context, name)


def test_work_changes_nothing_that_the_robot_knows():
    context = knowing()
    context.ground.mark(2.0, 1.5, 0.1)
    clearance = context.ground.clearance.copy()

    def spoil(other):
        other.ground.mark(1.0, 1.0, 0.1)
        other.swept.sweep(Pose(1.0, 1.0, 0.0), Pose(1.4, 1.0, 0.0))
        assert not np.array_equal(other.ground.clearance, clearance)
        other.ground.forget()

    context.submit(spoil).result()
    assert np.array_equal(context.ground.clearance, clearance) and context.ground.has_marks
    assert context.swept.coverage == 0.0


def test_a_context_with_another_target_shares_the_rest():
    context = knowing()
    other = context.with_target(0.5)
    assert (context.target_coverage, other.target_coverage) == (0.7, 0.5)
    assert other.config is context.config and other.config.target_coverage == 0.7
    assert all(getattr(other, name) is getattr(context, name)
               for name in ('plan', 'robot', 'generator', 'executor', 'ground', 'mates', 'swept'))
