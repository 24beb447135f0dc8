"""Does a robot do what it is commanded? By odometry that lags, errs, is reversed, or stands."""

import math

import pytest

from rumba_cleaning.own_robot.agreement import GOES_BACK, STANDS, TURNS_BACK, Agreement
from rumba_sim.model.common.geometry import Pose

DT = 0.05  # [s]


def verdicts(commands, turn=1.0, way=1.0, lag=0.3):
    """What is said of a robot that does what commands say, (v, w, duration [s]) each, after a lag [s], by a factor."""
    agreement, pose, found, now = Agreement(), Pose(0.0, 0.0, 0.0), [], 0.0
    waiting = [(0.0, 0.0)] * int(lag / DT)
    for v, w, duration in commands:
        for _ in range(int(duration / DT)):
            agreement.command(v, w)
            waiting.append((v, w))
            really_v, really_w = waiting.pop(0)
            theta = pose.theta + turn * really_w * DT
            step = way * really_v * DT
            pose = Pose(pose.x + step * math.cos(theta), pose.y + step * math.sin(theta), theta)
            now += DT
            found.append(agreement.observe(pose, now))
    return set(found) - {''}, agreement


WEAVING = [(0.2, w, 0.7) for w in (1.5, -1.5, 0.3, -1.0) * 5]


@pytest.mark.parametrize('commands', [
    [(0.2, 0.0, 5)], [(-0.2, 0.0, 5)], [(0.0, 1.0, 5)], [(0.2, -0.5, 5)], WEAVING, [(0.0, 1.5, 1), (0.0, -1.5, 4)]])
@pytest.mark.parametrize('factor', [1.0, 0.8])
def test_nothing_is_said_of_a_robot_that_lags_and_slips(commands, factor):
    assert verdicts(commands, factor, factor)[0] == set()


@pytest.mark.parametrize('commands, turn, way, said', [
    ([(0.0, 1.0, 3)], -1.0, 1.0, TURNS_BACK), ([(0.2, -0.5, 4)], -1.0, 1.0, TURNS_BACK),
    ([(0.2, 0.0, 3)], 1.0, -1.0, GOES_BACK), ([(-0.2, 0.0, 3)], 1.0, -1.0, GOES_BACK),
    ([(0.2, 0.0, 3)], 0.0, 0.0, STANDS), ([(0.0, -0.8, 3)], 0.0, 0.0, STANDS)])
def test_a_reversed_or_dead_odometry_is_named(commands, turn, way, said):
    assert verdicts(commands, turn, way)[0] == {said}


def test_it_knows_whether_turns_were_tested():
    assert not verdicts([(0.2, 0.0, 5)])[1].is_tested
    assert verdicts([(0.0, 1.0, 3)])[1].is_tested


def test_a_gap_in_the_odometry_begins_the_comparison_anew():
    agreement = Agreement()
    for count in range(100):
        agreement.command(0.0, 1.0)
        assert agreement.observe(Pose(0.0, 0.0, -0.1 * count), 2.0 * count) == ''
