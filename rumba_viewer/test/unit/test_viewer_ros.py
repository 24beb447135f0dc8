"""What the window makes of messages, and which topics, goals and services it uses; without a master."""

import math
import time

import numpy as np
import pytest
import rospy
from actionlib import CommState
from dynamic_reconfigure.srv import ReconfigureResponse
from fake_topics import Topic
from hammering import hammer
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
from pytest import approx
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from std_srvs.srv import TriggerResponse

from rumba_msg.msg import (BatteryStatus, CleanActionResult, CleaningStatus, CleanResult, Cliff, GoToResult,
                           MissionStatus, Outcome, SimulatorState)
from rumba_sim.model import obstacle
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.ros.common.conversions import quaternion
from rumba_sim.ros.common.obstacle_markers import markers
from rumba_viewer.ros import actor, listener, robot_client, robot_listener
from rumba_viewer.ros.ros_graph import RosGraph, robots
from rumba_viewer.scene.snapshot import Obstacle, Size

STATE = SimulatorState(node='/sim2', speed=2.0, real_time_factor=1.9, is_time_simulated=True, map='/nowhere.yaml')
SERVICES = frozenset({'/sim2/reset', '/sim2/pause', '/sim2/tuning/set_parameters', '/rumba/teleport'})


@pytest.fixture(autouse=True)
def opened(topics):
    """All topics that are opened."""
    return topics


# --- one robot -------------------------------------------------------------------------------------------------------

class Heard:
    """A listener to a robot; called, it returns what it knows."""

    def __init__(self, one):
        self.listener = one

    def __call__(self):
        return self.listener.robot(time.monotonic(), Size())


@pytest.fixture
def heard(opened):
    """A listener to rumba that has one reading."""
    one = robot_listener.RobotListener('rumba', lambda: None)
    opened['rumba/ground_truth'].callback(Odometry())
    return Heard(one)


def test_a_robot_has_fallen_if_a_wheel_is_dropped_whatever_its_text_says(heard, opened):
    opened['rumba/battery_status'].callback(BatteryStatus(debug_message='a wheel hangs over a cliff: teleport me'))
    assert not heard().has_fallen
    opened['rumba/cliff'].callback(Cliff(is_cliff_left=True))
    assert not heard().has_fallen
    opened['rumba/cliff'].callback(Cliff(is_wheel_dropped=True))
    assert heard().has_fallen


def cleaning_ends(opened, code):
    """A cleaning of the robot ends with an outcome."""
    opened['rumba/clean/result'].callback(CleanActionResult(result=CleanResult(outcome=Outcome(code=code))))


@pytest.mark.parametrize('codes, can_resume', [
    ([], None), ([Outcome.CANCELLED], True), ([Outcome.PREEMPTED], True), ([Outcome.SUCCEEDED], False),
    ([Outcome.TIMED_OUT], False), ([Outcome.CANCELLED, Outcome.REFUSED], True), ([Outcome.REFUSED], None),
    ([Outcome.PREEMPTED, Outcome.SUCCEEDED], False)])
def test_a_cleaning_can_be_resumed_if_the_last_one_was_interrupted(heard, opened, codes, can_resume):
    for code in codes:
        cleaning_ends(opened, code)
    assert heard().can_resume is can_resume


def test_it_is_unknown_whether_a_new_cleaner_can_resume_a_cleaning(heard, opened):
    cleaning_ends(opened, Outcome.CANCELLED)
    opened['rumba/mission_status'].impl.number = 0
    assert heard().can_resume is None
    opened['rumba/mission_status'].impl.number = 1
    assert heard().can_resume is None


@pytest.mark.parametrize('state, strategy, word, is_active, is_cleaning', [
    (MissionStatus.YIELDING, 'bounce', 'yielding', True, True), (MissionStatus.GOING_TO, '', 'going to', True, False),
    (MissionStatus.CHARGING, 'bounce', 'charging', True, True), (MissionStatus.IDLE, '', 'idle', False, False),
    (MissionStatus.STRANDED, '', 'stranded', False, False), (77, '', '?', True, False)])
def test_the_state_of_the_mission_in_words(heard, opened, state, strategy, word, is_active, is_cleaning):
    opened['rumba/mission_status'].callback(MissionStatus(state=state, strategy=strategy, message='why'))
    mission = heard().mission
    assert (mission.state, mission.is_active, mission.is_cleaning, mission.message) == (
        word, is_active, is_cleaning, 'why')


def test_the_beams_of_a_scan_begin_where_the_robot_was_at_its_time(heard, opened):
    for second, x, theta in ((1, 1.0, 0.0), (2, 2.0, 0.5 * math.pi), (3, 3.0, math.pi)):
        truth = Odometry(header=Header(stamp=rospy.Time(second)))
        truth.pose.pose.position.x = x
        truth.pose.pose.orientation = quaternion(theta)
        opened['rumba/ground_truth'].callback(truth)
    heard.listener.subscribe_large(['scan'])
    opened['rumba/scan'].callback(LaserScan(
        header=Header(stamp=rospy.Time(2)), angle_min=-0.5 * math.pi, angle_increment=0.5 * math.pi, range_max=4.0,
        ranges=np.array([0.5, math.inf, -math.inf])))
    assert heard().beams == approx(np.array([(2.5, 0.0), (2.0, 4.0), (2.0, 0.0)]))


SCAN = LaserScan(angle_increment=0.1, range_max=4.0, ranges=np.ones(9))


def test_a_scan_that_comes_while_the_laser_is_switched_off_is_not_shown(heard, opened):
    heard.listener.subscribe_large(['scan'])
    late = opened['rumba/scan'].callback
    late(SCAN)
    assert heard().beams is not None
    heard.listener.subscribe_large([])
    late(SCAN)
    assert heard().beams is None


def test_messages_may_come_while_the_window_asks_and_the_laser_is_switched(heard, opened):
    heard.listener.subscribe_large(['scan'])
    hear = {topic: opened[f'rumba/{topic}'].callback for topic in (
        'ground_truth', 'scan', 'cleaning_status', 'battery_status', 'clean/result')}

    def drive():
        for step in range(3000):
            truth = Odometry(header=Header(stamp=rospy.Time(step % 100)))  # the simulation starts anew now and then
            truth.pose.pose.position.x = truth.pose.pose.position.y = 0.1 * (step % 100)
            hear['ground_truth'](truth)
            hear['cleaning_status'](CleaningStatus(distance=float(step % 70)))
            hear['battery_status'](BatteryStatus(brushes_up=step % 2 == 0, debug_message=str(step % 2 == 0)))

    def ask():
        known, shown = heard.listener.known, heard()
        assert not known.recent or known.recent[-1].stamp == known.stamp
        assert shown is None or shown.pose.x == approx(shown.pose.y) and shown.message in ('', str(shown.brushes_up))

    def switch():
        heard.listener.subscribe_large(['scan', 'coverage'])
        hear['scan'](SCAN)
        heard.listener.subscribe_large([])
        heard.listener.forget()
    hammer(drive, ask, switch, lambda: cleaning_ends(opened, Outcome.CANCELLED))


# --- the simulation --------------------------------------------------------------------------------------------------

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


# --- what is sent ----------------------------------------------------------------------------------------------------

class Handle:
    """A goal that has ended."""

    def __init__(self, result):
        self._result = result

    def get_comm_state(self):
        return CommState.DONE

    def get_result(self):
        return self._result


class ActionClient:
    """A fake client of actionlib: the server may answer even before `send_goal` returns."""

    answers_at_once = None

    def __init__(self, name, kind):
        self.goals, self.transitions = [], []

    def stop(self):
        self.cancel_all_goals = None

    def send_goal(self, goal, transition):
        self.goals.append(goal)
        self.transitions.append(transition)
        handle = Handle(self.answers_at_once)
        if self.answers_at_once is not None:
            transition(handle)
        return handle


@pytest.fixture
def client(monkeypatch):
    """A client of rumba, and what it tells."""
    monkeypatch.setattr(robot_client.actionlib, 'ActionClient', ActionClient)
    told = []
    one = robot_client.RobotClient('rumba', told.append)
    one.told = told
    return one


def test_keys_drive_by_the_input_for_a_person(client, opened):
    client.drive(0.3, -1.5)
    [twist] = opened['rumba/teleop/cmd_vel'].published
    assert (twist.linear.x, twist.angular.z) == (0.3, -1.5)
    assert 'rumba/cmd_vel' not in opened


def test_a_client_that_was_closed_by_another_thread_sends_nothing(client, opened):
    client.close()
    client.drive(0.3, 0.0)
    client.dock()
    client.cancel()
    assert opened['rumba/teleop/cmd_vel'].published == client._clients['dock'].goals == []


def test_resuming_a_cleaning_is_a_goal_of_clean(client):
    client.resume_cleaning()
    client.clean('spiral')
    assert [(goal.resume, goal.strategy) for goal in client._clients['clean'].goals] == [(True, ''), (False, 'spiral')]


def test_a_refusal_that_comes_at_once_is_told(client, monkeypatch):
    monkeypatch.setattr(ActionClient, 'answers_at_once', CleanResult(
        outcome=Outcome(Outcome.REFUSED, 'no cleaning was interrupted')))
    client.resume_cleaning()
    assert client.told == ['rumba: clean: no cleaning was interrupted']


def test_only_the_newest_goal_of_an_action_tells_its_result(client):
    client.go_to(1.0, 2.0)
    client.go_to(3.0, 4.0)
    for message, transition in zip(('preempted', 'arrived'), client._clients['go_to'].transitions):
        transition(Handle(GoToResult(outcome=Outcome(message=message))))
    assert client.told == ['rumba: go to: arrived']


def test_a_cleaner_that_is_gone_is_told(client):
    client.dock()
    client._clients['dock'].transitions[0](Handle(None))
    assert client.told == ['rumba: dock: the cleaner is gone']


def test_services_of_the_simulator_are_below_the_name_of_its_node(monkeypatch):
    called = []
    monkeypatch.setattr(rospy, 'ServiceProxy', lambda name, kind: lambda *request: (
        called.append(name), TriggerResponse(True, 'done'))[1])
    one = actor.Actor('rumba')
    for act, service in ((one.pause, 'pause'), (one.unpause, 'resume'), (one.reset, 'reset'), (one.step, 'step')):
        act('/house/sim2')
        assert one.notices.get(timeout=10.0).endswith(': done')
        assert called.pop() == f'/house/sim2/{service}'


def test_an_odd_answer_of_a_service_is_told(monkeypatch):
    monkeypatch.setattr(rospy, 'ServiceProxy', lambda name, kind: lambda *request: ReconfigureResponse())
    one = actor.Actor('rumba')
    one.set_speed('/sim2', 2.0)
    assert one.notices.get(timeout=10.0) == "speed: KeyError: 'speed'"


def test_a_robot_that_is_selected_while_the_master_ends_is_told(monkeypatch):
    def refuse(*_):
        raise ConnectionRefusedError('no master')
    monkeypatch.setattr(actor, 'RobotClient', refuse)
    one = actor.Actor('rumba')
    one.select('rumba2')
    assert one.notices.get(timeout=10.0) == 'rumba2: not connected: ConnectionRefusedError: no master'
