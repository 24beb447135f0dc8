"""Functions that run beside the cleaner, and plans, which the world waits for in lockstep."""

import threading
import time

import pytest
from drivers import Later

from rumba_cleaning.ros.cleaner.goals import executor


def test_functions_run_beside_their_caller_in_so_many_threads():
    gate, threads = threading.Event(), set()

    def wait_at_the_gate(number, *, factor):
        assert gate.wait(5.0)
        threads.add(threading.current_thread())
        return factor * number
    two = executor.DaemonExecutor(2)
    futures = [two.submit(wait_at_the_gate, number, factor=2) for number in range(4)]
    assert not any(future.done() for future in futures)
    assert futures[3].cancel()
    gate.set()
    assert [future.result(5.0) for future in futures[:3]] == [0, 2, 4]
    assert threading.current_thread() not in threads
    assert 1 <= len(threads) <= 2
    assert all(thread.daemon for thread in threads), 'the end of the process would wait for them'


def test_no_thread_is_started_as_long_as_one_is_free():
    """The C library keeps the memory of a plan for each thread in which one was made."""
    many = executor.DaemonExecutor(4)
    for _ in range(50):
        first = many.submit(threading.current_thread).result(5.0)
        assert many.submit(threading.current_thread).result(5.0) is first
        with pytest.raises(ZeroDivisionError):
            many.submit(lambda: 1 / 0).result(5.0)
    begun, gate = threading.Event(), threading.Event()
    held = many.submit(lambda: begun.set() or gate.wait(5.0))
    assert begun.wait(5.0) and many.submit(threading.current_thread).result(5.0) is not first, 'that is at work'
    gate.set()
    assert held.result(5.0)


def test_an_exception_is_handed_over_and_the_thread_goes_on():
    one = executor.DaemonExecutor(1)
    with pytest.raises(ZeroDivisionError):
        one.submit(lambda: 1 / 0).result(5.0)
    assert one.submit(lambda: 1).result(5.0) == 1


class Planning:
    """Planners whose functions return when a test says so."""

    def __init__(self, is_lockstep=True):
        self.later = Later()
        self.done = 0
        self.planners = executor.Planners(self.later, lambda: is_lockstep, self._count)

    def _count(self):
        self.done += 1


def test_in_lockstep_a_plan_is_there_before_the_next_step_and_never_during_one():
    planning = Planning()
    future = planning.planners.submit(lambda: 'route')
    assert planning.planners.are_at_work
    planning.later.work()
    assert not planning.planners.are_at_work and planning.done == 1 and not future.done()
    planning.planners.deliver()
    assert future.result(0) == 'route'


def test_without_lockstep_a_plan_is_there_as_soon_as_it_is_made():
    planning = Planning(is_lockstep=False)
    future = planning.planners.submit(lambda: 'route')
    assert not planning.planners.are_at_work
    planning.later.work()
    assert future.result(0) == 'route' and planning.done == 0


def test_an_error_of_a_plan_goes_to_the_behaviour():
    done = threading.Event()
    planners = executor.Planners(executor.DaemonExecutor(1), lambda: True, done.set)
    future = planners.submit(lambda: 1 // 0)
    assert done.wait(30.0)
    planners.deliver()
    with pytest.raises(ZeroDivisionError):
        future.result(0)


@pytest.mark.parametrize('drop', [lambda planners, future: future.cancel(), lambda planners, _: planners.forget()])
def test_nobody_waits_for_a_plan_that_is_not_needed_any_more(drop):
    planning = Planning()
    future = planning.planners.submit(lambda: 'route')
    assert drop(planning.planners, future)
    assert not planning.planners.are_at_work
    planning.later.work()
    planning.planners.deliver()
    assert future.cancelled() or not future.done()
    assert not planning.planners.forget()


def test_a_world_does_not_wait_for_ever_for_a_plan(monkeypatch):
    planning = Planning()
    planning.planners.submit(lambda: 'route')
    begin = time.monotonic()
    monkeypatch.setattr(executor.time, 'monotonic', lambda: begin + executor.LONGEST + 1.0)
    assert not planning.planners.are_at_work
