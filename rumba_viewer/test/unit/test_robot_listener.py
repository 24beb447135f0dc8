"""What the window makes of the messages of one robot, without a master."""

import math
import time

import numpy as np
import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from hammering import hammer
from nav_msgs.msg import Odometry
from pytest import approx
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from rumba_msg.msg import BatteryStatus, CleanActionResult, CleaningStatus, CleanResult, Cliff, MissionStatus, Outcome
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.ros.common.conversions import quaternion, static_transforms
from rumba_sim.ros.common.frames import frames
from rumba_viewer.ros import robot_listener
from rumba_viewer.scene.snapshot import Size

pytestmark = pytest.mark.usefixtures('topics')


class Heard:
    """A listener to a robot; called, it returns what it knows."""

    def __init__(self, one):
        self.listener = one

    def __call__(self):
        return self.listener.robot(time.monotonic(), Size())


@pytest.fixture
def heard(topics):
    """A listener to rumba that has one reading."""
    one = robot_listener.RobotListener('rumba', lambda: None)
    topics['rumba/ground_truth'].callback(Odometry())
    return Heard(one)


def test_a_robot_has_fallen_if_a_wheel_is_dropped_whatever_its_text_says(heard, topics):
    topics['rumba/battery_status'].callback(BatteryStatus(debug_message='a wheel hangs over a cliff: teleport me'))
    assert not heard().has_fallen
    topics['rumba/cliff'].callback(Cliff(is_cliff_left=True))
    assert not heard().has_fallen
    topics['rumba/cliff'].callback(Cliff(is_wheel_dropped=True))
    assert heard().has_fallen


def test_a_mission_that_began_before_the_window_was_opened_has_the_time_since_its_goal_came(heard, topics):
    goals = [GoalStatus(goal_id=GoalID(rospy.Time(secs=secs), 'a goal')) for secs in (100, 300)]
    topics['rumba/clean/status'].callback(GoalStatusArray(status_list=goals))
    topics['rumba/mission_status'].callback(MissionStatus(state=MissionStatus.CHARGING, strategy='bounce'))
    for secs in (1299, 1312):
        topics['rumba/cleaning_status'].callback(
            CleaningStatus(header=Header(stamp=rospy.Time(secs=secs)), coverage=0.5, distance=100.0))
    assert heard().elapsed == 1012.0
    topics['rumba/clean/status'].callback(GoalStatusArray())
    assert heard().elapsed is None


def cleaning_ends(topics, code):
    """A cleaning of the robot ends with an outcome."""
    topics['rumba/clean/result'].callback(CleanActionResult(result=CleanResult(outcome=Outcome(code=code))))


@pytest.mark.parametrize('codes, can_resume', [
    ([], None), ([Outcome.CANCELLED], True), ([Outcome.PREEMPTED], True), ([Outcome.SUCCEEDED], False),
    ([Outcome.TIMED_OUT], False), ([Outcome.CANCELLED, Outcome.REFUSED], True), ([Outcome.REFUSED], None),
    ([Outcome.SUCCEEDED, Outcome.NO_READINGS], None),
    ([Outcome.PREEMPTED, Outcome.SUCCEEDED], False)])
def test_a_cleaning_can_be_resumed_if_the_last_one_was_interrupted(heard, topics, codes, can_resume):
    for code in codes:
        cleaning_ends(topics, code)
    assert heard().can_resume is can_resume


def test_it_is_unknown_whether_a_new_cleaner_can_resume_a_cleaning(heard, topics):
    cleaning_ends(topics, Outcome.CANCELLED)
    topics['rumba/mission_status'].impl.number = 0
    assert heard().can_resume is None
    topics['rumba/mission_status'].impl.number = 1
    assert heard().can_resume is None


@pytest.mark.parametrize('state, strategy, word, is_active, is_cleaning', [
    (MissionStatus.YIELDING, 'bounce', 'yielding', True, True), (MissionStatus.GOING_TO, '', 'going to', True, False),
    (MissionStatus.CHARGING, 'bounce', 'charging', True, True), (MissionStatus.IDLE, '', 'idle', False, False),
    (MissionStatus.STRANDED, '', 'stranded', False, False), (77, '', '?', True, False)])
def test_the_state_of_the_mission_in_words(heard, topics, state, strategy, word, is_active, is_cleaning):
    topics['rumba/mission_status'].callback(MissionStatus(state=state, strategy=strategy, message='why'))
    mission = heard().mission
    assert (mission.state, mission.is_active, mission.is_cleaning, mission.message) == (
        word, is_active, is_cleaning, 'why')


def test_the_beams_of_a_scan_begin_where_the_robot_was_at_its_time(heard, topics):
    for second, x, theta in ((1, 1.0, 0.0), (2, 2.0, 0.5 * math.pi), (3, 3.0, math.pi)):
        truth = Odometry(header=Header(stamp=rospy.Time(second)))
        truth.pose.pose.position.x = x
        truth.pose.pose.orientation = quaternion(theta)
        topics['rumba/ground_truth'].callback(truth)
    heard.listener.subscribe_large(['scan'])
    topics['rumba/scan'].callback(LaserScan(
        header=Header(stamp=rospy.Time(2)), angle_min=-0.5 * math.pi, angle_increment=0.5 * math.pi, range_max=4.0,
        ranges=np.array([0.5, math.inf, -math.inf])))
    assert heard().beams == approx(np.array([(2.5, 0.0), (2.0, 4.0), (2.0, 0.0), (2.0, 0.0)]))


@pytest.mark.parametrize('upside_down, ends', [
    (False, [(1.2, 1.5), (0.7, 2.0), (1.2, 2.5), (1.2, 2.0)]),
    (True, [(1.2, 2.5), (0.7, 2.0), (1.2, 1.5), (1.2, 2.0)])])
def test_the_beams_of_a_scan_begin_where_the_laser_is_mounted(heard, topics, upside_down, ends):
    """The robot looks along x, its laser back, 0.2 m ahead of the centre; a fan with a gap ends at the laser."""
    truth = Odometry(header=Header(stamp=rospy.Time(1)))
    truth.pose.pose.position.x, truth.pose.pose.position.y, truth.pose.pose.orientation.w = 1.0, 2.0, 1.0
    topics['rumba/ground_truth'].callback(truth)
    heard.listener.subscribe_large(['scan'])
    _, mounted = static_transforms(frames('rumba'), rospy.Time(), 0.07, LaserConfig(
        x=0.2, yaw=math.pi, upside_down=upside_down))
    topics['/tf_static'].callback(TFMessage([mounted]))
    topics['/tf_static'].callback(TFMessage([]))
    scan = LaserScan(header=truth.header, angle_min=0.5 * math.pi, angle_increment=-0.5 * math.pi, range_max=4.0,
                     ranges=np.full(3, 0.5))
    topics['rumba/scan'].callback(scan)
    assert heard().beams == approx(np.array(ends))
    scan.ranges = np.full(4, 0.5)
    topics['rumba/scan'].callback(scan)
    assert len(heard().beams) == 4


SCAN = LaserScan(angle_increment=0.1, range_max=4.0, ranges=np.ones(9))


def test_a_scan_that_comes_while_the_laser_is_switched_off_is_not_shown(heard, topics):
    heard.listener.subscribe_large(['scan'])
    late = topics['rumba/scan'].callback
    late(SCAN)
    assert heard().beams is not None
    heard.listener.subscribe_large([])
    late(SCAN)
    assert heard().beams is None


def test_messages_may_come_while_the_window_asks_and_the_laser_is_switched(heard, topics):
    heard.listener.subscribe_large(['scan'])
    hear = {topic: topics[f'rumba/{topic}'].callback for topic in (
        'ground_truth', 'scan', 'cleaning_status', 'battery_status', 'clean/result')}

    def drive():
        for step in range(3000):
            truth = Odometry(header=Header(stamp=rospy.Time(step % 100)))  # the simulation starts again after 100 s
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
    hammer(drive, ask, switch, lambda: cleaning_ends(topics, Outcome.CANCELLED))
