"""Bags and commands that cannot be used end with exit code 2 and one line that gives the reason."""

import itertools
import os

import genpy
import genpy.dynamic
import mission_bags
import odd_messages
import pytest
import rosbag
from mission_bags import write
from sensor_msgs.msg import BatteryState
from std_msgs.msg import String

from rumba_evaluation.ros.mission_report import mission_report

LEAST = ('ground_truth', 'battery_state')
RECORD = ('record a mission by: rosbag record /map /tf_static /simulator/map /rumba/ground_truth /rumba/battery_status '
          '/rumba/battery_state ')


@pytest.fixture
def refusal(capsys):
    """A function that runs a command, which must be refused, and returns the line of the message."""
    def refused(*arguments):
        with pytest.raises(SystemExit) as end:
            mission_report.main([str(argument) for argument in arguments])
        printed = capsys.readouterr()
        assert end.value.code == 2 and printed.out == ''
        assert printed.err.startswith('mission_report: ') and printed.err.count('\n') == 1
        return printed.err[len('mission_report: '):-1]
    return refused


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """A bag with enough topics for a report."""
    return write(tmp_path_factory.mktemp('bag') / 'good.bag', LEAST)


@pytest.mark.parametrize('topics, lack', [
    ([], 'ground_truth or battery_status and battery_status or battery_state; the bag has /map'),
    (['ground_truth'], 'battery_status or battery_state; the bag has /map, /rumba/ground_truth'),
    (['bumper', 'battery_state'], 'ground_truth or battery_status; '
                                  'the bag has /map, /rumba/battery_state, /rumba/bumper')])
def test_missing_topics_are_named_with_those_in_the_bag_and_the_command_to_record_all(tmp_path, refusal, topics, lack):
    path = write(tmp_path / 'a.bag', topics, until=1.0)
    assert refusal(path).startswith(f'{path}: robot rumba lacks {lack}; {RECORD}')


def test_a_topic_of_another_type_is_ignored(tmp_path, refusal):
    path = tmp_path / 'a.bag'
    with rosbag.Bag(str(path), 'w') as bag:
        for topic in ('ground_truth', 'battery_state'):
            bag.write(f'/rumba/{topic}', String('here'), genpy.Time(1))
    assert 'lacks ground_truth or battery_status and battery_status or battery_state' in refusal(path)


def test_a_healthy_bag_with_another_definition_of_a_message_is_not_called_damaged(tmp_path, refusal):
    path = write(tmp_path / 'a.bag', ['ground_truth'])
    text = BatteryState._full_text.replace('float32 percentage', 'float32 state_of_charge', 1)
    other = genpy.dynamic.generate_dynamic(BatteryState._type, text)[BatteryState._type]
    with rosbag.Bag(str(path), 'a') as bag:
        bag.write('/rumba/battery_state', other(), genpy.Time(101))
    line = refusal(path)
    assert line.startswith(f'{path}: was recorded with another definition of sensor_msgs/BatteryState than the one '
                           'here (')
    assert line.endswith(': make the report where it was recorded') and 'reindex' not in line


def test_a_bag_without_messages_is_refused(tmp_path, refusal):
    rosbag.Bag(str(tmp_path / 'a.bag'), 'w').close()
    assert 'the bag has no messages; record a mission by: rosbag record' in refusal(tmp_path / 'a.bag')


def test_a_message_names_some_of_many_topics(tmp_path, refusal):
    with rosbag.Bag(str(tmp_path / 'a.bag'), 'w') as bag:
        for number in range(30):
            bag.write(f'/topic{number:02d}', String(), genpy.Time(1))
    assert '/topic19, ...; record' in refusal(tmp_path / 'a.bag')


@pytest.mark.parametrize('name', ['ground_truth', 'battery_state'])
def test_a_robot_without_any_finite_position_or_charge_is_refused(tmp_path, refusal, name):
    def spoil(topic, message, t):
        if topic == name == 'ground_truth':
            message.pose.pose.position.x = float('nan')
        elif topic == name:
            message.percentage = float('inf')
    path = write(tmp_path / 'a.bag', LEAST, until=1.0, change=spoil)
    what = 'position' if name == 'ground_truth' else 'charge'
    assert refusal(path) == f'{path}: robot rumba: no {what} is a finite number'


@pytest.mark.thorough(except_for=[f'0.0-{name}' for name in mission_bags.ALL])
@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('name', mission_bags.ALL)
@pytest.mark.parametrize('begin', [0.0, 5.0])
def test_odd_messages_of_anybody_make_a_page_or_one_line(tmp_path, capsys, name, begin):
    odd = itertools.cycle(odd_messages.all_of(mission_bags.TOPICS[name][1](3.0), seed=22))

    def spoil(topic, message, t):
        if topic == name and t >= begin:
            instead = next(odd)
            for field in message.__slots__:
                setattr(message, field, getattr(instead, field))
    path = write(tmp_path / 'a.bag', change=spoil)
    try:
        mission_report.main([path])
    except SystemExit as end:
        assert end.code == 2
    printed = capsys.readouterr()
    assert printed.err == '' or printed.err.startswith('mission_report: ') and printed.err.count('\n') == 1


def test_of_several_robots_one_must_be_chosen(tmp_path, refusal):
    path = write(tmp_path / 'a.bag', LEAST, '/a/rumba2', until=1.0)
    with rosbag.Bag(path, 'a') as bag:
        mission_bags.add(bag, LEAST, '/b/rumba2', until=1.0)
    choose = f'{path}: there are several robots: choose one by --robot NAME: a/rumba2, b/rumba2'
    assert refusal(path) == choose
    assert refusal(path, '--robot', 'rumba2') == choose
    assert refusal(path, '--robot', 'rumba') == f"{path}: there is no robot 'rumba': the robots are a/rumba2, b/rumba2"


def test_a_missing_file_and_a_folder_are_refused(tmp_path, refusal):
    assert refusal(tmp_path / 'no.bag') == f'{tmp_path}/no.bag: No such file or directory'
    assert refusal(tmp_path) == f'{tmp_path}: Is a directory'


@pytest.mark.parametrize('content', [b'', b'text', b'#ROSBAG V9.0\n' * 99, bytes(range(256)) * 40])
def test_another_file_is_refused(tmp_path, refusal, content):
    path = tmp_path / 'a.bag'
    path.write_bytes(content)
    assert refusal(path).startswith(f'{path}: is not a bag, or is damaged (')


def test_an_interrupted_recording_must_be_indexed(tmp_path, refusal):
    path = tmp_path / 'a.bag.active'
    bag = rosbag.Bag(str(path), 'w')
    mission_bags.add(bag, LEAST, until=1.0)
    bag.flush()
    assert refusal(path) == (
        f'{path}: has no index, because the recording was interrupted: repair it by rosbag reindex {path}')
    bag.close()


@pytest.mark.parametrize('share', [0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999])
def test_a_truncated_bag_is_refused(tmp_path, refusal, bag, share):
    path = tmp_path / 'a.bag'
    with open(bag, 'rb') as whole:
        path.write_bytes(whole.read()[:int(share * os.path.getsize(bag))])
    assert 'rosbag reindex' in refusal(path)


def test_a_bag_with_an_overwritten_chunk_is_refused(tmp_path, refusal, bag):
    path = tmp_path / 'a.bag'
    with open(bag, 'rb') as whole:
        data = bytearray(whole.read())
    data[6000:9000] = b'\xff' * 3000
    path.write_bytes(data)
    assert refusal(path).startswith(f'{path}: is not a bag, or is damaged (')


def test_an_output_that_cannot_be_written_is_refused(tmp_path, refusal, bag):
    assert refusal(bag, '--output', tmp_path) == f'{tmp_path}: Is a directory'
    assert refusal(bag, '--output', tmp_path / 'no' / 'a.html') == f'{tmp_path}/no/a.html: No such file or directory'


def test_a_page_does_not_overwrite_its_bag(refusal, bag):
    size = os.path.getsize(bag)
    assert refusal(bag, '--output', bag) == f'{bag}: is the bag itself: choose another --output'
    assert os.path.getsize(bag) == size


@pytest.mark.parametrize('arguments, message', [
    ([], 'the following arguments are required: FILE.bag; see --help'),
    (['a.bag', 'b.bag'], 'unrecognized arguments: b.bag; see --help'),
    (['a.bag', '--robot'], 'argument --robot: expected one argument; see --help')])
def test_a_wrong_command_line_is_refused(refusal, arguments, message):
    assert refusal(*arguments) == message
