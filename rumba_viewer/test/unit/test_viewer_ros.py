"""What the window makes of a simulator: its state, services, obstacles and robots, without a master."""

import math
import time

import numpy as np
import pytest
import rospy
from fake_topics import Topic
from hammering import hammer
from nav_msgs.msg import MapMetaData, OccupancyGrid
from pytest import approx
from std_msgs.msg import Header

from rumba_msg.msg import SimulatorState
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation import obstacle
from rumba_sim.ros.common.obstacle_markers import markers
from rumba_viewer.ros import listener
from rumba_viewer.ros.ros_graph import RosGraph, robots
from rumba_viewer.scene.snapshot import Obstacle

pytestmark = pytest.mark.usefixtures('topics')
STATE = SimulatorState(node='/sim2', speed=2.0, real_time_factor=1.9, is_time_simulated=True, map='/nowhere.yaml')
SERVICES = frozenset({'/sim2/reset', '/sim2/pause', '/sim2/tuning/set_parameters', '/rumba/teleport'})


@pytest.fixture
def simulation(monkeypatch):
    """A listener at a master that knows the services of sim2, and a function that gives it a state."""
    monkeypatch.setattr(listener, 'robot_config', lambda _: RobotConfig())
    one = listener.Listener('rumba', False)
    one._follow(RosGraph('a master', services=SERVICES, has_clock=True))
    return one


def after(one, **state):
    """What the window knows of the simulator after it published a state."""
    Topic.opened['simulator/state'].callback(
        SimulatorState(**{**{name: getattr(STATE, name) for name in STATE.__slots__}, **state}))
    return one.snapshot(time.monotonic()).simulation


def test_the_state_and_the_services_of_a_simulator_of_any_name(simulation):
    shown = after(simulation)
    assert (shown.node, shown.speed, shown.wanted, shown.is_paused, shown.is_simulated) == (
        '/sim2', 1.9, 2.0, False, True)
    assert shown.services == {'reset', 'pause', 'tuning/set_parameters'}
    assert after(simulation, is_paused=True).is_paused


def test_a_speed_that_the_simulator_does_not_decide_is_unknown(simulation):
    shown = after(simulation, speed=math.nan, real_time_factor=math.nan)
    assert shown.speed is shown.wanted is None


def test_each_state_is_news_and_so_is_the_silence_of_a_simulator(simulation):
    now = time.monotonic()
    simulation.snapshot(now)
    assert not simulation.has_news(now)
    assert after(simulation).node == '/sim2'
    Topic.opened['simulator/state'].callback(STATE)
    assert simulation.has_news(now)
    simulation.snapshot(now)
    later = time.monotonic() + listener.SILENCE + 0.1
    assert simulation.has_news(later)
    assert simulation.snapshot(later).simulation.node == ''


def test_the_obstacles_of_a_simulator_are_shown_until_it_is_gone(simulation):
    after(simulation)
    things = [obstacle.Obstacle('leg', Pose(3.0, 2.0, 0.0), height=0.4, radius=0.05),
              obstacle.Obstacle('book', Pose(5.0, 3.0, 0.5), height=0.03, length=0.3, width=0.2)]
    Topic.opened['simulator/obstacles'].callback(markers(((one, one.pose) for one in things), Header()))
    assert simulation.has_news(time.monotonic())
    leg, book = simulation.snapshot(time.monotonic()).obstacles
    assert leg == Obstacle(Pose(3.0, 2.0, 0.0), 0.1, 0.1, is_round=True, is_low=False)
    assert book == Obstacle(Pose(5.0, 3.0, approx(0.5)), 0.3, 0.2, is_round=False, is_low=True)
    assert simulation.snapshot(time.monotonic() + listener.SILENCE + 0.1).obstacles == ()


def test_a_simulator_that_took_its_services_back_is_gone(simulation):
    after(simulation)
    simulation._follow(RosGraph('a master'))
    assert simulation.snapshot(time.monotonic()).simulation.node == ''


def test_without_a_robot_the_window_tells_how_to_spawn_one_in_this_simulator(simulation):
    after(simulation)
    assert simulation.snapshot(time.monotonic()).missing == (
        'There is no robot\nTo add one:\nrosservice call /sim2/spawn "{}"')


@pytest.mark.parametrize('is_paused, why', [
    (True, 'Time is paused.'), (False, 'It comes ten times in a second of simulated time.')])
def test_a_robot_that_has_not_told_its_pose_yet_is_waited_for(simulation, is_paused, why):
    simulation._follow(RosGraph('a master', ('rumba',), SERVICES, True))
    after(simulation, is_paused=is_paused, speed=0.004)
    assert simulation.snapshot(time.monotonic()).missing == f'Waiting for a pose of rumba\n{why}'


def test_robots_are_those_of_the_namespace_in_the_order_of_their_numbers():
    topics = [(f'{name}/ground_truth', 'nav_msgs/Odometry') for name in ('/rumba10', '/rumba2', '/house/rumba')]
    assert robots([*topics, ('/rumba3/ground_truth', 'std_msgs/String')], '/') == ('rumba2', 'rumba10')
    assert robots(topics, '/house/') == ('rumba',)


def test_robots_may_come_and_go_while_a_map_comes_and_the_window_asks(simulation):
    grid = OccupancyGrid(info=MapMetaData(resolution=0.1, width=2, height=3), data=np.zeros(6, np.int8))
    names = [('rumba',), ('rumba', 'rumba2', 'rumba3'), (), ('rumba4',)]

    def come_and_go():
        for step in range(3000):
            simulation._follow(RosGraph('a master', names[step % len(names)], SERVICES, True))
    hammer(come_and_go, lambda: Topic.opened['/map'].callback(grid), lambda: simulation.snapshot(0.0),
           lambda: simulation.has_news(0.0))


def test_what_fails_at_a_new_master_is_tried_again(simulation, monkeypatch):
    tried = []

    def register():
        tried.append(1)
        if len(tried) == 1:
            raise rospy.ROSException('the master is gone again')
    monkeypatch.setattr(simulation, '_on_master', register)
    with pytest.raises(rospy.ROSException):
        simulation._follow(RosGraph('another master'))
    simulation._follow(RosGraph('another master'))
    simulation._follow(RosGraph('another master'))
    assert len(tried) == 2


def test_an_error_in_the_thread_is_told_and_the_thread_goes_on(simulation, monkeypatch):
    told, graphs = [], [RosGraph('a master', ('rumba',)), RosGraph('a master', ('rumba2',))]
    monkeypatch.setattr(rospy, 'logerr_throttle', lambda _, line: told.append(line))
    monkeypatch.setattr(rospy, 'is_shutdown', lambda: not graphs)
    monkeypatch.setattr(listener.ros_graph, 'look', lambda: graphs.pop(0))
    monkeypatch.setattr(listener, 'LOOK_PERIOD', 0.0)
    monkeypatch.setattr(simulation, '_read_map_files', lambda: len(graphs) and {}['odd'])
    simulation._look_around()
    assert told == ["cannot follow the simulation: KeyError: 'odd'"]
    assert list(simulation._robots) == ['rumba2']
