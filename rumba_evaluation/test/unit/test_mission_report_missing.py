"""From a bag to a report: topics, values and stamps that are missing, and maps that do not fit."""

import math

import genpy
import mission_bags
import numpy as np
import pytest
import rosbag
from mission_bags import LEAST, recorded_by_the_wall, without, write
from pytest import approx
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from rumba_evaluation.report.mission_events import events
from rumba_evaluation.report.mission_summary import summary
from rumba_evaluation.ros.mission_report import mission_bag, mission_report
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.conversions import transform


def test_battery_status_alone_is_enough(tmp_path):
    record = mission_bag.read(write(tmp_path / 'a.bag', ['battery_status'], maps=()))
    told = summary(record)
    assert (told.duration, told.charges, told.charge) == (approx(36.0), 1, (100.0, 58.0, 8.0))
    assert told.distance == approx(12.0)
    assert told.charging_time == approx(10.0, abs=0.4)
    assert (told.busy, told.coverage, told.areas, told.energy, told.bumps) == (None,) * 5 and told.outcome == ''
    assert (record.floor, record.swept) == (None, None)
    assert not any(event.kind == 'cliff' for event in events(record))


def test_without_battery_state_the_battery_is_charged_while_docked(tmp_path):
    told = summary(mission_bag.read(write(tmp_path / 'a.bag', without('battery_state', 'ground_truth'))))
    assert (told.charges, told.charging_time, told.energy) == (1, approx(10.0), None)
    assert told.distance == approx(12.0)


def test_without_dock_status_the_robot_is_docked_while_its_battery_is_charged(tmp_path):
    texts = [event.text for event in events(mission_bag.read(write(tmp_path / 'a.bag', LEAST)))]
    assert texts.index('Left the dock, battery 100 %.') < texts.index('Docked and charging, battery 8 %.')


@pytest.mark.parametrize('when', [mission_bags.recorded, recorded_by_the_wall])
def test_without_cleaning_status_the_coverage_comes_from_the_grids(tmp_path, when):
    record = mission_bag.read(write(tmp_path / 'a.bag', without('cleaning_status'), when=when))
    told = summary(record)
    assert (told.coverage, told.areas) == (0.75, approx((0.75, 1.0)))
    assert record.coverage.times.tolist() == approx(np.arange(37.0).tolist(), abs=1e-3)
    assert record.coverage.values.tolist() == [0.0] * 36 + [0.75]


def test_of_many_grids_some_and_the_last_are_read(tmp_path, monkeypatch):
    monkeypatch.setattr('rumba_evaluation.ros.mission_report.recorded_robot.GRIDS', 5)
    record = mission_bag.read(write(tmp_path / 'a.bag', without('cleaning_status')))
    assert record.coverage.times.tolist() == approx([4.0, 12.0, 20.0, 28.0, 36.0])
    assert record.coverage.values[-1] == 0.75


def test_values_that_are_not_finite_are_ignored(tmp_path):
    def spoil(name, message, t):
        if name == 'ground_truth' and 3.0 < t < 4.0:
            message.pose.pose.position.y = math.nan if t < 3.5 else 1e300
        if name == 'battery_state' and 3.0 < t < 5.0:
            message.percentage = message.current = math.nan
        if name == 'cleaning_status' and t > 30.0:
            message.coverage = math.inf
    told = summary(mission_bag.read(write(tmp_path / 'a.bag', change=spoil)))
    assert (told.distance, told.coverage, told.jumps) == (approx(12.0), 0.75, 0)
    assert told.charge == approx((100.0, 58.0, 8.0))
    assert told.energy == approx((0.2, 150.0 / 3600.0), rel=0.01)


def test_one_message_of_each_topic_is_a_mission_of_0_seconds(tmp_path, capsys):
    mission_report.main([write(tmp_path / 'a.bag', until=0.0)])
    assert capsys.readouterr().out.splitlines()[1:] == [
        'The robot had no mission while this was recorded.',
        'rumba: 0.0 % swept, 100.0 % of the dirt left, 0.0 m driven, bumps: 0',
        'battery: 100 % to 100 %, lowest 100 %, charges during the mission: 0, on the charger for 0:00:00 in all']


def test_stamps_that_were_never_set_and_a_rotated_map(tmp_path):
    def spoil(name, message, t):
        if hasattr(message, 'header'):
            message.header.stamp = genpy.Time()
    path = write(tmp_path / 'a.bag', change=spoil, maps=())
    with rosbag.Bag(path, 'a') as bag:
        turned = mission_bags.grid(mission_bags.FLOOR)
        turned.info.origin.orientation.z = 0.5
        bag.write('/map', turned, genpy.Time(100))
    record = mission_bag.read(path)
    assert (summary(record).duration, summary(record).distance) == approx((36.0, 12.0))
    assert record.floor is None and record.remarks == [
        'The map is not drawn: it is damaged, or rotated against the axes.']


def with_own_map(path, true_map='/simulator/map', parent='world', robot='/rumba'):
    """A mission whose robot made a map, turned by a right angle and moved; returns the path of the bag."""
    write(path, namespace=robot)  # its own map has its lower left corner at (-1, 2) m, and cells of 0.5 m
    true = mission_bags.grid(np.zeros((6, 6), int))
    true.info.origin.position.x, true.info.origin.position.y = 1.0, -2.0
    link = transform(parent, 'map', Pose(5.0, 0.0, 0.5 * math.pi), None)
    with rosbag.Bag(str(path), 'a') as bag:
        bag.write(true_map, true, genpy.Time(100))
        bag.write('/tf_static', TFMessage([transform('base_link', 'laser', Pose(9.0, 9.0, 1.0), None), link]),
                  genpy.Time(100))
    return str(path)


@pytest.mark.parametrize('topic, robot', [
    ('/simulator/map', '/rumba'), ('simulator/map', '/rumba'), ('/upstairs/simulator/map', '/upstairs/rumba')])
def test_a_map_that_the_robot_made_lies_over_the_true_one(tmp_path, topic, robot):
    record = mission_bag.read(with_own_map(tmp_path / 'a.bag', topic, robot=robot))
    assert record.floor.cells.shape == (6, 6) and record.remarks == []
    assert record.known.cells.tolist() == turned_own_map().tolist()
    assert record.known[1:] == record.floor[1:] == (0.5, 1.0, -2.0)


def turned_own_map():
    """The map of the robot on the cells of the true one: x of its frame is y of the world, y is -x."""
    shown = np.full((6, 6), -1)
    for (row, column), value in np.ndenumerate(mission_bags.FLOOR):
        x, y = 5.0 - (2.25 + 0.5 * row), -0.75 + 0.5 * column
        shown[int((y + 2.0) / 0.5), int((x - 1.0) / 0.5)] = value
    return shown


@pytest.mark.parametrize('bag, remarks', [
    ({'true_map': '/upstairs/simulator/map'}, []),
    ({'parent': 'earth'}, ['The map of the robot is not drawn: it needs /map and /tf_static.'])])
def test_a_map_is_not_laid_over_that_of_another_house_or_in_an_unknown_place(tmp_path, bag, remarks):
    record = mission_bag.read(with_own_map(tmp_path / 'a.bag', **bag))
    assert record.known is None and record.remarks == remarks
    assert record.floor.cells.shape == ((6, 6) if remarks else mission_bags.FLOOR.shape)


@pytest.mark.parametrize('topics', [['battery_status'], ['ground_truth', 'battery_state']])
def test_messages_without_stamps_in_the_first_seconds_of_a_simulation(tmp_path, topics):
    def spoil(name, message, t):
        if hasattr(message, 'header'):
            message.header.stamp = genpy.Time()
    path = write(tmp_path / 'a.bag', topics, change=spoil, when=lambda t: 0.5 + t, maps=())
    record = mission_bag.read(path)
    assert (record.began, summary(record).duration, summary(record).driving_time) == approx((0.5, 36.0, 24.0), abs=0.2)


def test_messages_before_the_first_and_after_the_last_stamp_get_the_right_times(tmp_path):
    path = str(tmp_path / 'a.bag')
    with rosbag.Bag(path, 'w') as bag:
        mission_bags.add(bag, ['ground_truth'], when=recorded_by_the_wall, until=20.0)
        mission_bags.add(bag, ['battery_status'], when=lambda t: recorded_by_the_wall(t - 3.0))
    record = mission_bag.read(path)
    assert record.began == approx(97.0)
    assert record.charge.times[[0, -1]].tolist() == approx([0.0, 36.0])
    assert record.path.times[[0, -1]].tolist() == approx([3.0, 23.0])


def test_messages_of_another_type_on_a_topic_are_ignored(tmp_path):
    path = str(tmp_path / 'a.bag')
    with rosbag.Bag(path, 'w') as bag:
        mission_bags.add(bag)
        bag._topic_connections.pop('/rumba/bumper')  # else rosbag writes the type of the earlier messages
        bag.write('/rumba/bumper', String('none'), genpy.Time(110))
    assert summary(mission_bag.read(path)).bumps == 3


def test_a_clock_that_was_set_back_is_not_used(tmp_path):
    def restart(name, message, t):
        if hasattr(message, 'header') and t >= 18.0:
            message.header.stamp = genpy.Time.from_sec(t - 18.0)
    record = mission_bag.read(write(tmp_path / 'a.bag', change=restart, when=lambda t: 1.7e9 + t))
    assert (summary(record).duration, summary(record).distance) == approx((36.0, 12.0))
    assert record.began == 1.7e9 and 'set back' in record.remarks[0]


def test_latched_states_get_their_times_from_the_recorder(tmp_path):
    """The stamp of a latched message can be older than all other messages."""
    def age(name, message, t):
        if name == 'mission_status' and t < 2.0:
            message.header.stamp = genpy.Time(3)
    record = mission_bag.read(write(tmp_path / 'a.bag', change=age))
    assert [state.time for state in record.states[:3]] == approx([0.0, 1.0, 2.0])
