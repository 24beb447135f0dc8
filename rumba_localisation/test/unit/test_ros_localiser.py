"""What the node makes of messages, without a master."""

import math
import types

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import PoseWithCovariance
from nav_msgs.msg import Odometry
from rooms import crooked
from scans import world_of
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header

from rumba_localisation.ros import conversions, scan_loop
from rumba_localisation.ros import localiser as node
from rumba_localisation.ros.localiser import Settings
from rumba_localisation.ros.odometries import KEPT, Odometries
from rumba_localisation.scan import SILENT
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.ros.common.conversions import grid, quaternion
from rumba_sim.ros.participants.maps import floor_plan


def message_of(plan):
    """The message of a map."""
    return grid(plan, plan.occupancy, rospy.Time(0))


def test_a_map_comes_through_a_message_unchanged():
    plan = crooked(0.02)
    message = message_of(plan)
    message.info.resolution = float(np.float32(message.info.resolution))  # as it is received
    found = floor_plan(message)
    assert (found.resolution, found.origin) == (plan.resolution, plan.origin)
    assert np.array_equal(found.occupancy, plan.occupancy)


@pytest.mark.parametrize('spoil, reason', [
    (lambda message: message.data.pop(), r'map: \d+ cells: must be width \* height, 82 \* 62'),
    (lambda message: setattr(message.info, 'resolution', math.nan), 'map: resolution nan m'),
    (lambda message: setattr(message.info, 'resolution', 0.0), 'map: resolution 0.0 m'),
    (lambda message: setattr(message.info.origin.position, 'x', math.inf), r'map: .* origin \(inf, '),
    (lambda message: setattr(message.info.origin, 'orientation', quaternion(0.1)), 'map: its origin is turned')])
def test_a_map_that_makes_no_sense_is_refused(spoil, reason):
    message = message_of(crooked(0.05))
    spoil(message)
    with pytest.raises(MapError, match=reason):
        floor_plan(message)


@pytest.mark.parametrize('yaw', [0.0, 0.3, -2.0, 0.5 * math.pi])
def test_a_map_whose_origin_is_turned_is_turned_back_and_its_frame_is_told(yaw):
    plan = crooked(0.05)
    message = message_of(plan)
    message.info.origin.position.x, message.info.origin.position.y = 3.0, -1.0
    message.info.origin.orientation = quaternion(yaw)
    found, frame = conversions.turned_plan(message)
    assert np.array_equal(found.occupancy, plan.occupancy)
    x, y, _ = compose(frame, Pose(found.origin[0] + 1.0, found.origin[1] + 2.0, 0.0))  # 1 m along, 2 m up its cells
    assert (x, y) == pytest.approx((3.0 + math.cos(yaw) - 2.0 * math.sin(yaw), -1.0 + math.sin(yaw) + 2.0 * math.cos(
        yaw)))


def test_a_covariance_turns_with_its_axes():
    assert conversions.turned(np.diag([4.0, 1.0, 9.0]), 0.5 * math.pi) == pytest.approx(np.diag([1.0, 4.0, 9.0]))


def test_a_covariance_stands_at_its_places_in_a_message():
    covariance = np.array([[1.0, 2.0, 3.0], [2.0, 5.0, 6.0], [3.0, 6.0, 9.0]])
    message = conversions.pose_with_covariance(Pose(1.0, 2.0, 0.5), covariance, Header())
    numbers = message.pose.covariance
    assert (numbers[0], numbers[1], numbers[5], numbers[7], numbers[11], numbers[35]) == (1.0, 2.0, 3.0, 5.0, 6.0, 9.0)
    assert np.array_equal(conversions.covariance_of(message.pose), covariance)


@pytest.mark.parametrize('numbers, is_one', [
    ([0.0] * 36, True), ([1.0] + [0.0] * 35, True), ([math.nan] + [0.0] * 35, False), ([-1.0] + [0.0] * 35, False),
    ([0.0, 1.0] + [0.0] * 34, False)])
def test_not_all_numbers_are_a_covariance(numbers, is_one):
    assert conversions.is_covariance(conversions.covariance_of(PoseWithCovariance(covariance=numbers))) is is_one


def test_poses_by_odometry_are_found_by_their_time_and_between_two():
    odometries = Odometries()
    assert odometries.at(rospy.Time(1)) is None and not odometries.is_before(rospy.Time(1))
    odometries.add(rospy.Time(1), Pose(0.0, 0.0, 3.0))
    odometries.add(rospy.Time(2), Pose(1.0, 4.0, -3.0))
    assert odometries.at(rospy.Time(2)) == Pose(1.0, 4.0, -3.0)
    middle = odometries.at(rospy.Time(1, 500_000_000))
    assert (middle.x, middle.y) == (0.5, 2.0) and abs(middle.theta) == pytest.approx(math.pi)
    assert odometries.at(rospy.Time(3)) is None and odometries.at(rospy.Time(0, 1)) is None
    assert odometries.is_before(rospy.Time(0, 1)) and not odometries.is_before(rospy.Time(1))


def test_a_time_that_begins_again_and_a_long_one_forget_what_was():
    odometries = Odometries()
    for second in range(2 * KEPT):
        odometries.add(rospy.Time(second), Pose(0.0, 0.0, 0.0))
    assert odometries.is_before(rospy.Time(KEPT - 1)) and not odometries.is_before(rospy.Time(KEPT))
    odometries.add(rospy.Time(1), Pose(1.0, 0.0, 0.0))
    assert odometries.at(rospy.Time(KEPT + 1)) is None and odometries.at(rospy.Time(1)) == Pose(1.0, 0.0, 0.0)


def test_a_start_needs_both_coordinates():
    assert Settings().start is None
    assert Settings(initial_pose_x=1.0, initial_pose_y=2.0).start == Pose(1.0, 2.0, 0.0)
    with pytest.raises(ConfigError, match='^initial_pose_x and initial_pose_y must be given together, or neither$'):
        Settings(initial_pose_x=1.0)


class Node:
    """The node without ROS, for a robot in a world; it hears what the world tells, and keeps what the node tells."""

    def __init__(self, monkeypatch, world):
        self.told, self.warnings = {}, []
        monkeypatch.setattr(scan_loop.rospy, 'Publisher', self._publisher)
        monkeypatch.setattr(scan_loop.rospy, 'Subscriber', lambda *_, **__: None)
        monkeypatch.setattr(node.rospy, 'Service', lambda *_: None)
        monkeypatch.setattr(scan_loop, 'Participant', self._participant)
        monkeypatch.setattr(node.rospy, 'loginfo', lambda _: None)
        monkeypatch.setattr(node.rospy, 'logwarn_throttle', lambda _, line: self.warnings.append(line))
        monkeypatch.setattr(scan_loop, 'SILENT_WALL', 0.0)
        self._world, self._start = world, world.robots['rumba'].pose
        x, y, theta = self._start
        self._node = node.LocaliserNode(Settings(initial_pose_x=x, initial_pose_y=y, initial_pose_a=theta))
        self._node._take_map(message_of(world.plan))

    def _participant(self, _, is_busy):
        self.is_busy = is_busy

    def works_at(self, message, take):
        """Have its loop take a message; returns whether it counted as busy before, meanwhile and after."""
        was_busy = [self.is_busy()]

        def take_it(message):
            was_busy.append(self.is_busy())
            take(message)
        self._node._work.rest()  # as it does when its loop begins
        was_busy.append(self.is_busy())
        self._node._post(message, take_it)
        self._node._requests.serve(0.0)
        return [*was_busy, self.is_busy()]

    def _publisher(self, topic, *_, **__):
        told = self.told.setdefault(topic.replace('rumba/', ''), [])
        return types.SimpleNamespace(publish=told.append, get_num_connections=lambda: 1)

    def drives(self, seconds, has_scans):
        """Have the robot drive ahead, with an odometry each 0.02 s and a scan each 0.1 s; returns the stamps."""
        world, stamps = self._world, []
        robot = world.robots['rumba']
        for _ in range(round(50 * seconds)):
            robot.command(0.2, 0.2, world.tick)
            world.step()
            stamps.append(rospy.Time.from_sec(world.time + 1.0))
            header = Header(stamp=stamps[-1])
            if has_scans and world.tick % 5 == 0:
                ranges = world.scan('rumba')
                self._node._take_scan(LaserScan(header=header, angle_min=-math.pi, range_min=0.12, range_max=8.0,
                                                angle_increment=2.0 * math.pi / len(ranges), ranges=ranges))
            odometry = Odometry(header=header)
            odometry.pose.pose = conversions.pose_message(*robot.odometry)
            self._node._take_odom(odometry)
        return stamps


def test_while_the_laser_is_silent_the_node_tells_a_pose_by_odometry_and_no_correction(monkeypatch):
    heard = Node(monkeypatch, world_of(pose=Pose(0.5, 0.6, 0.3)))
    scanned = heard.drives(2.0, has_scans=True)[-1]
    poses, corrections = heard.told['amcl_pose'], heard.told['/tf']
    assert poses[-1].header.stamp == scanned and len(poses) == len(corrections) == 20 and not heard.warnings
    silent = heard.drives(6.0, has_scans=False)
    told, known = poses[20:], poses[19].pose.covariance
    assert [pose.header.stamp for pose in told] == silent[-len(told):] and len(corrections) == 20
    assert (told[0].header.stamp - scanned).to_sec() == pytest.approx(SILENT, abs=0.03)
    assert told[-1].pose.covariance[0] > 20.0 * known[0] and told[-1].pose.covariance[35] > 20.0 * known[35]
    assert heard.warnings[-1] == 'rumba: the laser has been silent for 6 s: goes by odometry alone'
    heard.drives(0.2, has_scans=True)
    assert poses[-1].pose.covariance[0] < 10.0 * known[0] and len(corrections) == 22


def test_a_node_that_cannot_use_a_scan_says_what_is_missing(monkeypatch):
    world = world_of()
    heard = Node(monkeypatch, world)
    heard._node._plan = None
    assert heard._node._missing() == 'no map came on /map'
    heard._node._take_map(message_of(world.plan))
    assert heard._node._missing() == 'nothing came on /rumba/scan and /rumba/odom'
    scan = LaserScan(header=Header(stamp=rospy.Time(5), frame_id='eye'), angle_increment=0.1, range_max=8.0)
    heard._node._take_scan(scan)
    assert heard._node._missing() == 'nothing came on /rumba/odom'
    heard._node._take_odom(Odometry(header=Header(stamp=rospy.Time(2))))
    assert heard._node._missing() == 'neither /tf_static nor /tf leads from base_link to eye'
    scan.header.frame_id = ''
    assert heard._node._missing() == 'no odometry is as new as the scan, which has stamp 5.000 s'


def test_it_says_so_each_time_that_some_time_has_passed_until_a_scan_was_used(monkeypatch):
    heard, said = Node(monkeypatch, world_of()), []
    monkeypatch.setattr(node.rospy, 'logwarn', said.append)
    monkeypatch.setattr(node.rospy, 'get_name', lambda: '/localiser')
    heard._node._complain()
    assert not said
    heard._node._begun -= 11.0
    heard._node._complain()
    heard._node._complain()
    assert said == ['/localiser waits: nothing came on /rumba/scan and /rumba/odom']
    heard.drives(0.3, has_scans=True)
    heard._node._begun -= 11.0
    heard._node._complain()
    assert len(said) == 1


def test_a_node_that_starts_or_looks_at_a_scan_is_alive_to_a_world_in_lockstep(monkeypatch):
    """It may have to compile then, for minutes on a busy machine."""
    taken = []
    heard = Node(monkeypatch, world_of(pose=Pose(0.5, 0.6, 0.3)))
    assert heard.works_at('a scan', taken.append) == [True, False, True, False]
    assert taken == ['a scan']
