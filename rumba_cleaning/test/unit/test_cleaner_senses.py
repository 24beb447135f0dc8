"""How the cleaner reads a robot's topics: complete readings, the time between them, poses, and what is missing."""

import math

import pytest
import rospy
from geometry_msgs.msg import Quaternion, Transform, Vector3
from robot_topics import Robot, odometry, standing
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Header

from rumba_cleaning.behaviour import Command
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_msg.msg import CleaningStatus
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.conversions import transform_pose


@pytest.fixture
def robot(monkeypatch):
    """A robot that stands at the origin, with half its charge."""
    return standing(monkeypatch)


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
    assert robot.senses.missing() == 'no charge: rumba2/battery_state has no percentage'
    robot.tells('battery_state', BatteryState(percentage=math.nan))
    assert robot.senses.missing() == 'no charge: rumba2/battery_state has no percentage'
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
