"""The stamps of a simulator and when its ticks are due, whatever happens to the clock of the machine."""

import types

import pytest

from rumba_sim.ros.simulator import pace

START = 1_800_000_000_000_000_000  # [ns]
TICK = 20_000_000


@pytest.fixture()
def clocks(monkeypatch):
    """The clocks of a machine, which the test sets, and what was logged."""
    clocks = types.SimpleNamespace(wall=START, monotonic=5_000_000_000, log=[], published=[])

    def wall():
        clocks.wall, clocks.monotonic = clocks.wall + clocks.gap, clocks.monotonic + clocks.gap
        return clocks.wall
    clocks.gap = 0
    monkeypatch.setattr(pace, 'time', types.SimpleNamespace(
        time_ns=wall, monotonic_ns=lambda: clocks.monotonic, monotonic=lambda: clocks.monotonic / 1e9,
        time=lambda: clocks.wall / 1e9))
    monkeypatch.setattr(pace.rospy, 'logwarn', clocks.log.append)
    monkeypatch.setattr(pace.rospy, 'Publisher', lambda *_, **__: types.SimpleNamespace(
        get_num_connections=lambda: 1, publish=clocks.published.append))
    return clocks


def stamps(paced, clocks, ticks):
    """The stamps of ticks [ns] that come in time."""
    found = []
    for _ in range(ticks):
        clocks.wall += TICK
        clocks.monotonic += TICK
        paced.tick()
        found.append(paced.stamp.to_nsec())
    return found


def test_in_real_time_stamps_are_those_of_the_wall_clock(clocks):
    paced = pace.Pace(50, 1.0, False)
    assert paced.stamp.to_nsec() == START
    assert stamps(paced, clocks, 100) == [START + number * TICK for number in range(1, 101)]
    assert not clocks.log


def test_if_the_wall_clock_is_set_back_stamps_go_on_and_it_is_said_once(clocks):
    paced = pace.Pace(50, 1.0, False)
    clocks.wall -= 30_000_000_000
    assert stamps(paced, clocks, 100) == [START + number * TICK for number in range(1, 101)]
    line, = clocks.log
    assert line.startswith('the wall clock was set back by 30.0 s: stamps go on from where they were')


def test_if_the_wall_clock_is_set_forward_stamps_follow(clocks):
    paced = pace.Pace(50, 1.0, False)
    clocks.wall += 30_000_000_000
    assert stamps(paced, clocks, 2) == [START + 30_000_000_000 + number * TICK for number in (1, 2)]
    assert not clocks.log


def test_stamps_are_never_ahead_of_the_wall_clock_if_the_process_is_interrupted_between_two_looks(clocks):
    paced = pace.Pace(50, 1.0, False)
    for number in range(1, 50):
        clocks.gap = number * 1_000_000
        paced.tick()
        assert paced.stamp.to_nsec() <= clocks.wall


def test_simulated_time_counts_ticks_and_goes_on_after_those_that_passed_before(clocks):
    paced = pace.Pace(50, 10.0, True, 3000)
    assert paced.stamp.to_nsec() == 3001 * TICK
    assert stamps(paced, clocks, 3) == [number * TICK for number in (3001, 3002, 3003)]
    assert [stamp.to_nsec() for stamp in clocks.published] == [number * TICK for number in (3001, 3002, 3003)]


def test_a_new_speed_counts_at_once(clocks):
    paced = pace.Pace(50, 0.001, True)
    paced.next_tick()
    assert paced.due == pytest.approx(5.0 + 20.0)
    paced.speed = 0.001
    assert paced.due == pytest.approx(25.0)
    paced.speed = 10.0
    assert paced.due == pytest.approx(5.0)
    paced.next_tick()
    assert paced.due == pytest.approx(5.002)
