"""From a bag to a report: the figures are those of the recorded mission, also with missing topics and other clocks."""

import math
import os
import pathlib
import re
import subprocess
import sys

import genpy
import mission_bags
import numpy as np
import pytest
import rosbag
from mission_bags import ALL, recorded, recorded_by_the_wall, write
from pytest import approx
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from rumba_evaluation.report.mission_events import contacts, events
from rumba_evaluation.report.mission_summary import summary
from rumba_evaluation.ros.mission_report import mission_bag, mission_report
from rumba_msg.msg import CleanActionGoal, CleanGoal, CleaningStatus
from rumba_sim.model.geometry import Pose
from rumba_sim.ros.common.conversions import transform

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'mission_report'
LEAST = ('ground_truth', 'battery_state')  # enough for a report


def without(*names):
    """All topics except some."""
    return [name for name in ALL if name not in names]


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """The whole mission."""
    return write(tmp_path_factory.mktemp('bag') / 'a <b> & c.bag')


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


EVENTS = [
    (0.0, 'The recording begins at (1.00, 1.00) m, battery 100 %.'),
    (2.0, 'Left the dock, battery 100 %.'),
    (3.0, 'Mission: cleaning (spiral)'),
    (5.0, 'Bump at (2.50, 1.00) m.'),
    (10.0, 'Bump at (5.00, 1.00) m.'),
    (15.0, 'A wheel hangs over a cliff at (4.50, 3.00) m.'),
    (20.0, 'Mission: returning'),
    (20.0, 'Bump at (2.00, 3.00) m.'),
    (25.5, 'Battery below 10 %.'),
    (26.0, 'Docked and charging, battery 8 %.'),
    (36.0, 'The mission ends: 90.0 % swept <&>'),
    (36.0, 'The recording ends at (1.00, 1.00) m, battery 58 %.')]


@pytest.mark.parametrize('when', [mission_bags.recorded, recorded_by_the_wall])
def test_events_are_in_order(tmp_path, when):
    found = events(mission_bag.read(write(tmp_path / 'a.bag', when=when)))
    assert [(round(event.time, 3), event.text) for event in found] == EVENTS


# --- missing topics and values --------------------------------------------------------------------------------------

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


# --- several robots, namespaces -------------------------------------------------------------------------------------

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
    assert record.remarks == [f'Also in the bag: {"rumba" if name != "rumba" else "up/rumba2"}.']


def test_the_only_robot_with_enough_topics_is_chosen(tmp_path):
    path = write(tmp_path / 'a.bag', LEAST, '/b')
    with rosbag.Bag(path, 'a') as bag:
        mission_bags.add(bag, ['bumper'], '/rumba')
    assert mission_bag.read(path).robot == 'b'


def test_topics_without_a_namespace_belong_to_a_robot_too(tmp_path):
    assert mission_bag.read(write(tmp_path / 'a.bag', LEAST, '')).robot == '/'


# --- the command ----------------------------------------------------------------------------------------------------

def test_the_command_writes_beside_the_bag_and_needs_no_master(bag):
    output = bag.replace('.bag', '.html')
    done = subprocess.run([sys.executable, str(SCRIPT), bag], env={**os.environ, 'ROS_MASTER_URI': 'http://nowhere:1'},
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout.splitlines() == [
        output, 'The robot cleaned 90.0 % of the floor in 0:00:34 and is back on its dock, less than the target of '
                '99 %: 90.0 % swept <&>.',
        'rumba: 90.0 % swept, 25.0 % of the dirt left, 12.0 m driven at 0.50 m/s, bumps: 3',
        'battery: 100 % to 58 %, lowest 8 %, charges during the mission: 1, on the charger for 0:00:10 in all']
    page = pathlib.Path(output).read_text(encoding='utf-8')
    assert '<title>Mission of rumba: a &lt;b&gt; &amp; c.bag</title>' in page
    assert '90.0 % swept &lt;&amp;&gt;' in page and '<&>' not in page
    for text in ('>90.0 %<', '>18.0 of 20.0 m², target 99 %<', '>0:00:34<', '>ideal: 0:06:32, recorded: 0:00:36<',
                 '>12.0 m<', '>0.50 m/s while driving<', '>during the mission; on the charger for 0:00:10 in all<',
                 '<dt>Charges</dt><dd>1<', '>0.20 Wh<', '<dt>Dirt left</dt><dd>25.0 %<', '>from 100 %, lowest 8 %<',
                 '<dt>Bumps</dt><dd>3<', '2.0 m × 1.5 m, cells of 50 cm',
                 'cleaning 0:00:17', '100.0 s after the simulation began'):
        assert text in page, text
    told = re.findall(r'<td>(\d:\d\d:\d\d)</td><td>(.*?)</td>', page)
    assert [text for _, text in told] == [text.replace('<&>', '&lt;&amp;&gt;') for _, text in EVENTS]
    assert told[3][0] == '0:00:05'


def test_the_command_writes_to_the_given_path(bag, tmp_path, capsys):
    output = tmp_path / 'page'
    mission_report.main([bag, '--output', str(output), '--robot', 'rumba'])
    first = output.read_bytes()
    mission_report.main([bag, '--output', str(output)])
    assert capsys.readouterr().out.splitlines()[0] == str(output)
    assert output.read_bytes() == first, 'the same bag gives the same page'


def test_without_matplotlib_the_message_names_the_package(tmp_path):
    script = ('import sys; sys.modules["matplotlib"] = None; '
              'from rumba_evaluation.ros.mission_report import mission_report; mission_report.main()')
    done = subprocess.run([sys.executable, '-c', script, write(tmp_path / 'a.bag', LEAST, until=1.0)],
                          env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True)
    assert (done.returncode, done.stdout) == (2, '')
    assert re.fullmatch('mission_report: the figures need matplotlib .*: install the package python3-matplotlib\n',
                        done.stderr)


def test_help_names_every_option(capsys):
    with pytest.raises(SystemExit) as end:
        mission_report.main(['--help'])
    told = capsys.readouterr().out
    assert end.value.code == 0 and all(word in told for word in ('FILE.bag', '--output', '--robot', '--target'))


def test_the_target_is_that_of_the_recorded_goal_unless_it_is_given(tmp_path):
    path = write(tmp_path / 'a.bag')
    assert mission_bag.read(path).target == 0.99
    with rosbag.Bag(path, 'a') as bag:
        for target in (0.8, 0.9, 0.0):
            bag.write('/rumba/clean/goal', CleanActionGoal(goal=CleanGoal(target_coverage=target)), genpy.Time(101))
    assert mission_bag.read(path).target == 0.9 and mission_bag.read(path, target=0.5).target == 0.5


def test_topics_with_several_publishers_are_named(tmp_path):
    path = write(tmp_path / 'a.bag', LEAST)
    with rosbag.Bag(path, 'a') as bag:
        for node in ('/simulator', '/student'):
            message = CleaningStatus(coverage=float(node == '/student'))
            bag.write('/rumba/cleaning_status', message, genpy.Time(110), connection_header={
                'topic': '/rumba/cleaning_status', 'type': message._type, 'md5sum': message._md5sum,
                'message_definition': message._full_text, 'callerid': node})
            bag._topic_connections.clear()  # else it writes a connection for each topic, not for each publisher
    assert mission_bag.read(path).remarks == [
        '/rumba/cleaning_status was published by /simulator and /student: the figures mix what they told.']
