"""The estimate of what is left of a mission, and the mission in words."""

import math

import pytest
from pytest import approx

from rumba_viewer.scene import wording
from rumba_viewer.scene.forecast import GAP, LEAST, Forecast
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

REACHABLE = 20.0  # [m^2]


def mission(state='cleaning', strategy='boustrophedon'):
    """A mission in a state, by a strategy unless it is over."""
    return Mission(state, state not in ('idle', 'stranded'), strategy if state != 'idle' else '', '')


def cleaning(time, area, distance=math.nan):
    """The floor at a time."""
    return Cleaning(area / REACHABLE, area, REACHABLE, 0.5, time if math.isnan(distance) else distance, time)


def battery(share):
    """A battery with a charge."""
    return Battery(share, 15.0, -1.0, 'on battery')


def after(*moments, target=0.9):
    """A forecast after moments: time, area, charge and state of each."""
    forecast = Forecast(target)
    for time, area, share, state in moments:
        forecast.add(cleaning(time, area), battery(share), mission(state))
    return forecast


def test_what_is_left_follows_from_the_rate_so_far_and_the_rest_is_slower():
    forecast = after((0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, 0.9, 'cleaning'))
    # Of 18 m^2 there are 13 left, the last one of which takes three times as long: 15 m^2 at 0.1 m^2/s.
    assert forecast.left == approx(150.0) and forecast.elapsed == 50.0


def test_what_is_left_is_unknown_if_the_robot_drives_about_at_random():
    forecast = Forecast(0.9)
    for time, area in ((0.0, 0.0), (50.0, 5.0)):
        forecast.add(cleaning(time, area), battery(0.9), mission(strategy='wander'))
    assert forecast.left is None and forecast.elapsed == 50.0


def test_a_charge_that_is_needed_counts():
    forecast = after((0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, 0.5, 'cleaning'))
    # 150 s need 1.5 of charge and 0.38 are there: two charges from LEAST to 0.95, at the rate of the default battery.
    rate = 0.01 / (1.3 * (0.19 + 1.0 + 0.5) / 1.25)
    assert forecast.left == approx(150.0 + 2.0 * (0.95 - LEAST) / rate, rel=0.01)


def test_while_it_charges_the_rest_of_this_charge_counts_at_its_own_rate():
    forecast = after((0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, 0.5, 'returning'), (60.0, 5.0, 0.45, 'charging'),
                     (100.0, 5.0, 0.85, 'charging'))
    # Another 0.1 in 10 s; then 1.5 for 150 s, with 0.83 there: one more charge of 83 s.
    assert forecast.left == approx(10.0 + 150.0 + 83.0) and forecast.charges == 1
    assert forecast.elapsed == 100.0


def test_on_the_way_to_the_dock_a_charge_is_ahead_unless_the_floor_is_done():
    begin = (0.0, 0.0, 1.0, 'cleaning')
    low = after(begin, (50.0, 5.0, 0.95, 'returning'))
    assert low.left == approx(150.0, abs=0.1)  # at 0.95 there is nothing to charge
    done = after(begin, (50.0, 18.0, 0.2, 'returning'))
    assert done.left == 0.0


@pytest.mark.parametrize('moments', [
    [], [(0.0, 0.0, 1.0, 'cleaning')], [(0.0, 0.0, 1.0, 'cleaning'), (10.0, 5.0, 0.9, 'cleaning')],
    [(0.0, 0.0, 1.0, 'cleaning'), (50.0, 0.0, 0.9, 'cleaning')],
    [(0.0, 0.0, 1.0, 'cleaning'), (GAP + 1.0, 5.0, 0.9, 'cleaning')],
    [(0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, 0.9, 'cleaning'), (51.0, 5.0, 0.9, 'idle')],
    [(0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, 0.9, 'cleaning'), (2.0, 0.0, 0.9, 'cleaning')],
    [(0.0, math.nan, 1.0, 'cleaning'), (50.0, math.nan, 0.9, 'cleaning')]])
def test_what_is_left_is_unknown_without_enough_cleaning(moments):
    assert after(*moments).left is None


def test_an_unknown_battery_counts_as_one_that_lasts():
    forecast = after((0.0, 0.0, math.nan, 'cleaning'), (50.0, 5.0, math.nan, 'cleaning'))
    assert forecast.left is None or forecast.left == approx(150.0)


def test_a_new_mission_begins_anew():
    forecast = after((0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, 0.9, 'charging'), (60.0, 5.0, 0.9, 'idle'),
                     (70.0, 5.0, 0.9, 'undocking'), (75.0, 5.0, 0.9, 'cleaning'))
    assert (forecast.elapsed, forecast.charges, forecast.left) == (5.0, 0, None)


@pytest.mark.parametrize('seconds, told', [(0.0, '0:00'), (59.9, '0:59'), (754.0, '12:34'), (3754.0, '1:02:34')])
def test_times_in_words(seconds, told):
    assert wording.span(seconds) == told


@pytest.mark.parametrize('seconds, told', [(5.0, 'less than 1 min'), (61.0, 'about 2 min'), (7100.0, 'about 119 min'),
                                           (9000.0, 'about 2.5 h')])
def test_estimates_in_words(seconds, told):
    assert wording.about(seconds) == told


def test_a_share_below_a_target_does_not_read_like_it():
    assert [wording.percent(share, 1) for share in (0.98999, 0.99, math.nan)] == ['98.9 %', '99.0 %', '-']


def test_the_live_line_begins_with_what_matters_most():
    line = live_line(mission(), cleaning(50.0, 5.0), battery(0.64), 50.0, 1290.0)
    assert line == '25.0 % swept  battery 64 %  0:50, about 22 min left  cleaning by boustrophedon'
    assert live_line(mission('idle'), cleaning(50.0, 1.0), battery(0.64)) == ' 5.0 % swept  battery 64 %  idle'
    assert live_line(mission(), cleaning(50.0, 5.0), battery(0.64), left=1290.0) == (
        '25.0 % swept  battery 64 %  about 22 min left  cleaning by boustrophedon')
    assert live_line(None, None, battery(math.nan)) == 'no floor  battery -  no cleaner'


def live_line(mission, cleaning, battery, elapsed=None, left=None):
    """The longest line."""
    return wording.live_lines(mission, cleaning, battery, elapsed, left)[0]


def test_narrow_terminals_have_lines_that_keep_battery_and_time():
    now = mission()._replace(strategy='explore_and_clean')
    lines = wording.live_lines(now, cleaning(50.0, 20.0), battery(1.0), 4039.0, 7000.0)
    assert lines == ['100.0 % swept  battery 100 %  1:07:19, about 117 min left  cleaning by explore_and_clean',
                     '100.0 % swept  battery 100 %  1:07:19, about 117 min left  cleaning',
                     '100.0 % swept  battery 100 %  1:07:19  cleaning', '100.0 % swept  battery 100 %  1:07:19']
    assert len(lines[1]) < 80 and len(lines[-1]) < 40


@pytest.mark.parametrize('message', ['planning', '0.0 % swept; planning'])
def test_a_robot_that_stands_since_it_plans_is_said_to_plan(message):
    for state in ('undocking', 'cleaning'):
        assert live_line(mission(state)._replace(message=message), cleaning(50.0, 1.0), battery(0.64)).endswith(
            '64 %  planning')


def test_the_closing_report_names_what_was_done_in_this_mission():
    told = wording.closing('rumba', mission('idle'), cleaning(150.0, 18.0), battery(0.9), wording.Effort(50.0, 50.0, 1))
    assert told == ['rumba: 90.0 % of the floor is swept: 18.0 of 20.0 m², 50.0 % of the dirt is left',
                    '0:50, 50.0 m driven, 1 charge, battery 90 %']


@pytest.mark.parametrize('state, less, more', [('cleaning', 0.76, 0.79), ('charging', 0.7, 0.73)])
def test_the_charge_at_which_it_is_back_on_its_dock_is_not_to_be_spent(state, less, more):
    # 150 s need three times what 50 s took. All but LEAST can be spent of this charge, or of 0.95 after charging.
    one, none = (after((0.0, 0.0, 1.0, 'cleaning'), (50.0, 5.0, share, 'cleaning'), (50.0, 5.0, share, state)).left
                 for share in (less, more))
    assert one > 1.5 * none
