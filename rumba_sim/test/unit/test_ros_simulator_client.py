"""The client of a simulator and the publisher of its state, without a master."""

import math
import threading
import types

import pytest
import rospy

from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.settings.robot_config import DriveConfig, RobotConfig
from rumba_sim.ros.participants import simulator_client
from rumba_sim.ros.participants.simulator_client import SimulatorClient, robot_config
from rumba_sim.ros.robot import state_publisher
from rumba_sim.ros.simulator.settings import Settings


class Subscriber:
    """Stands in for that of rospy: hands over what the test publishes."""

    def __init__(self, topic, kind, callback):
        self.resolved_name, self.callback, self.is_open = f'/upstairs/{topic}', callback, True
        assert kind is SimulatorState

    def unregister(self):
        self.is_open = False


@pytest.fixture()
def connected(monkeypatch):
    """A client whose subscriber is not at a master, and the states that it passes on."""
    monkeypatch.setattr(simulator_client.rospy, 'Subscriber', Subscriber)
    monkeypatch.setattr(simulator_client.rospy, 'is_shutdown', lambda: False)
    passed_on = []
    return SimulatorClient(passed_on.append), passed_on


def test_the_newest_state_is_kept_and_passed_on(connected):
    client, passed_on = connected
    assert client.state is None
    states = [SimulatorState(tick=1), SimulatorState(tick=2)]
    for state in states:
        client._subscriber.callback(state)
    assert client.state is client.wait() is states[1]
    assert passed_on == states
    client.close()
    assert not client._subscriber.is_open


def test_waiting_ends_with_the_first_state(connected):
    client, _ = connected
    first = SimulatorState(tick=7)
    timer = threading.Timer(0.2, client._subscriber.callback, [first])
    timer.start()
    assert client.wait(30.0) is first


def test_without_a_simulator_the_message_names_the_topic(connected):
    message = r'^no simulator publishes /upstairs/simulator/state: start one, or name a map: _map:=studio$'
    with pytest.raises(MapError, match=message):
        connected[0].wait(0.2)


def test_waiting_ends_with_the_node(connected, monkeypatch):
    monkeypatch.setattr(simulator_client.rospy, 'is_shutdown', lambda: True)
    with pytest.raises(rospy.ROSInterruptException):
        connected[0].wait(30.0)


def given(monkeypatch, parameters):
    """Let the parameter server hold parameters of /sim2."""
    monkeypatch.setattr(simulator_client.rospy, 'get_param',
                        lambda name, default: {'/sim2/settings': parameters}.get(name, default))


def test_what_the_robots_are_like_comes_from_the_settings_of_the_node(monkeypatch):
    given(monkeypatch, {'drive': {'max_speed': 0.3}, 'battery': {'drain': 7}, 'map': 'studio', 'speed': 2.0})
    found = robot_config('/sim2')
    assert (found.drive.max_speed, found.battery.drain) == (0.3, 7.0)
    assert found.drive.radius == DriveConfig.radius
    assert robot_config('/other') == RobotConfig()


def test_settings_that_cannot_be_are_refused_by_their_name(monkeypatch):
    given(monkeypatch, {'drive': {'max_speed': 'fast'}})
    with pytest.raises(ConfigError, match=r"^parameter /sim2/settings: drive/max_speed is 'fast': must be 0.01 to 10 "):
        robot_config('/sim2')


@pytest.mark.parametrize('value', ['text', 'drive', 5, ['drive']])
def test_settings_that_are_no_mapping_are_refused(monkeypatch, value):
    given(monkeypatch, value)
    with pytest.raises(ConfigError, match=r'^parameter /sim2/settings is .*: must be the settings of a simulator$'):
        robot_config('/sim2')


# --- the publisher ----------------------------------------------------------------------------------------------------

@pytest.fixture()
def master(monkeypatch):
    """What a state publisher gives to ROS, and a clock that the test sets."""
    master = types.SimpleNamespace(messages=[], parameters={}, now=100.0)
    monkeypatch.setattr(state_publisher.rospy, 'Publisher', lambda topic, kind, **options: types.SimpleNamespace(
        publish=master.messages.append, options=options, topic=topic))
    monkeypatch.setattr(state_publisher.rospy, 'set_param', master.parameters.__setitem__)
    monkeypatch.setattr(state_publisher.rospy, 'get_name', lambda: '/sim2')
    monkeypatch.setattr(state_publisher.time, 'monotonic', lambda: master.now)
    return master


def test_the_state_says_all_that_others_need(master):
    state = state_publisher.StatePublisher(Settings(seed=7), '/maps/a.yaml', 50, True)
    state.publish(3, rospy.Time(0, 60_000_000), True, 10.0)
    message, = master.messages
    assert (message.node, message.map, message.seed, message.step_rate) == ('/sim2', '/maps/a.yaml', 7, 50)
    assert (message.tick, message.header.stamp.to_nsec(), message.header.frame_id) == (3, 60_000_000, '')
    assert (message.is_paused, message.speed, message.is_time_simulated) == (True, 10.0, True)
    assert state._publisher.topic == 'simulator/state'
    assert state._publisher.options['latch']
    assert master.parameters['~settings']['drive']['max_speed'] == 0.5


def test_a_node_that_something_else_moves_has_no_speed_of_its_own(master):
    state_publisher.StatePublisher(Settings(), '/maps/a.yaml', 62.5, False).publish(3, rospy.Time(1))
    message, = master.messages
    assert math.isnan(message.speed)
    assert (message.is_paused, message.is_time_simulated) == (False, False)


def test_the_real_time_factor_is_that_of_the_last_full_second(master):
    state = state_publisher.StatePublisher(Settings(), '/maps/a.yaml', 50, True)
    assert state.due == 101.0
    for now, ticks, factor in ((100.5, 100, 0.0), (101.0, 250, 5.0), (101.2, 250, 5.0), (102.5, 400, 2.0),
                               (103.5, 400, 0.0)):
        master.now = now
        state.publish(ticks, rospy.Time(1))
        assert master.messages[-1].real_time_factor == state.real_time_factor == pytest.approx(factor)
    assert state.due == 104.5


def test_settings_that_changed_are_told_again(master):
    state_publisher.tell_settings(Settings(speed=4.0))
    assert master.parameters['~settings']['speed'] == 4.0
