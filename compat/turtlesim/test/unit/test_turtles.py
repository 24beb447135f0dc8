"""Turtles move by the documented equations, step by step, and walls stop them."""

import math

import pytest

from turtlesim.model.errors import TurtlesimError
from turtlesim.model.turtles import EXTENT, HOLD, STEP, Turtles, check_numbers

EXACT = 1e-12


def turtles(*poses):
    """Return turtles at these poses."""
    made = Turtles()
    for pose in poses:
        made.add(pose)
    return made


def test_the_field_has_the_documented_size_and_rate():
    assert EXTENT == pytest.approx(11.088889, abs=1e-6)
    assert 1.0 / STEP == pytest.approx(62.5)


def test_a_step_turns_first_then_goes_along_the_new_heading():
    one = turtles((2.0, 3.0, 0.3))
    one.command(0, (1.5, 0.0, 0.8))
    assert one.step()
    theta = 0.3 + 0.8 * 0.016
    expected = [2.0 + 1.5 * 0.016 * math.cos(theta), 3.0 + 1.5 * 0.016 * math.sin(theta), theta]
    assert one.poses[0].tolist() == pytest.approx(expected, abs=EXACT)


def test_linear_y_goes_to_the_left():
    one = turtles((5.0, 5.0, math.pi / 2.0))
    one.command(0, (0.0, 2.0, 0.0))
    one.step()
    assert one.poses[0].tolist() == pytest.approx([5.0 - 2.0 * 0.016, 5.0, math.pi / 2.0], abs=EXACT)


def test_forward_left_and_turning_together():
    one = turtles((5.0, 4.0, 2.0))
    one.command(0, (0.7, -0.4, -1.1))
    for _ in range(3):
        one.step()
    x, y, theta = 5.0, 4.0, 2.0
    for _ in range(3):
        theta -= 1.1 * 0.016
        x += 0.016 * (0.7 * math.cos(theta) + 0.4 * math.sin(theta))
        y += 0.016 * (0.7 * math.sin(theta) - 0.4 * math.cos(theta))
    assert one.poses[0].tolist() == pytest.approx([x, y, theta], abs=EXACT)


def test_a_circle_is_a_polygon_of_the_documented_radius():
    one = turtles((4.0, 5.0, 0.0))
    positions = []
    for step in range(1000):
        if step % 10 == 0:
            one.command(0, (1.0, 0.0, 0.5))
        one.step()
        positions.append(one.poses[0, :2].tolist())
    # Each step is a chord, turned by 0.008 rad from the one before.
    radius = 0.5 * 1.0 * 0.016 / math.sin(0.5 * 0.5 * 0.016)
    half = 0.5 * 0.5 * 0.016
    centre = 4.0 - radius * math.sin(half), 5.0 + radius * math.cos(half)
    for x, y in positions:
        assert math.hypot(x - centre[0], y - centre[1]) == pytest.approx(radius, abs=1e-9)


def test_a_command_is_held_for_the_steps_that_begin_within_a_second():
    assert (HOLD - 1) * STEP <= 1.0 < HOLD * STEP
    one = turtles((1.0, 5.0, 0.0))
    one.command(0, (2.0, 0.0, 0.0))
    for _ in range(HOLD):
        one.step()
        assert one.velocities[0].tolist() == [2.0, 0.0, 0.0]
    assert one.poses[0, 0] == pytest.approx(1.0 + 2.0 * 63 * 0.016)
    one.step()
    assert one.velocities[0].tolist() == [0.0, 0.0, 0.0]
    assert one.poses[0, 0] == pytest.approx(1.0 + 2.0 * 63 * 0.016)
    assert not one.step()


def test_a_new_command_replaces_the_last_one_and_lasts_for_a_second():
    one = turtles((1.0, 5.0, 0.0))
    one.command(0, (2.0, 0.0, 0.0))
    for _ in range(40):
        one.step()
    one.command(0, (0.5, 0.0, 0.0))
    for _ in range(100):
        one.step()
    assert one.poses[0, 0] == pytest.approx(1.0 + 40 * 0.016 * 2.0 + 63 * 0.016 * 0.5)


def test_each_turtle_stops_a_second_after_its_own_command():
    three = turtles((1.0, 1.0, 0.0), (2.0, 2.0, 0.0), (3.0, 3.0, 0.0))
    three.command(2, (1.0, 0.0, 0.0))
    for _ in range(30):
        three.step()
    three.command(0, (1.0, 0.0, 0.0))
    for _ in range(100):
        three.step()
    assert three.poses.tolist() == [pytest.approx([1.0 + 63 * 0.016, 1.0, 0.0]), [2.0, 2.0, 0.0],
                                    pytest.approx([3.0 + 63 * 0.016, 3.0, 0.0])]


def test_turtles_after_a_removed_one_keep_their_motion():
    three = turtles((1.0, 1.0, 0.0), (2.0, 2.0, 0.0), (3.0, 3.0, 0.0))
    three.command(2, (1.0, 0.0, 0.0))
    three.step()
    three.remove(0)
    for _ in range(100):
        three.step()
    assert three.poses.tolist() == [[2.0, 2.0, 0.0], pytest.approx([3.0 + 63 * 0.016, 3.0, 0.0])]


@pytest.mark.parametrize('theta, expected', [
    (math.pi, math.pi), (-math.pi, math.pi), (math.pi + 0.25, 0.25 - math.pi), (-math.pi - 0.25, math.pi - 0.25),
    (7.0, 7.0 - 2.0 * math.pi), (-100.0, -100.0 + 32.0 * math.pi), (0.1, 0.1), (-3.1, -3.1)])
def test_theta_is_kept_above_minus_pi_and_up_to_pi(theta, expected):
    one = turtles((1.0, 1.0, theta))
    assert one.poses[0, 2] == pytest.approx(expected, abs=1e-9)
    one.place(0, (1.0, 1.0, theta))
    assert one.poses[0, 2] == pytest.approx(expected, abs=1e-9)


def test_theta_wraps_while_turning_either_way():
    for rate in (3.0, -3.0):
        one = turtles((1.0, 1.0, 0.0))
        for step in range(1, 200):
            one.command(0, (0.0, 0.0, rate))
            one.step()
            assert -math.pi < one.poses[0, 2] <= math.pi
            assert math.remainder(one.poses[0, 2] - step * 0.016 * rate, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


def test_walls_stop_turtles_and_clamp_returns_where_they_would_be():
    four = turtles((5.0, 5.0, 0.0), (12.0, 3.0, 0.0), (4.0, -0.5, 0.0), (-1.0, 99.0, 0.0))
    assert four.clamp() == [(1, 12.0, 3.0), (2, 4.0, -0.5), (3, -1.0, 99.0)]
    assert four.poses[:, :2].tolist() == [[5.0, 5.0], [EXTENT, 3.0], [4.0, 0.0], [0.0, EXTENT]]
    assert four.clamp() == []


def test_an_empty_field_has_no_motion_and_no_hits():
    empty = Turtles()
    assert not empty.step() and empty.clamp() == []


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_a_number_that_no_pose_can_have_is_refused(bad):
    check_numbers('spawn', x=1.0, theta=-1e300)
    with pytest.raises(TurtlesimError, match=rf'^spawn: theta is {bad}: must be a finite number$'):
        check_numbers('spawn', x=1.0, theta=bad)
