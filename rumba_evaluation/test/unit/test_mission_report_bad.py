"""What is no good bag, or no good command, ends with exit code 2 and one line that says why."""

import os

import genpy
import mission_bags
import pytest
import rosbag
from mission_bags import write
from std_msgs.msg import String

from rumba_evaluation.ros.mission_report import mission_report

LIGHT = ('ground_truth', 'battery_state')
RECORD = 'record a mission by: rosbag record /map /rumba/ground_truth /rumba/battery_status /rumba/battery_state '


@pytest.fixture
def refusal(capsys):
    """The line with which a command is refused."""
    def refused(*arguments):
        with pytest.raises(SystemExit) as end:
            mission_report.main([str(argument) for argument in arguments])
        told = capsys.readouterr()
        assert end.value.code == 2 and told.out == ''
        assert told.err.startswith('mission_report: ') and told.err.count('\n') == 1
        return told.err[len('mission_report: '):-1]
    return refused


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """What is enough for a report."""
    return write(tmp_path_factory.mktemp('bag') / 'good.bag', LIGHT)


@pytest.mark.parametrize('topics, lack', [
    ([], 'no ground_truth or battery_status and no battery_status or battery_state; found: /map'),
    (['ground_truth'], 'no battery_status or battery_state; found: /map, /rumba/ground_truth'),
    (['bumper', 'battery_state'], 'no ground_truth or battery_status; '
                                  'found: /map, /rumba/battery_state, /rumba/bumper')])
def test_what_is_missing_is_named_with_what_is_there_and_what_to_record(tmp_path, refusal, topics, lack):
    path = write(tmp_path / 'a.bag', topics, until=1.0)
    assert refusal(path).startswith(f'{path}: of the robot rumba there is {lack}; {RECORD}')


def test_a_topic_of_another_type_is_none(tmp_path, refusal):
    path = tmp_path / 'a.bag'
    with rosbag.Bag(str(path), 'w') as bag:
        for topic in ('ground_truth', 'battery_state'):
            bag.write(f'/rumba/{topic}', String('here'), genpy.Time(1))
    assert 'no ground_truth or battery_status and no battery_status or battery_state' in refusal(path)


def test_a_bag_without_messages_says_so(tmp_path, refusal):
    rosbag.Bag(str(tmp_path / 'a.bag'), 'w').close()
    assert 'found: no messages; record a mission by: rosbag record' in refusal(tmp_path / 'a.bag')


def test_many_topics_are_not_all_told(tmp_path, refusal):
    with rosbag.Bag(str(tmp_path / 'a.bag'), 'w') as bag:
        for number in range(30):
            bag.write(f'/topic{number:02d}', String(), genpy.Time(1))
    assert '/topic19, ...; record' in refusal(tmp_path / 'a.bag')


@pytest.mark.parametrize('name', ['ground_truth', 'battery_state'])
def test_a_robot_of_which_nothing_is_finite_has_no_report(tmp_path, refusal, name):
    def spoil(topic, message, t):
        if topic == name == 'ground_truth':
            message.pose.pose.position.x = float('nan')
        elif topic == name:
            message.percentage = float('inf')
    path = write(tmp_path / 'a.bag', LIGHT, until=1.0, change=spoil)
    what = 'place' if name == 'ground_truth' else 'charge'
    assert refusal(path) == f'{path}: of the robot rumba no {what} is a finite number'


def test_of_several_robots_one_must_be_chosen(tmp_path, refusal):
    path = write(tmp_path / 'a.bag', LIGHT, '/a/rumba2', until=1.0)
    with rosbag.Bag(path, 'a') as bag:
        mission_bags.add(bag, LIGHT, '/b/rumba2', until=1.0)
    choose = f'{path}: several robots, choose one by --robot NAME: a/rumba2, b/rumba2'
    assert refusal(path) == choose
    assert refusal(path, '--robot', 'rumba2') == choose
    assert refusal(path, '--robot', 'rumba') == f"{path}: no robot 'rumba': there is a/rumba2, b/rumba2"


def test_a_missing_file_and_a_folder(tmp_path, refusal):
    assert refusal(tmp_path / 'no.bag') == f'{tmp_path}/no.bag: No such file or directory'
    assert refusal(tmp_path) == f'{tmp_path}: Is a directory'


@pytest.mark.parametrize('content', [b'', b'text', b'#ROSBAG V9.0\n' * 99, bytes(range(256)) * 40])
def test_what_is_no_bag(tmp_path, refusal, content):
    path = tmp_path / 'a.bag'
    path.write_bytes(content)
    assert refusal(path).startswith(f'{path}: no bag, or cut short, or damaged (')


def test_a_bag_that_was_cut_off_wants_an_index(tmp_path, refusal):
    path = tmp_path / 'a.bag.active'
    bag = rosbag.Bag(str(path), 'w')
    mission_bags.add(bag, LIGHT, until=1.0)
    bag.flush()
    assert refusal(path) == f'{path}: has no index, as a recording that was cut off: rosbag reindex {path}'
    bag.close()


@pytest.mark.parametrize('share', [0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999])
def test_a_truncated_bag(tmp_path, refusal, bag, share):
    path = tmp_path / 'a.bag'
    with open(bag, 'rb') as whole:
        path.write_bytes(whole.read()[:int(share * os.path.getsize(bag))])
    assert 'rosbag reindex' in refusal(path)


def test_a_chunk_that_was_overwritten(tmp_path, refusal, bag):
    path = tmp_path / 'a.bag'
    with open(bag, 'rb') as whole:
        data = bytearray(whole.read())
    data[6000:9000] = b'\xff' * 3000
    path.write_bytes(data)
    assert refusal(path).startswith(f'{path}: no bag, or cut short, or damaged (')


def test_a_page_that_cannot_be_written(tmp_path, refusal, bag):
    assert refusal(bag, '--output', tmp_path) == f'{tmp_path}: Is a directory'
    assert refusal(bag, '--output', tmp_path / 'no' / 'a.html') == f'{tmp_path}/no/a.html: No such file or directory'


def test_a_bag_is_not_overwritten_by_its_page(refusal, bag):
    size = os.path.getsize(bag)
    assert refusal(bag, '--output', bag) == f'{bag}: is the bag itself: give another --output'
    assert os.path.getsize(bag) == size


@pytest.mark.parametrize('arguments, message', [
    ([], 'the following arguments are required: FILE.bag; --help tells more'),
    (['a.bag', 'b.bag'], 'unrecognized arguments: b.bag; --help tells more'),
    (['a.bag', '--robot'], 'argument --robot: expected one argument; --help tells more')])
def test_a_wrong_command_line(refusal, arguments, message):
    assert refusal(*arguments) == message
