"""Messages as JSON and back, by rosbridge's rules; on messages of the installed packages."""

import json
import math

import pytest

pytest.importorskip('genpy', reason='needs the messages of ROS')

from geometry_msgs.msg import PoseWithCovariance, Twist  # noqa: E402
from nav_msgs.msg import OccupancyGrid, Odometry  # noqa: E402
from sensor_msgs.msg import BatteryState, Image, LaserScan  # noqa: E402
from std_msgs.msg import Char, Duration, Header, Int8, Int64, String, UInt8  # noqa: E402

from rumba_msg.msg import CleanActionGoal, SimulatorState  # noqa: E402
from rumba_viewer.page.messages import conversion, filling  # noqa: E402
from rumba_viewer.page.messages.errors import Refusal  # noqa: E402
from rumba_viewer.ros.page.rosapi import types  # noqa: E402

FILLER = filling.Filler(types.of_message, lambda: (12, 34))


def back(message):
    """A message after a way through JSON, both ways."""
    values = json.loads(conversion.to_text(message))
    assert values == json.loads(json.dumps(conversion.to_json(message), allow_nan=False))
    return FILLER.fill(type(message)(), values)


@pytest.mark.parametrize('message', [
    Twist(), Odometry(), OccupancyGrid(data=[-1, 0, 100]), SimulatorState(seed=-5, map='/a'), CleanActionGoal(),
    PoseWithCovariance(covariance=[float(number) for number in range(36)]), Image(data=bytes(range(256)), width=16),
    LaserScan(ranges=[1.5, 2.25]), Int64(-(1 << 63)), Char(200), String('ä"\\\n'), Header(seq=7, frame_id='map')],
    ids=lambda message: message._type)
def test_a_message_comes_back_as_it_was(message):
    assert back(message) == message


def test_what_json_cannot_express_is_null_and_comes_back_as_nan():
    values = conversion.to_json(LaserScan(ranges=[math.inf, 1.0, -math.inf, math.nan], range_max=math.inf))
    assert values['ranges'] == [None, 1.0, None, None] and values['range_max'] is None
    assert math.isnan(FILLER.fill(BatteryState(), {'voltage': None}).voltage)


def test_lists_of_bytes_are_base64_and_a_list_of_numbers_is_taken_too():
    assert conversion.to_json(Image(data=b'\x00\xff\x10'))['data'] == 'AP8Q'
    assert FILLER.fill(Image(), {'data': 'AP8Q'}).data == FILLER.fill(Image(), {'data': [0, 255, 16]}).data


def test_a_header_without_a_stamp_gets_the_time_and_a_given_stamp_stays():
    assert FILLER.fill(Odometry(), {}).header.stamp.to_nsec() == 12_000_000_034
    given = FILLER.fill(Odometry(), {'header': {'stamp': {'secs': 1, 'nsecs': 2}}})
    assert given.header.stamp.to_nsec() == 1_000_000_002


@pytest.mark.parametrize('kind, values, line', [
    (Twist, {'linear': {'x': 'fast'}}, r"linear\.x is 'fast': must be a number"),
    (Twist, {'linear': {'x': True}}, r'linear\.x is True: must be a number'),
    (Twist, {'lineal': {}}, r'lineal is no field of geometry_msgs/Twist: it has linear, angular'),
    (Twist, {'linear': 3}, r'linear is 3: must be an object with the fields of geometry_msgs/Vector3'),
    (Twist, [], r'msg is \[\]: must be an object'),
    (Twist, {'linear': {'x': 10 ** 400}}, r'linear\.x is too large for float64'),
    (UInt8, {'data': 256}, r'data is 256: must be an integer from 0 to 255'),
    (Int8, {'data': 1.0}, r'data is 1\.0: must be an integer from -128 to 127'),
    (String, {'data': 5}, r'data is 5: must be a text'),
    (Duration, {'data': {'secs': 'soon'}}, r'data is .* must be an object with the integers secs and nsecs'),
    (Image, {'data': 'not base64!'}, r"data is 'not base64!': must be base64"),
    (LaserScan, {'ranges': 7}, r'ranges is 7: must be a list of float32'),
    (PoseWithCovariance, {'covariance': [1.0]}, r'covariance has 1 elements: must have 36')])
def test_a_value_that_does_not_fit_is_named(kind, values, line):
    with pytest.raises(Refusal, match=line):
        FILLER.fill(kind(), values)
