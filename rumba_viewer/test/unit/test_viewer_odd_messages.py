"""No message of anybody ends the window: what makes no sense is ignored with a line, or shown as unknown."""

import math
import sys
import time

import numpy as np
import odd_messages
import pytest
import rospy
from fake_topics import Topic
from geometry_msgs.msg import PoseArray, PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry, Path
from pytest import approx
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray
from windows import APPLICATION, Opened

from rumba_msg.msg import (BatteryStatus, Bumper, CleanActionResult, CleaningStatus, CleanResult, Cliff, MissionStatus,
                           Outcome, SimulatorState)
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.common.conversions import transform
from rumba_viewer.ros import listener, subscription
from rumba_viewer.ros.ros_graph import RosGraph
from rumba_viewer.scene.snapshot import Obstacle, Snapshot

NODE = '/simulator'
GRAPH = RosGraph('a master', ('rumba', 'rumba2'), frozenset({f'{NODE}/reset', '/reset'}), True)


def odometry(x, y):
    """A pose with a heading of 0."""
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.w = 1.0
    return message


def grid(value):
    """A grid of 30 x 40 cells of 0.1 m."""
    return numpy_msg(OccupancyGrid)(info=MapMetaData(resolution=0.1, width=40, height=30),
                                    data=np.full(1200, value, np.int8))


HERE = Pose(0.0, 0.0, 0.0)
CUBE = Marker(type=Marker.CUBE, header=Header(frame_id='map'))
CUBE.pose.orientation.w = CUBE.scale.x = CUBE.scale.y = CUBE.scale.z = 1.0
GOOD = {
    'simulator/map': grid(0), '/map': grid(0), '/tf_static': TFMessage([transform('world', 'map', HERE, None)]),
    'rumba/ground_truth': odometry(1.0, 2.0), 'rumba/coverage': grid(100),
    'rumba/scan': numpy_msg(LaserScan)(angle_min=-3.0, angle_max=3.0, angle_increment=0.1, range_max=4.0,
                                       ranges=np.full(61, 2.0, np.float32), intensities=np.zeros(0, np.float32)),
    'rumba/battery_status': BatteryStatus(percentage_battery=50, debug_message='resting'),
    'rumba/battery_state': BatteryState(percentage=0.5, voltage=15.0, current=-1.0, power_supply_status=2),
    'rumba/bumper': Bumper(), 'rumba/cliff': Cliff(),
    'rumba/cleaning_status': CleaningStatus(coverage=0.5, cleaned_area=1.0, reachable_area=2.0, distance=3.0),
    'rumba/mission_status': MissionStatus(state=MissionStatus.CLEANING, strategy='bounce', message='cleans'),
    'rumba/amcl_pose': PoseWithCovarianceStamped(pose=odometry(1.1, 2.1).pose),
    'rumba/particlecloud': PoseArray(poses=[odometry(1.2, 2.2).pose.pose]),
    'rumba/plan': Path(poses=[PoseStamped(pose=odometry(1.3, 2.3).pose.pose) for _ in range(3)]),
    'rumba/clean/result': CleanActionResult(result=CleanResult(outcome=Outcome(Outcome.CANCELLED, 'cancelled'))),
    'simulator/obstacles': MarkerArray([CUBE]),
    'simulator/state': SimulatorState(node=NODE, map='/nowhere.yaml', speed=2.0, real_time_factor=2.0,
                                      is_time_simulated=True)}


class Watched:
    """A window over a listener, and what both raised."""

    def __init__(self, monkeypatch):
        monkeypatch.setattr(listener, 'robot_config', lambda _: RobotConfig())
        self.raised, self.warned = [], []
        monkeypatch.setattr(sys, 'excepthook', lambda kind, error, trace: self.raised.append(error))
        monkeypatch.setattr(rospy, 'logwarn', self.warned.append)
        self.listener = listener.Listener('rumba', True)
        self.look()
        self.opened = Opened(Snapshot(), size=(640, 480))
        self.opened.window._source = self.listener
        for topic in GOOD:
            self.hear(topic, GOOD[topic])
        self.look()
        self.show()

    def look(self):
        """Do what the thread of the listener does."""
        self.listener._follow(GRAPH)

    def hear(self, topic, message):
        """A message comes."""
        Topic.opened[topic].callback(message)

    def show(self):
        """Paint the newest snapshot; raises what was raised in a handler of Qt."""
        self.listener._is_news = True
        self.opened.window.update_picture()
        self.opened.window.repaint()
        APPLICATION.processEvents()
        if self.raised:
            raise self.raised[0]
        return self.opened.window.snapshot


@pytest.fixture
def watched(topics, monkeypatch):
    """A window that shows all that there is to show."""
    watched = Watched(monkeypatch)
    yield watched
    watched.opened.window.close()


@pytest.mark.skipif(not hasattr(np.ndarray, 'tostring'), reason='messages of ROS call what NumPy 2.3 has removed')
@pytest.mark.thorough(except_for=['rumba/scan', 'rumba/coverage', '/map'])
@pytest.mark.parametrize('topic', GOOD)
def test_after_any_messages_the_window_shows_a_good_one(watched, monkeypatch, topic):
    monkeypatch.setattr(listener, 'COVERAGE_PERIOD', 0.0)
    for message in odd_messages.all_of(GOOD[topic], seed=13):
        watched.hear(topic, message)
        watched.look()
        watched.show()
    for name in GOOD:  # after another map, or a time in the past, all must come again
        watched.hear(name, GOOD[name])
    watched.look()
    shown = watched.show()
    robot = shown.robot
    assert shown.plan.cells.shape == (30, 40) and (robot.pose.x, robot.pose.y) == approx((1.0, 2.0), abs=1e-6)
    assert (shown.simulation.node, shown.simulation.speed, shown.is_complete) == (NODE, 2.0, True)
    assert shown.obstacles == (Obstacle(Pose(0.0, 0.0, 0.0), 1.0, 1.0, is_round=False, is_low=False),)
    assert (robot.mission.message, robot.cleaning.distance, robot.battery.voltage) == ('cleans', 3.0, 15.0)


@pytest.mark.parametrize('topic, change, line', [
    ('/map', {'data': np.zeros(7, np.int8)}, '/map: a message is ignored: 40 x 30 cells with 7 values: '),
    ('/tf_static', {'transforms': [transform('world', 'map', HERE._replace(x=math.nan), None)]},
     '/tf_static: a message is ignored: the pose is nan, 0 m, 0 rad: must be finite, within 1e+07 m'),
    ('rumba/plan', {'poses': [PoseStamped(pose=odometry(math.nan, 1.0).pose.pose)]},
     'rumba/plan: a message is ignored: a pose of the path is not finite, or not within 1e+07 m'),
    ('rumba/scan', {'range_max': math.nan}, 'rumba/scan: a message is ignored: 61 ranges up to nan m'),
    ('rumba/ground_truth', {'pose': odometry(math.inf, 1.0).pose},
     'rumba/ground_truth: a message is ignored: the pose is inf, 1 m, 0 rad: must be finite, within 1e+07 m'),
    ('simulator/state', {'node': 'a b'}, "simulator/state: a message is ignored: node is 'a b': must be the full name"),
    ('simulator/state', {'map': '\x1b[2J'}, r"simulator/state: a message is ignored: map is '\x1b[2J': must be ")])
def test_messages_that_are_ignored_are_told_in_one_line_once_in_a_while(watched, monkeypatch, topic, change, line):
    message = type(GOOD[topic])(**{**{name: getattr(GOOD[topic], name) for name in GOOD[topic].__slots__}, **change})
    for _ in range(100):
        watched.hear(topic, message)
    [told] = watched.warned
    assert told.startswith(line) and '\n' not in told and '\x1b' not in told
    later = time.monotonic() + subscription.WARNING_PERIOD
    monkeypatch.setattr(subscription.time, 'monotonic', lambda: later)
    watched.hear(topic, message)
    assert len(watched.warned) == 2


def test_what_is_odd_in_a_message_is_unknown_and_the_rest_is_shown(watched):
    watched.hear('rumba/battery_state', BatteryState(percentage=math.inf, voltage=14.5, current=1e30))
    watched.hear('rumba/cleaning_status', CleaningStatus(coverage=0.25, cleaned_area=-1.0, distance=math.inf))
    watched.hear('rumba/battery_status', BatteryStatus(debug_message='two\nlines' + 5_000_000 * 'x'))
    robot = watched.show().robot
    assert robot.battery[:3] == approx((math.nan, 14.5, math.nan), nan_ok=True)
    assert robot.cleaning == approx((0.25, math.nan, 0.0, 0.0, math.nan, 0.0), nan_ok=True)
    assert robot.message.startswith(r'two\nlinesxxx') and len(robot.message) < 400
