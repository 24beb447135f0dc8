"""Parts of nodes that need no master: requests, rates, diagnostics, tuning, paths."""

import dataclasses
import os
import signal
import threading
import time
import types

import pytest
import rospy
from diagnostic_updater import DiagnosticStatusWrapper

from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.common.errors import ConfigError, MapError, WorldError
from rumba_sim.model.common.name import NAME
from rumba_sim.model.settings.battery import Battery, BatteryConfig
from rumba_sim.ros.common import paths
from rumba_sim.ros.participants import maps
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot.latecomers import Latecomers
from rumba_sim.ros.running import node
from rumba_sim.ros.simulator import diagnostics, reconfigure
from rumba_sim.ros.simulator.settings import TUNABLE, Rates, Settings


def in_thread(function):
    """Run a function in another thread; returns the thread and a list for the result or the error."""
    def run():
        try:
            result.append(function())
        except Exception as error:
            result.append(error)
    result = []
    thread = threading.Thread(target=run)
    thread.start()
    return thread, result


def test_requests_are_made_in_the_thread_of_the_owner_and_errors_go_to_the_caller():
    requests = Requests()

    def fail():
        raise WorldError('no')
    asked = [in_thread(lambda: requests.call(threading.current_thread)), in_thread(lambda: requests.call(fail))]
    while any(thread.is_alive() for thread, _ in asked):
        requests.serve(time.monotonic() + 0.01)
    (_, [thread]), (_, [error]) = asked
    assert thread is threading.current_thread()
    assert isinstance(error, WorldError)
    assert requests.call(threading.current_thread) is threading.current_thread()


def test_an_error_in_what_was_posted_ends_the_loop_since_nobody_else_would_learn_of_it():
    requests, later = Requests(), []
    requests.post(lambda: later.append('before'))
    requests.post(lambda: {}['lost'])
    requests.post(lambda: later.append('after'))
    with pytest.raises(KeyError, match='lost'):
        requests.serve(time.monotonic())
    assert later == ['before']


def test_a_robot_that_is_removed_before_its_grid_is_sent_ends_nothing():
    requests = Requests()

    def closed(_):
        raise rospy.ROSException('publish() to a closed topic')
    Latecomers(requests, lambda: 'a message').peer_subscribe('coverage', None, closed)
    requests.serve(time.monotonic())


def test_latecomers_are_sent_what_there_is_at_that_time_if_there_is_anything():
    requests, sent, message = Requests(), [], None
    latecomers = Latecomers(requests, lambda: message)
    latecomers.peer_subscribe('scan', None, sent.append)
    requests.serve(time.monotonic())
    latecomers.peer_subscribe('scan', None, sent.append)
    message = 'newest'
    requests.serve(time.monotonic())
    assert sent == ['newest']


def test_latecomers_are_not_sent_again_what_was_published_since_they_came():
    requests, sent, published = Requests(), [], ['first']
    latecomers = Latecomers(requests, lambda: published[-1], lambda: published[-1])
    latecomers.peer_subscribe('scan', None, sent.append)
    requests.serve(time.monotonic())
    assert sent == ['first']
    latecomers.peer_subscribe('scan', None, sent.append)
    published.append('second')  # and sent to all connections, of which this is one
    requests.serve(time.monotonic())
    assert sent == ['first']


def test_serving_ends_after_the_call_that_was_enough():
    requests, called = Requests(), []
    for number in range(3):
        requests.post(lambda number=number: called.append(number))
    requests.serve(time.monotonic() + 60.0, lambda: len(called) == 2)
    assert called == [0, 1]


def test_serving_ends_in_time_even_if_the_handler_of_a_signal_takes_longer():
    requests = Requests()
    before = signal.signal(signal.SIGALRM, lambda *_: time.sleep(0.3))
    waker = threading.Timer(5.0, requests.post, [lambda: None])
    waker.start()
    begin = time.monotonic()
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        requests.serve(time.monotonic() + 0.2)
        assert time.monotonic() - begin < 4.0
    finally:
        waker.cancel()
        signal.signal(signal.SIGALRM, before)


def test_a_signal_ends_ros_in_another_thread_since_the_main_thread_may_hold_a_lock(monkeypatch):
    ended = []
    monkeypatch.setattr(node.rospy, 'signal_shutdown',
                        lambda reason: ended.append((reason, threading.current_thread())))
    node._shut_down(signal.SIGTERM, None)
    while not ended:
        time.sleep(0.001)
    [(reason, thread)] = ended
    assert reason == 'signal 15'
    assert thread is not threading.main_thread()


def test_a_rate_is_due_at_the_first_tick_and_after_each_full_period():
    due = [tick for tick in range(1, 101) if Rates(scan=5).due(tick, 50).scan]
    assert due == list(range(1, 101, 10))
    assert not any(Rates(scan=0).due(tick, 50).scan for tick in range(1, 101))


def test_a_rate_whose_period_is_no_whole_number_of_ticks_is_met_on_average():
    due = [tick for tick in range(1, 626) if Rates(battery=5).due(tick, 62.5).battery]
    assert due[:4] == [1, 14, 26, 39]
    assert len(due) == 50


def test_the_simulator_refuses_a_rate_whose_period_is_no_whole_number_of_ticks():
    with pytest.raises(ConfigError, match=r'^rates/odom is 30: must divide step_rate, 100: one of 0, 1, 2, 4, 5, '):
        Settings(step_rate=100, rates=Rates(odom=30))
    assert Settings(step_rate=60, rates=Rates(30, 10, 10, 10, 5, 0)).rates.odom == 30


@pytest.mark.parametrize('model, step_rate, wanted, rate', [
    ('ideal', 50, 25, 25), ('lds01', 50, 10, 5), ('lds01', 50, 2, 2), ('tim561', 60, 20, 15), ('lds01', 50, 0, 0)])
def test_scans_come_no_more_often_than_the_laser_turns(model, step_rate, wanted, rate):
    settings = from_mapping(Settings, {'laser': {'model': model}, 'step_rate': step_rate,
                                       'rates': {'scan': wanted, 'odom': 1, 'battery': 1}}, 'test')
    assert settings.paced_rates == dataclasses.replace(settings.rates, scan=rate)


@pytest.mark.parametrize('speed', [0.0005, 5e-324, 0.00099999])
def test_a_speed_at_which_time_would_seem_to_stand_still_is_refused(speed):
    with pytest.raises(ConfigError, match=rf'^speed is {speed:g}: must be 0, or 0.001 to 1000000$'):
        Settings(speed=speed)


@pytest.mark.parametrize('speed', [0.0, 0.001, 1e6])
def test_a_speed_of_zero_or_at_least_a_thousandth_is_valid(speed):
    assert Settings(speed=speed).speed == speed


@pytest.mark.parametrize('charge, level, message', [
    (1.0, DiagnosticStatusWrapper.OK, 'charged: 100 %'), (0.1, DiagnosticStatusWrapper.OK, 'charged: 10 %'),
    (0.09, DiagnosticStatusWrapper.WARN, 'low: 9 %'), (0.03, DiagnosticStatusWrapper.WARN, 'low: 3 %'),
    (0.02, DiagnosticStatusWrapper.ERROR, 'nearly empty: 2 %'), (0.0, DiagnosticStatusWrapper.ERROR, 'empty: 0 %')])
def test_the_battery_is_ok_low_or_nearly_empty(charge, level, message):
    robot = types.SimpleNamespace(battery=Battery(BatteryConfig(), charge, -0.69), is_docked=False)
    status = diagnostics.battery(DiagnosticStatusWrapper(), robot)
    assert (status.level, status.message) == (level, message)
    assert {value.key: value.value for value in status.values}['current [A]'] == '-0.69'


def test_what_can_be_tuned_is_described_by_the_settings_themselves():
    description = reconfigure.Description(Settings(), TUNABLE)
    by_name = {parameter['name']: parameter for parameter in description.config_description['parameters']}
    assert by_name['battery_drain']['max'] == 1e4
    assert by_name['rates_scan']['type'] == 'int'
    assert by_name['drive_command_timeout']['description'].endswith('[s]')
    assert description.defaults['speed'] == 1.0
    assert len(by_name) == len(TUNABLE)


def test_paths_become_sections():
    assert reconfigure.nested({'speed': 2, 'battery/drain': 3, 'battery/capacity': 4}) == {
        'speed': 2, 'battery': {'drain': 3, 'capacity': 4}}
    assert reconfigure.value_at(Settings(), 'battery/drain') == 1.0


def test_a_map_is_given_by_its_name_or_its_path(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv('PWD', str(tmp_path))
    assert maps.map_path('studio').endswith('/rumba_sim/maps/studio.yaml')
    for path in ('some/where', 'x.yaml', './y.yml'):
        assert maps.map_path(path) == os.path.normpath(tmp_path / path)
    assert maps.map_path('/some/where.yaml') == '/some/where.yaml'
    with pytest.raises(MapError, match=r"^there is no map 'moon': give .*, or one of apartment, apartment_docks, "):
        maps.map_path('moon')


def test_a_relative_path_begins_at_the_working_folder_or_where_roslaunch_was_started(monkeypatch, tmp_path):
    working, launched = tmp_path / 'working', tmp_path / 'launched'
    for folder in (working, launched):
        folder.mkdir()
        (folder / 'both.yaml').touch()
    (launched / 'one.yaml').touch()
    monkeypatch.chdir(working)
    monkeypatch.setenv('PWD', str(launched))
    assert paths.absolute('both.yaml') == str(working / 'both.yaml')
    assert paths.absolute('one.yaml') == paths.absolute('../launched/one.yaml') == str(launched / 'one.yaml')
    assert paths.absolute('none.yaml') == str(launched / 'none.yaml')
    assert paths.absolute('/none.yaml') == '/none.yaml'
    monkeypatch.delenv('PWD')
    assert paths.absolute('one.yaml') == str(working / 'one.yaml')


@pytest.mark.parametrize('name', ['', 'a b', '/x', 'x/y', '1x', '_x', 'ä', 'xä', 'x\n', 'x٣', 65 * 'x'])
def test_invalid_names_of_a_robot(name):
    assert NAME.fullmatch(name) is None


@pytest.mark.parametrize('name', ['x', 'Rumba_2', 'r2_d2', 64 * 'x'])
def test_valid_names_of_a_robot(name):
    assert NAME.fullmatch(name)
