"""The parts of the simulator's node that need no master: requests, rates, diagnostics, tuning, names of maps."""

import signal
import threading
import time
import types

import pytest
from diagnostic_updater import DiagnosticStatusWrapper

from rumba_sim.model.battery import Battery, BatteryConfig
from rumba_sim.model.errors import ConfigError, MapError, WorldError
from rumba_sim.ros.common import node
from rumba_sim.ros.common.requests import Requests
from rumba_sim.ros.simulator import diagnostics, reconfigure, simulator
from rumba_sim.ros.simulator.settings import TUNABLE, Rates, Settings


def in_thread(function):
    """What a function returns or raises in another thread, while this one goes on."""
    def run():
        try:
            result.append(function())
        except Exception as error:
            result.append(error)
    result = []
    thread = threading.Thread(target=run)
    thread.start()
    return thread, result


def test_requests_are_made_in_their_owners_thread_and_errors_go_to_who_asked():
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


def test_serving_ends_in_time_also_when_a_signal_takes_longer():
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


def test_a_signal_ends_ros_beside_the_main_thread_which_may_hold_a_lock_that_the_end_needs(monkeypatch):
    ended = []
    monkeypatch.setattr(node.rospy, 'signal_shutdown',
                        lambda reason: ended.append((reason, threading.current_thread())))
    node._shut_down(signal.SIGTERM, None)
    while not ended:
        time.sleep(0.001)
    [(reason, thread)] = ended
    assert reason == 'signal 15'
    assert thread is not threading.main_thread()


def test_a_rate_is_due_at_each_full_period():
    due = [tick for tick in range(1, 101) if Rates(scan=5).due(tick, 50).scan]
    assert due == list(range(10, 101, 10))
    assert not any(Rates(scan=0).due(tick, 50).scan for tick in range(1, 101))


def test_where_no_number_of_ticks_gives_a_rate_it_is_met_in_the_mean():
    due = [tick for tick in range(1, 626) if Rates(battery=5).due(tick, 62.5).battery]
    assert due[:4] == [13, 25, 38, 50]
    assert len(due) == 50


def test_a_rate_that_no_number_of_ticks_gives_is_refused():
    with pytest.raises(ConfigError, match=r'^rates/odom is 30: must divide step_rate, 100: one of 0, 1, 2, 4, 5, '):
        Settings(step_rate=100, rates=Rates(odom=30))
    assert Settings(step_rate=60, rates=Rates(30, 10, 10, 10, 5, 0)).rates.odom == 30


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


def test_a_map_goes_by_its_name_or_its_path():
    assert simulator.map_path('studio').endswith('/rumba_sim/maps/studio.yaml')
    assert simulator.map_path('some/where') == 'some/where'
    assert simulator.map_path('x.yaml') == 'x.yaml'
    with pytest.raises(MapError, match=r"^there is no map 'moon': give the path of .*, or one of apartment, field, "):
        simulator.map_path('moon')


@pytest.mark.parametrize('name', ['', 'a b', '/x', 'x/y', '1x', '_x', 'ä', 'xä', 'x\n', 'x٣'])
def test_what_is_no_name_for_a_robot(name):
    assert simulator.NAME.fullmatch(name) is None


@pytest.mark.parametrize('name', ['x', 'Rumba_2', 'r2_d2'])
def test_what_is_a_name_for_a_robot(name):
    assert simulator.NAME.fullmatch(name)
