"""From a bag to a report: the figures are those of the recorded mission, on any clock, and of any of its robots."""

import math

import genpy
import mission_bags
import pytest
import rosbag
from mission_bags import EVENTS, LEAST, recorded, recorded_by_the_wall, write
from pytest import approx

from rumba_evaluation.report.mission_events import contacts, events
from rumba_evaluation.report.mission_summary import summary
from rumba_evaluation.ros.mission_report import mission_bag


@pytest.mark.parametrize('when', [mission_bags.recorded, recorded_by_the_wall])
def test_the_figures_are_those_of_the_mission_on_any_clock_of_the_recorder(tmp_path, when):
    record = mission_bag.read(write(tmp_path / 'a.bag', when=when))
    told = summary(record)
    assert (told.duration, told.busy, told.distance) == approx((36.0, 34.0, 12.0))
    assert (told.driving_time, told.mean_speed) == approx((24.0, 0.5))
    assert (told.coverage, *told.areas) == approx((0.9, 18.0, 20.0))
    assert (told.charges, told.charging_time) == (1, approx(10.0))
    assert told.charge == approx((100.0, 58.0, 8.0))
    assert told.energy == approx((24.0 * 30.0 / 3600.0, 10.0 * 15.0 / 3600.0), rel=0.01)
    assert (told.bumps, told.jumps) == (3, 0)
    assert told.outcome.endswith('less than the target of 99 %: 90.0 % swept <&>.') and record.dirt == approx(0.25)
    assert record.began == approx(100.0)
    assert record.swept.cells.tolist() == mission_bags.SWEPT.tolist()
    assert record.floor.cells.tolist() == mission_bags.FLOOR.tolist()
    assert record.floor[1:] == (0.5, -1.0, 2.0)
    assert contacts(record) == [approx((1.0, 1.0))]


@pytest.mark.parametrize('step', [1.5, 5.4, 7.0])
@pytest.mark.parametrize('begin', [recorded, recorded_by_the_wall])
def test_a_recorder_whose_clock_advances_in_steps_moves_nobody(tmp_path, step, begin):
    """At a high speed the recorder gets the messages of many seconds between two readings of its clock."""
    record = mission_bag.read(write(tmp_path / 'a.bag', when=lambda t: begin(step * math.floor(t / step))))
    told = summary(record)
    assert told.jumps == 0 and not any(event.kind == 'jump' for event in events(record))
    assert (told.duration, told.busy, told.distance, told.driving_time) == approx((36.0, 34.0, 12.0, 24.0))


@pytest.mark.parametrize('lag', [lambda t: 5.4, lambda t: 4.0 - 4.0 * math.cos(0.2 * t), lambda t: 0.25 * t])
def test_a_recorder_that_is_late_moves_nobody(tmp_path, lag):
    record = mission_bag.read(write(tmp_path / 'a.bag', when=lambda t: recorded(t + lag(t))))
    told = summary(record)
    assert (told.jumps, told.duration, told.distance) == (0, approx(36.0), approx(12.0))
    assert told.charging_time == approx(10.0)


@pytest.mark.parametrize('step', [1.5, 5.4])
def test_messages_without_stamps_are_spread_over_the_steps_of_the_recorders_clock(tmp_path, step):
    path = write(tmp_path / 'a.bag', ['battery_status'], when=lambda t: recorded(step * math.floor(t / step)))
    told = summary(mission_bag.read(path))
    assert (told.jumps, told.distance) == (0, approx(12.0))
    assert told.driving_time == approx(24.0, abs=0.1 * step)


def test_a_robot_that_somebody_puts_elsewhere_is_told_although_the_recorder_is_late(tmp_path):
    def put(name, message, t):
        if name == 'ground_truth' and t >= 12.0:
            message.pose.pose.position.y += 1.0
    path = write(tmp_path / 'a.bag', change=put, when=lambda t: recorded(5.4 * math.floor(t / 5.4)))
    found = [event for event in events(mission_bag.read(path)) if event.kind == 'jump']
    assert [event.time for event in found] == approx([12.0])


@pytest.mark.parametrize('when', [mission_bags.recorded, recorded_by_the_wall])
def test_events_are_in_order(tmp_path, when):
    found = events(mission_bag.read(write(tmp_path / 'a.bag', when=when)))
    assert [(round(event.time, 3), event.text) for event in found] == EVENTS


@pytest.fixture(scope='module')
def two_robots(tmp_path_factory):
    """A bag of rumba, and of /up/rumba2, whose recording ends at (5, 1) m."""
    path = write(tmp_path_factory.mktemp('two') / 'two.bag', LEAST, 'rumba', maps=('/map',))  # a name without a slash
    with rosbag.Bag(path, 'a') as bag:
        mission_bags.add(bag, LEAST, '/up/rumba2', until=10.0)
        bag.write('/up/map', mission_bags.grid(mission_bags.SWEPT), genpy.Time(100))
        bag.write('/upper/map', mission_bags.grid(-mission_bags.SWEPT), genpy.Time(100))
    return path


@pytest.mark.parametrize('robot, name, distance, floor', [
    ('', 'rumba', 12.0, mission_bags.FLOOR), ('rumba', 'rumba', 12.0, mission_bags.FLOOR),
    ('/rumba', 'rumba', 12.0, mission_bags.FLOOR), ('rumba2', 'up/rumba2', 4.0, mission_bags.SWEPT),
    ('up/rumba2', 'up/rumba2', 4.0, mission_bags.SWEPT), ('/up/rumba2/', 'up/rumba2', 4.0, mission_bags.SWEPT)])
def test_a_robot_is_chosen_by_its_name_with_the_map_of_its_namespace(two_robots, robot, name, distance, floor):
    record = mission_bag.read(two_robots, robot)
    assert (record.robot, summary(record).distance) == (name, approx(distance))
    assert record.floor.cells.tolist() == floor.tolist()
    mate, = record.mates
    assert {(one.robot, round(summary(one).distance, 6)) for one in (record, mate)} == {
        ('rumba', 12.0), ('up/rumba2', 4.0)}
    assert record.remarks == []


def test_the_only_robot_with_enough_topics_is_chosen(tmp_path):
    path = write(tmp_path / 'a.bag', LEAST, '/b')
    with rosbag.Bag(path, 'a') as bag:
        mission_bags.add(bag, ['bumper'], '/rumba')
    record = mission_bag.read(path)
    assert (record.robot, record.mates) == ('b', [])
    assert record.remarks == ['Also in the bag, without what a report needs: rumba.']


def test_topics_without_a_namespace_belong_to_a_robot_too(tmp_path):
    assert mission_bag.read(write(tmp_path / 'a.bag', LEAST, '')).robot == '/'
