"""What the node mapper publishes when a loop closes, without a master."""

import types

import numpy as np
import pytest
import rospy
from nav_msgs.msg import Odometry
from rooms import quiet
from scans import error
from sensor_msgs.msg import LaserScan
from test_loop_closure import START, drive_around

from rumba_localisation.ros import mapper as node
from rumba_localisation.ros import scan_loop
from rumba_msg.msg import DockStatus
from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.maps.floor_plan import OCCUPIED
from rumba_sim.ros.common.conversions import heading, plane_pose, quaternion
from rumba_sim.ros.participants.maps import floor_plan

ALONG = 24.8  # [m] x from which on the robot is at the far end of the corridor that shows nothing
TOPICS = '/map', 'key_frames', 'dock_pose', '/tf'


class Node:
    """The node without ROS; it keeps what the node tells."""

    def __init__(self, monkeypatch):
        self.told = {}
        monkeypatch.setattr(scan_loop.rospy, 'Publisher', self._publisher)
        monkeypatch.setattr(scan_loop.rospy, 'Subscriber', lambda *_, **__: None)
        monkeypatch.setattr(node.rospy, 'Service', lambda *_: None)
        monkeypatch.setattr(scan_loop, 'Participant', lambda *_: None)
        monkeypatch.setattr(node, 'RobotConfig', quiet)
        x, y, theta = START
        settings = node.Settings(initial_pose_x=x, initial_pose_y=y, initial_pose_a=theta, map_update_interval=3600.0)
        self.node = node.MapperNode(settings)

    def _publisher(self, topic, *_, **__):
        told = self.told.setdefault(topic.replace('rumba/', ''), [])
        return types.SimpleNamespace(publish=told.append, get_num_connections=lambda: 1)

    def newest(self):
        """The newest message of each topic."""
        return {topic: self.told[topic][-1] for topic in TOPICS}


def until_closed(monkeypatch):
    """What the node told before a loop closed and as it closed, where it was by odometry then, and the true poses.

    The contacts of a dock close at the far end of a bare corridor, where the map errs.
    """
    heard, (told, poses), dock = Node(monkeypatch), drive_around(), None
    for number, ((odometry, seen), true) in enumerate(zip(told, poses), 1):
        if dock is None and true.x > ALONG:
            dock = true
            heard.node._take_dock(DockStatus(is_docked=True))
        before = heard.newest() if dock is not None and heard.told['dock_pose'] else None
        heard.node._use(seen, odometry, rospy.Time.from_sec(0.1 * number))
        if heard.node._mapper.redrawn:
            return before, heard.newest(), odometry, true, dock
    raise AssertionError('no loop closed')


def frame_of(message):
    """map -> odom of a message of tf."""
    [link] = message.transforms
    return Pose(link.transform.translation.x, link.transform.translation.y, heading(link.transform.rotation))


def test_a_loop_that_closes_corrects_map_dock_and_frame_at_once(monkeypatch):
    before, after, odometry, true, dock = until_closed(monkeypatch)
    stamps = {message.header.stamp for topic, message in after.items() if topic != '/tf'}
    assert len(stamps) == 1 and stamps == {after['/tf'].transforms[0].header.stamp}
    assert before['/map'].header.stamp == rospy.Time.from_sec(0.1)  # the next one was not due
    old, new = (error(compose(frame_of(told['/tf']), odometry), true)[0] for told in (before, after))
    assert new < 0.03 and old > new + 0.1
    old, new = (error(plane_pose(told['dock_pose'].pose), dock)[0] for told in (before, after))
    assert old > 0.1 and new < 0.5 * old
    frames = [plane_pose(pose) for pose in after['key_frames'].poses]
    assert frames[0] == pytest.approx(START) and error(frames[-1], true)[0] < 0.03
    plan = floor_plan(after['/map'])
    wall = max(np.nonzero(plan.occupancy == OCCUPIED)[1]) * plan.resolution + plan.origin[0]
    assert abs(wall - 26.0) < 0.5 * old + 0.05


@pytest.mark.parametrize('turn, duration, is_named', [(0.2, 0.2, True), (0.02, 0.2, False), (0.2, 0.0, False),
                                                      (0.2, float('nan'), False), (0.2, 1e300, False)])
def test_a_scan_that_takes_time_while_the_robot_turns_is_named(monkeypatch, turn, duration, is_named):
    heard, warnings = Node(monkeypatch), []
    monkeypatch.setattr(scan_loop.rospy, 'logwarn_once', warnings.append)
    for time, theta in (0.9, 0.0), (1.0, 0.0), (1.2, turn):
        odometry = Odometry()
        odometry.header.stamp = rospy.Time.from_sec(time)
        odometry.pose.pose.orientation = quaternion(theta)
        heard.node._take_odom(odometry)
    scan = LaserScan(angle_min=-3.0, angle_max=3.0, angle_increment=0.06, time_increment=duration / 100.0,
                     range_min=0.1, range_max=5.0, ranges=[2.0] * 100)
    scan.header.stamp = rospy.Time.from_sec(1.2)
    heard.node._take_scan(scan)
    assert [f'{turn:.2f} rad in the {duration:.2f} s' in warning for warning in warnings] == [True] * is_named
