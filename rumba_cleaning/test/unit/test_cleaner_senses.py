"""How the cleaner reads a robot's topics: complete readings, the time between them, poses, and what is missing."""

import math
import types

import pytest
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, Quaternion, Transform, TransformStamped, Vector3
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from rumba_cleaning.behaviour import CERTAIN, UNKNOWN, Command
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner import certainty, conversions, location, senses
from rumba_msg.msg import Bumper, CleaningStatus, Cliff, DockStatus, Lockstep
from rumba_sim.model.geometry import Pose
from rumba_sim.ros.common.conversions import transform, transform_pose


class Robot:
    """A robot's topics without ROS: what it publishes goes straight to the subscribers."""

    def __init__(self, monkeypatch, name='rumba', lockstep=None, expected=''):
        self._name = name
        self.lockstep = lockstep
        self._callbacks = {}
        self.connections = 1
        self.expected = expected  # the topic that has a publisher already
        self.readings = 0
        monkeypatch.setattr(senses.rospy, 'Subscriber', self._subscribe)
        monkeypatch.setattr(certainty, '_has_publisher', lambda topic: topic == self.expected)
        self.warnings = []
        monkeypatch.setattr(location.rospy, 'logwarn_throttle', lambda _, line: self.warnings.append(line))
        self.senses = senses.Senses(name, self._count, lambda: self.lockstep)

    def _subscribe(self, topic, _, callback, *arguments, **__):
        self._callbacks[topic] = lambda message: callback(message, *arguments)
        return types.SimpleNamespace(get_num_connections=lambda: self.connections, resolved_name=topic)

    def _count(self):
        self.readings += 1

    def tells(self, topic, message):
        """Publish a message."""
        self._callbacks[f'{self._name}/{topic}'](message)

    def reads(self, seconds, topics=('bumper', 'cliff', 'dock_status'), **fields):
        """Publish parts of a reading, in this order, with one stamp; returns how many readings that completed."""
        before = self.readings
        kinds = {'bumper': Bumper, 'cliff': Cliff, 'dock_status': DockStatus}
        for topic in topics:
            mine = {name: value for name, value in fields.items() if name in kinds[topic].__slots__}
            self.tells(topic, kinds[topic](header=Header(stamp=rospy.Time.from_sec(seconds)), **mine))
        return self.readings - before

    def stands(self, odom=Pose(0.0, 0.0, 0.0), base=Pose(0.0, 0.0, 0.0), topic='/tf'):
        """Tell tf the pose of the odom frame, and that of the robot in it, 10 s later."""
        prefix = '' if self._name == 'rumba' else f'{self._name}/'
        for frame, child, pose, seconds in (('map', f'{prefix}odom', odom, 1),
                                            (f'{prefix}odom', f'{prefix}base_footprint', base, 11)):
            self.transforms(transform(frame, child, pose, rospy.Time(seconds)), topic=topic)

    def transforms(self, *transforms, topic='/tf'):
        """Publish transforms in one message."""
        self._callbacks[topic](TFMessage(list(transforms)))


@pytest.fixture
def robot(monkeypatch):
    """A robot that stands at the origin, with half its charge."""
    robot = Robot(monkeypatch)
    robot.stands()
    robot.tells('battery_state', BatteryState(percentage=0.5))
    return robot


@pytest.mark.parametrize('order', [
    ('bumper', 'cliff', 'dock_status'), ('dock_status', 'cliff', 'bumper'), ('cliff', 'dock_status', 'bumper')])
def test_a_reading_is_complete_with_its_last_part_whatever_the_order(robot, order):
    for seconds in (1.0, 1.1, 1.2):
        assert [robot.reads(seconds, [topic]) for topic in order] == [0, 0, 1]


def test_parts_that_run_ahead_complete_a_reading_and_older_ones_do_not(robot):
    assert robot.reads(1.0) == 1
    assert robot.reads(1.1, ['bumper']) + robot.reads(1.2, ['bumper']) + robot.reads(1.1, ['dock_status']) == 0
    assert robot.reads(1.1, ['cliff']) == 1
    assert robot.senses.stamp == rospy.Time.from_sec(1.1)


def test_a_dock_status_that_is_always_ahead_completes_readings_all_the_same(robot):
    assert robot.reads(1.0, ['bumper', 'dock_status']) == 0
    for tenths in range(11, 30):
        assert robot.reads(0.1 * tenths, ['bumper', 'dock_status']) == 0
        assert robot.reads(0.1 * (tenths - 1), ['cliff']) == 1
        assert robot.senses.stamp == rospy.Time.from_sec(0.1 * (tenths - 1)) and robot.senses.unread == 1


def test_time_is_that_of_stamps_without_pauses_and_jumps_back(robot):
    for seconds, passed in ((100.0, 0.0), (100.1, 0.1), (101.1, 1.1), (102.2, 1.1), (102.3, 1.2), (7.0, 1.2),
                            (7.25, 1.45)):
        robot.reads(seconds)
        assert robot.senses.passed / 1e9 == pytest.approx(passed)


def test_the_first_observation_has_no_time_and_the_next_all_since_readings_that_were_left_out_included(robot):
    robot.reads(1.0)
    robot.reads(1.5)
    assert robot.senses.observe().dt == 0.0
    for seconds in (1.6, 1.7, 1.8):
        robot.reads(seconds)
    assert robot.senses.observe().dt == pytest.approx(0.3)
    assert robot.senses.observe().dt == 0.0
    robot.reads(1.9)
    robot.senses.begin()
    robot.reads(2.0)
    assert robot.senses.observe().dt == 0.0


def test_an_observation_holds_what_each_topic_tells_on_its_side(robot):
    robot.tells('battery_state', BatteryState(percentage=0.25))
    robot.reads(1.0, is_right_pressed=True, is_cliff_front_left=True, is_docked=True, infrared_omni=1, infrared_left=4,
                infrared_right=8)
    found = robot.senses.look()
    assert found.bumper == (False, True)
    assert found.cliffs == (False, True, False, False)
    assert found.contact == (True, True)
    assert (found.state_of_charge, found.is_docked) == (0.25, True)
    assert (found.infrared.omni, found.infrared.left, found.infrared.right) == (1, 4, 8)


@pytest.mark.parametrize('name', ['rumba', 'rumba2'])
def test_the_pose_is_the_newest_odometry_with_a_correction_that_may_be_older(monkeypatch, name):
    robot = Robot(monkeypatch, name)
    robot.stands(odom=Pose(1.0, 2.0, 0.5 * math.pi), base=Pose(0.5, 0.25, 0.75 * math.pi))
    assert robot.senses.pose() == pytest.approx((0.75, 2.5, -0.75 * math.pi))


def odometry(x=1.0, y=2.0, z=0.0, rotation=(0.0, 0.0, 0.0, 1.0), stamp=rospy.Time(5), frame='odom',
             child='base_footprint'):
    """A transform with any numbers and names."""
    return TransformStamped(Header(0, stamp, frame), child, Transform(Vector3(x, y, z), Quaternion(*rotation)))


@pytest.mark.parametrize('odd', [
    odometry(x=math.nan), odometry(y=math.inf), odometry(z=-math.inf), odometry(x=1e308), odometry(y=-1e7),
    odometry(rotation=(0.0, 0.0, 0.0, 0.0)), odometry(rotation=(0.0, 0.0, 1.0, 1.0)),
    odometry(rotation=(math.nan, 0.0, 0.0, 1.0)), odometry(rotation=(1e200, 0.0, 0.0, 1e200))], ids=str)
def test_a_transform_that_is_no_pose_is_ignored_and_said_in_one_line(robot, odd):
    robot.transforms(odd, odometry(x=3.0, frame='map', child='odom'))
    assert robot.senses.pose() == (3.0, 2.0, 0.0)
    assert robot.warnings == ['tf has odom -> base_footprint with numbers that make no pose: ignored']


@pytest.mark.parametrize('other', [
    odometry(frame='', child=''), odometry(frame='odom', child='odom'), odometry(frame='base_footprint', child='map'),
    odometry(frame='x' * 100_000), odometry(child='\x1b[2J'), odometry(x=math.nan, child='laser')], ids=lambda _: '')
def test_transforms_of_other_frames_do_not_count(robot, other):
    robot.transforms(other)
    assert robot.senses.pose() == (0.0, 0.0, 0.0) and not robot.warnings


@pytest.mark.parametrize('stamp', [rospy.Time(), rospy.Time(2 ** 32 - 1, 999_999_999)])
def test_the_transform_that_came_last_counts_whatever_its_stamp(robot, stamp):
    robot.transforms(odometry(x=4.0, stamp=stamp))
    assert robot.senses.pose() == (4.0, 2.0, 0.0)
    robot.transforms(odometry(frame='/odom', child='/base_footprint'))
    assert robot.senses.pose() == (1.0, 2.0, 0.0)


def test_what_is_missing_is_named(monkeypatch):
    robot = Robot(monkeypatch, 'rumba2')
    assert robot.senses.missing() == 'no charge: rumba2/battery_state tells no percentage'
    robot.tells('battery_state', BatteryState(percentage=math.nan))
    assert robot.senses.missing() == 'no charge: rumba2/battery_state tells no percentage'
    robot.tells('battery_state', BatteryState(percentage=0.0))
    assert robot.senses.missing() == 'no pose: tf has no map -> rumba2/odom -> rumba2/base_footprint'
    robot.stands()
    robot.reads(1.0, ['bumper', 'dock_status'])
    assert robot.senses.missing() == 'no reading: nothing new on rumba2/cliff'
    assert robot.senses.look() is None
    robot.reads(1.0, ['cliff'])
    assert robot.senses.look().state_of_charge == 0.0
    robot.reads(1.1, ['dock_status'])
    assert robot.senses.missing() == 'no reading: nothing new on rumba2/bumper and rumba2/cliff'


def test_readings_that_are_not_complete_are_counted(robot):
    robot.reads(1.0)
    assert robot.senses.unread == 0
    for seconds in (1.1, 1.2, 1.3):
        robot.reads(seconds, ['bumper', 'dock_status'])
    assert robot.senses.unread == 3
    robot.reads(1.3, ['cliff'])
    assert robot.senses.unread == 0


def test_a_robot_is_alone_without_any_publisher(robot):
    assert not robot.senses.is_alone
    robot.connections = 0
    assert robot.senses.is_alone


def test_a_robot_has_fallen_while_the_newest_reading_of_its_cliff_sensors_says_so(robot):
    assert not robot.senses.has_fallen
    robot.reads(1.0, is_cliff_left=True)
    assert not robot.senses.has_fallen
    robot.reads(1.1, is_wheel_dropped=True)
    assert robot.senses.has_fallen
    robot.reads(1.2)
    assert not robot.senses.has_fallen


def test_the_floor_is_what_was_told_last(robot):
    assert robot.senses.cleaning is None
    robot.tells('cleaning_status', CleaningStatus(coverage=0.5))
    robot.tells('cleaning_status', CleaningStatus(coverage=0.75))
    assert robot.senses.cleaning.coverage == 0.75
    unknown = conversions.no_cleaning_status()
    assert all(math.isnan(getattr(unknown, field)) for field in CleaningStatus.__slots__ if field != 'header')


def test_a_tilted_transform_has_the_heading_of_its_forward_axis():
    half = math.radians(25.0)
    turned = Transform(Vector3(1.0, 2.0, 3.0), Quaternion(0.0, 0.0, math.sin(half), math.cos(half)))
    assert transform_pose(turned) == pytest.approx((1.0, 2.0, math.radians(50.0)))
    upside = Transform(Vector3(), Quaternion(1.0, 0.0, 0.0, 0.0))
    assert transform_pose(upside).theta == pytest.approx(0.0)


def test_commands_missions_and_outcomes_become_messages():
    twist = conversions.velocity(Command(0.25, -1.5))
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (0.25, 0.0, -1.5)
    status = conversions.mission_status(State.CHARGING, 'bounce', 'charging', rospy.Time(5))
    assert (status.state, status.strategy, status.message) == (status.CHARGING, 'bounce', 'charging')
    assert (status.header.frame_id, status.header.stamp.secs) == ('map', 5)
    assert {state.name: int(state) for state in State} == {
        name: getattr(status, name) for name in dir(status) if name.isupper()}
    outcome = conversions.outcome(Outcome.NO_PATH, 'no path')
    assert (outcome.code, outcome.message) == (outcome.NO_PATH, 'no path')


# --- a world that is gone ---------------------------------------------------------------------------------------------

def test_what_is_older_than_a_new_world_does_not_count(robot):
    robot.reads(1.0)
    robot.tells('cleaning_status', CleaningStatus(header=Header(stamp=rospy.Time(1)), coverage=0.9))
    robot.senses.forget(rospy.Time(2), is_new_run=False)
    assert robot.senses.look() is None and robot.senses.cleaning is None
    assert robot.reads(2.0) == 0
    robot.tells('battery_state', BatteryState(header=Header(stamp=rospy.Time(2)), percentage=0.1))
    robot.tells('cleaning_status', CleaningStatus(header=Header(stamp=rospy.Time(2)), coverage=0.9))
    assert robot.reads(2.1) == 1
    assert robot.senses.look() is None and robot.senses.cleaning is None
    robot.tells('battery_state', BatteryState(header=Header(stamp=rospy.Time(3)), percentage=0.7))
    robot.tells('cleaning_status', CleaningStatus(header=Header(stamp=rospy.Time(3)), coverage=0.1))
    assert robot.senses.look().state_of_charge == pytest.approx(0.7)
    assert robot.senses.cleaning.coverage == 0.1


def test_a_battery_that_gives_no_stamps_counts_in_each_world(robot):
    robot.senses.forget(rospy.Time(2), is_new_run=False)
    robot.tells('battery_state', BatteryState(percentage=0.4))
    robot.reads(3.0)
    assert robot.senses.look().state_of_charge == pytest.approx(0.4)


def test_poses_of_a_time_that_is_over_are_forgotten_with_their_simulator(robot):
    robot.senses.forget(rospy.Time(2), is_new_run=False)
    assert robot.senses.pose() is not None
    robot.senses.forget(rospy.Time(0), is_new_run=True)
    assert robot.senses.pose() is None


def test_a_localisation_that_is_static_outlives_a_simulator(robot):
    robot.stands(odom=Pose(1.0, 0.0, 0.0), topic='/tf_static')
    robot.transforms(odometry(x=0.5, y=0.0))
    robot.senses.forget(rospy.Time(0), is_new_run=True)
    assert robot.senses.pose() is None
    robot.transforms(odometry(x=0.25, y=0.0))
    assert robot.senses.pose() == (1.25, 0.0, 0.0)


# --- lockstep ---------------------------------------------------------------------------------------------------------

WORLD = 'run', 0


def parts_of(stamp):
    """What a world in lockstep publishes up to a control tick: a function for each message."""
    header = Header(stamp=stamp)
    return {
        'bumper': lambda robot: robot.tells('bumper', Bumper(header=header)),
        'cliff': lambda robot: robot.tells('cliff', Cliff(header=header)),
        'dock_status': lambda robot: robot.tells('dock_status', DockStatus(header=header)),
        'battery_state': lambda robot: robot.tells('battery_state', BatteryState(header=header, percentage=0.5)),
        'cleaning_status': lambda robot: robot.tells('cleaning_status', CleaningStatus(header=header)),
        'tf': lambda robot: robot.transforms(odometry(stamp=stamp), odometry(stamp=stamp, frame='map', child='odom')),
        'tick': lambda robot: robot.senses.on_tick(Lockstep(header, *WORLD, stamp, rospy.Time(), stamp))}


@pytest.mark.parametrize('last', sorted(parts_of(rospy.Time(1))))
def test_in_lockstep_a_reading_is_complete_once_everything_of_its_tick_has_come(monkeypatch, last):
    robot = Robot(monkeypatch, lockstep=WORLD)
    for stamp in rospy.Time(1), rospy.Time(2):
        parts = parts_of(stamp)
        before = robot.readings
        for topic in [topic for topic in parts if topic != last]:
            parts[topic](robot)
        assert robot.readings == before
        parts[last](robot)
        assert (robot.readings, robot.senses.stamp) == (before + 1, stamp)


def test_in_lockstep_a_topic_that_is_never_published_is_not_waited_for(monkeypatch):
    robot = Robot(monkeypatch, lockstep=WORLD)
    parts = parts_of(rospy.Time(1))
    for topic in 'bumper', 'cliff', 'dock_status', 'battery_state':
        parts[topic](robot)
    robot.senses.on_tick(Lockstep(header=Header(stamp=rospy.Time(1)), run=WORLD[0]))
    assert robot.readings == 1


def test_in_lockstep_a_reading_of_another_world_counts_once_that_is_known(monkeypatch):
    robot = Robot(monkeypatch, lockstep=('run', 1))
    for part in parts_of(rospy.Time(5)).values():
        part(robot)
    assert robot.readings == 0
    robot.lockstep = WORLD
    robot.senses.forget(rospy.Time(4), is_new_run=False)
    assert (robot.readings, robot.senses.stamp) == (1, rospy.Time(5))
    assert robot.senses.look() is not None


# --- certainty --------------------------------------------------------------------------------------------------------

def believes(stamp, **covariance):
    """What a localisation tells: entries of the covariance by their number, such as c35."""
    message = PoseWithCovarianceStamped(header=Header(stamp=stamp))
    for name, value in covariance.items():
        message.pose.covariance[int(name[1:])] = value
    return message


def test_without_a_localisation_that_tells_it_the_pose_is_certain(robot):
    robot.reads(1.0)
    assert robot.senses.look().covariance == CERTAIN


def test_the_covariance_is_that_of_x_y_and_heading(robot):
    robot.reads(1.0)
    told = believes(rospy.Time(1), c0=1.0, c1=2.0, c5=3.0, c7=4.0, c11=5.0, c14=99.0, c30=6.0, c35=7.0)
    robot.tells('amcl_pose', told)
    assert robot.senses.look().covariance == ((1.0, 2.0, 3.0), (0.0, 4.0, 5.0), (6.0, 0.0, 7.0))


@pytest.mark.parametrize('number', [math.nan, math.inf])
def test_a_covariance_that_is_not_finite_means_that_nothing_is_known(robot, number):
    robot.reads(1.0)
    robot.tells('amcl_pose', believes(rospy.Time(1), c7=number))
    assert robot.senses.look().covariance == UNKNOWN and robot.senses.look().is_lost


def test_a_localisation_that_falls_silent_leaves_nothing_known_until_it_is_back(robot):
    robot.tells('amcl_pose', believes(rospy.Time(1), c0=0.01))
    for seconds, is_lost in ((1.0, False), (3.0, False), (3.1, True)):
        robot.reads(seconds)
        assert robot.senses.look().is_lost is is_lost
    robot.tells('amcl_pose', believes(rospy.Time(3), c0=0.01))
    assert not robot.senses.look().is_lost
    robot.senses.forget(rospy.Time(4), is_new_run=True)
    robot.stands()
    robot.tells('battery_state', BatteryState(header=Header(stamp=rospy.Time(90)), percentage=0.5))
    robot.reads(90.0)
    assert robot.senses.look().covariance == CERTAIN


def test_the_laser_is_silent_for_as_long_as_the_pose_is_newer_than_the_correction(robot):
    robot.reads(1.0)
    assert robot.senses.look().silence == 0.0  # nobody tells a covariance
    for stamp, silence in ((rospy.Time(0, 900_000_000), 0.0), (rospy.Time(1), 0.0), (rospy.Time(3, 500_000_000), 2.5)):
        robot.tells('amcl_pose', believes(stamp, c0=0.04))
        assert robot.senses.look().silence == silence
    robot.reads(3.5)
    assert robot.senses.look().is_lost
    robot.transforms(transform('map', 'odom', Pose(0.0, 0.0, 0.0), rospy.Time(3, 500_000_000)))
    assert robot.senses.look().silence == 0.0 and not robot.senses.look().is_lost


def test_a_correction_that_is_static_is_never_too_old(robot):
    robot.transforms(transform('map', 'odom', Pose(0.0, 0.0, 0.0), rospy.Time(1)), topic='/tf_static')
    robot.reads(9.0)
    robot.tells('amcl_pose', believes(rospy.Time(9), c0=0.04))
    assert robot.senses.look().silence == 0.0


@pytest.mark.parametrize('last', ['amcl_pose', 'correction', 'tick'])
def test_in_lockstep_a_localisation_is_waited_for_if_there_is_one(monkeypatch, last):
    robot, stamp = Robot(monkeypatch, lockstep=WORLD), rospy.Time(1)
    parts = {**parts_of(stamp), 'tf': lambda robot: robot.transforms(odometry(stamp=stamp)),
             'amcl_pose': lambda robot: robot.tells('amcl_pose', believes(stamp)),
             'correction': lambda robot: robot.transforms(odometry(stamp=stamp, frame='map', child='odom')),
             'tick': lambda robot: robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, stamp, stamp))}
    for topic in [topic for topic in parts if topic != last]:
        parts[topic](robot)
    assert robot.readings == 0
    parts[last](robot)
    assert robot.readings == 1


@pytest.mark.parametrize('silence, readings', [(0.5, 0), (1.5, 1)])
def test_in_lockstep_a_correction_is_not_waited_for_while_the_laser_is_silent(monkeypatch, silence, readings):
    robot, scanned = Robot(monkeypatch, lockstep=WORLD), rospy.Time(1)
    stamp = scanned + rospy.Duration(silence)
    robot.transforms(odometry(stamp=scanned, frame='map', child='odom'))
    for topic, tell in {**parts_of(stamp), 'tf': lambda robot: robot.transforms(odometry(stamp=stamp))}.items():
        if topic != 'tick':
            tell(robot)
    robot.tells('amcl_pose', believes(stamp))
    robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, stamp, stamp))
    assert robot.readings == readings


def test_in_lockstep_a_scan_without_a_localisation_is_not_waited_for(monkeypatch):
    robot, stamp = Robot(monkeypatch, lockstep=WORLD), rospy.Time(1)
    robot.connections = 0
    for part in parts_of(stamp).values():
        part(robot)
    robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, rospy.Time(9), stamp))
    assert robot.readings == 1


def test_in_lockstep_a_localisation_that_was_there_before_is_waited_for_although_it_is_not_connected_yet(monkeypatch):
    robot, stamp = Robot(monkeypatch, lockstep=WORLD, expected='rumba/amcl_pose'), rospy.Time(1)
    robot.connections = 0
    for topic, tell in parts_of(stamp).items():
        if topic != 'tick':
            tell(robot)
    robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, rospy.Time(1), stamp))
    assert robot.readings == 0
    robot.tells('amcl_pose', believes(stamp))
    assert robot.readings == 1
