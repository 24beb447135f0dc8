"""What the readings of a laser mean: every kind that drivers send."""

import math
import types

import numpy as np
import pytest

from rumba_localisation.scan import DENSE, FARTHEST, Reading, fault, scan_of, told
from rumba_sim.model.settings.mounting import Mounting

RIGHT, AHEAD, LEFT = (0.0, -1.0), (1.0, 0.0), (0.0, 1.0)  # directions
QUARTER = 0.5 * math.pi
ECHO, FREE, NOTHING = 'echo', 'free', 'nothing'


def three(ranges, **options):
    """A scan of three beams: to the right, ahead and to the left, by a laser that sees from 0.1 to 8 m."""
    return scan_of(np.array(ranges, np.float32), -QUARTER, QUARTER, 8.0, 0.1, **options)


def room_scan(reading, count=360):
    """A scan amidst walls that are 2 m away, the first beam of which tells something else."""
    ranges = np.full(count, 2.0, np.float32)
    ranges[0] = reading
    return scan_of(ranges, 0.0, 2.0 * math.pi / count, 8.0, 0.1)


@pytest.mark.parametrize('reading, meaning', [
    (1.0, ECHO), (0.1001, ECHO), (7.99, ECHO),
    (math.inf, FREE), (8.0, FREE), (8.1, FREE), (80.0, FREE), (1e5, FREE), (1e30, FREE),
    (math.nan, NOTHING), (-math.inf, NOTHING), (0.0, NOTHING), (-1.0, NOTHING), (0.05, NOTHING), (0.0999, NOTHING)])
def test_each_reading_means_an_echo_or_free_floor_or_nothing(reading, meaning):
    seen = room_scan(reading)
    assert len(seen.points) == 359 + (meaning == ECHO)
    assert len(seen.beyond) == (meaning == FREE)
    assert np.isfinite(seen.points).all() and np.isfinite(seen.beyond).all()


@pytest.mark.parametrize('reading', [0.0, 1e-30, 1e-38, 1e-4])
def test_a_range_that_is_no_length_tells_nothing_even_if_the_laser_says_that_it_sees_so_near(reading):
    seen = scan_of(np.array([reading, 2.0, 2.0], np.float32), 0.0, 1.0, 8.0, 0.0)
    assert len(seen.points) == 2


def test_a_beam_without_an_echo_is_free_no_farther_than_the_echoes_beside_it_show():
    seen = room_scan(math.inf)
    assert seen.beyond == pytest.approx(np.array([[2.0 * math.cos(math.pi / 180.0), 0.0]]))


def test_a_missing_pane_is_free_as_far_as_the_line_between_its_sides():
    angles = np.radians(np.arange(-90, 91))
    wall = 1.0 / np.cos(np.radians(np.arange(-90, 91)).clip(-1.4, 1.4))  # straight ahead, at 1 m
    wall[abs(angles) < math.radians(25.0)] = np.inf
    seen = scan_of(wall.astype(np.float32), -QUARTER, math.radians(1.0), 8.0)
    assert len(seen.beyond) == 49 and seen.beyond[:, 0] == pytest.approx(np.ones(49), abs=1e-5)


@pytest.mark.parametrize('gap', [70, 180, 359, 360])
def test_between_echoes_that_are_far_apart_nothing_is_believed_to_be_free(gap):
    ranges = np.full(360, 2.0, np.float32)
    ranges[:gap] = np.inf
    assert not len(scan_of(ranges, 0.0, math.radians(1.0), 8.0).beyond)


def test_beside_the_first_beam_of_a_full_turn_is_the_last_and_beside_that_of_a_part_of_one_is_none():
    ranges = np.full(360, 2.0, np.float32)
    ranges[[0, 1, 359]] = np.inf
    assert len(scan_of(ranges, -math.pi, math.radians(1.0), 8.0).beyond) == 3
    assert not len(scan_of(ranges, -math.pi, math.radians(0.5), 8.0).beyond)


def test_people_can_say_how_far_a_beam_without_an_echo_is_free_and_which_ranges_count():
    assert three([1.0, math.inf, 9.0], reading=Reading(usable=5.0)).beyond == pytest.approx(
        np.array([[5.0, 0.0], [0.0, 5.0]]), abs=1e-6)
    assert three([1.0, 3.0, 5.0], reading=Reading(min_range=2.0, max_range=4.0)).points == pytest.approx(
        np.array([[3.0, 0.0]]))


@pytest.mark.parametrize('mounting, expected', [
    (Mounting(), [RIGHT, (2.0, 0.0), (0.0, 3.0)]),
    (Mounting(0.1, -0.2), [(0.1, -1.2), (2.1, -0.2), (0.1, 2.8)]),
    (Mounting(yaw=math.pi), [LEFT, (-2.0, 0.0), (0.0, -3.0)]),
    (Mounting(0.1, 0.0, QUARTER), [(1.1, 0.0), (0.1, 2.0), (-2.9, 0.0)]),
    (Mounting(upside_down=True), [LEFT, (2.0, 0.0), (0.0, -3.0)]),
    (Mounting(0.0, 0.0, QUARTER, True), [(-1.0, 0.0), (0.0, 2.0), (3.0, 0.0)])])
def test_points_are_where_beams_end_in_the_frame_of_the_robot_wherever_the_laser_is(mounting, expected):
    seen = three([1.0, 2.0, 3.0], mounting=mounting)
    assert seen.points == pytest.approx(np.array(expected), abs=1e-6)
    assert seen.laser == (mounting.x, mounting.y)


@pytest.mark.parametrize('degrees, step', [
    (90.0, 0.1), (90.0, 2.0), (180.0, 1.0), (240.0, 0.352), (270.0, 0.33), (360.0, 1.0), (400.0, 1.0)])
@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_any_field_of_view_any_step_and_either_direction_of_turning_tell_the_same_walls(degrees, step, sign):
    count = round(degrees / step) + 1
    ranges = np.full(count, 2.0, np.float32)
    ranges[count // 2] = np.inf
    seen = scan_of(ranges, sign * math.radians(-0.5 * degrees), sign * math.radians(step), 8.0)
    assert len(seen.points) == count - 1 and np.hypot(*seen.points.T) == pytest.approx(np.full(count - 1, 2.0))
    assert seen.beyond == pytest.approx(np.array([[2.0, 0.0]]), abs=0.04)


def test_of_very_many_beams_some_are_left_out():
    seen = scan_of(np.full(100_000, 2.0, np.float32), 0.0, 2.0 * math.pi / 100_000, 8.0)
    assert 0.5 * DENSE <= len(seen.points) <= DENSE
    assert seen.points[-1] == pytest.approx([2.0, 0.0], abs=0.01)


def test_no_range_is_farther_than_any_laser_sees():
    ranges = np.array([1.0, 90.0, 1e6, 1.0], np.float32)
    seen = scan_of(ranges, 0.0, 0.1, math.inf)
    assert len(seen.points) == 3 and np.hypot(*seen.points.T).max() < FARTHEST


@pytest.mark.parametrize('ranges', [[], [math.nan], [math.inf] * 360, [math.nan] * 360, [0.0] * 360, [1.0]])
def test_scans_that_tell_little_or_nothing_are_no_fault(ranges):
    seen = scan_of(np.array(ranges, np.float32), 0.0, 0.1, 8.0)
    assert len(seen.points) == ranges.count(1.0) and not len(seen.beyond)


def message(**fields):
    """A sensor_msgs/LaserScan, as far as is looked at."""
    return types.SimpleNamespace(**{**{
        'angle_min': -QUARTER, 'angle_increment': QUARTER, 'range_min': 0.1, 'range_max': 8.0,
        'ranges': (1.0, 2.0, 3.0)}, **fields})


@pytest.mark.parametrize('fields, expected', [
    ({'angle_min': math.nan}, 'angle_min is nan: must be a number'),
    ({'angle_increment': math.inf}, 'angle_increment is inf: must be a number'),
    ({'angle_increment': 0.0}, 'angle_increment is 0: must be the angle from beam to beam'),
    ({'range_min': math.nan}, 'range_min is nan: must be a number'),
    ({'range_max': math.nan}, 'range_max is nan: must be a number'),
    ({'range_max': 0.0}, 'range_max is 0: must be above 0 and above range_min, 0.1'),
    ({'range_max': -math.inf}, 'range_max is -inf: must be above 0 and above range_min, 0.1'),
    ({'range_min': math.inf}, 'range_max is 8: must be above 0 and above range_min, inf')])
def test_what_cannot_be_used_is_named(fields, expected):
    assert fault(message(**fields)) == expected
    assert told(message(**fields)) is None


def test_a_message_that_can_be_used_tells_a_scan():
    assert fault(message()) is None
    assert told(message()).points == pytest.approx(np.array([[0.0, -1.0], [2.0, 0.0], [0.0, 3.0]]), abs=1e-6)
    assert len(told(message(range_min=-1.0, range_max=math.inf)).points) == 3
