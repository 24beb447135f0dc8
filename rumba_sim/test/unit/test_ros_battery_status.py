"""The time that the publisher of the lesson counts, and the line that its listener shows, without a master."""

import math

import pytest

from rumba_msg.msg import BatteryStatus
from rumba_sim.ros.battery_status_listener import describe
from rumba_sim.ros.battery_status_publisher import passed


@pytest.mark.parametrize('before, now, seconds', [
    (1.6e9, 1.6e9 + 0.25, 0.25), (5.0, 5.0, 0.0), (0.5, 100.5, 100.0),
    (None, 1.6e9, 0.0), (0.0, 1.6e9, 0.0), (0.0, 5.0, 0.0), (55.0, 1.6e9, 0.0),  # a clock that begins
    (1.6e9, 0.02, 0.0), (55.0, 54.9, 0.0)])  # one that begins again
def test_only_time_that_passes_on_one_clock_counts(before, now, seconds):
    assert passed(before, now) == seconds


def test_the_line_has_no_control_characters_whatever_the_message_is():
    line = describe(BatteryStatus(5, 1.0, 2.0, 0.0, True, 'a\x1b[2J\r\nb\x9b\u202e' + 1000 * 'c'))
    assert line.isprintable()
    assert line.startswith('battery   5 %   at (1.00, 2.00) m, 0 deg   brushes up   a\\x1b[2J\\r\\nb')
    assert len(line) < 400


def test_the_line_shows_numbers_that_are_not_finite():
    line = describe(BatteryStatus(-2 ** 63, math.inf, math.nan, -math.inf, False, ''))
    assert line.startswith('battery -9223372036854775808 %   at (inf, nan) m, -inf deg   brushes down')
