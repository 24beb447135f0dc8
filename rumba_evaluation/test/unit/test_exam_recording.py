"""The recording of an examination shows who commanded, and whether the robot was moved."""

import pytest
import rosbag
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from rumba_evaluation.ros.exam_recording import COMMANDS, TRUTH, findings
from rumba_evaluation.ros.judge.recording import Recording
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.ros.participants.examiner_frames import COMMAND, MESSAGE, Frame, serialised


@pytest.fixture
def recorded(tmp_path):
    """A function that records messages, given as topic, node, time [s] and message; returns the path of the bag."""
    def record(*messages):
        path = str(tmp_path / 'exam.bag')
        recording = Recording(path, 'rumba')
        for topic, node, seconds, message in messages:
            recording.take(frame(topic, node, seconds, message))
        recording.close()
        return path
    return record


def frame(topic, node, seconds, message):
    """What the simulator tells of a message."""
    stamp = rospy.Time.from_sec(seconds)
    return Frame(COMMAND if topic in COMMANDS else MESSAGE, serialised(message), topic, message._type, node, stamp.secs,
                 stamp.nsecs)


def at(x, seconds):
    """A message of the truth."""
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(seconds)
    message.pose.pose.position.x = x
    return TRUTH, '/simulator', seconds, message


HONEST = [at(1.0, 0.1), (COMMANDS[0], '/student', 0.1, Twist()), at(1.03, 0.2), at(1.5, 2.0)]


@pytest.mark.parametrize('more, found', [
    ([], []),
    ([(COMMANDS[0], '/helper', 1.0, Twist())], ['/rumba/cmd_vel was published by /helper and /student']),
    ([(COMMANDS[1], '/student', 1.0, Twist())], ['/rumba/teleop/cmd_vel was published by /student']),
    ([at(3.0, 2.1)], ['the robot was moved by a call, from (1.50, 0.00) m to (3.00, 0.00) m after 2.1 s']),
    ([(COMMANDS[0], '/student', 2.0, Twist())], [])])
def test_what_was_not_allowed_is_told(recorded, more, found):
    assert findings(recorded(*HONEST, *more)) == found


def test_a_recording_without_a_place_or_that_is_missing_is_told(recorded, tmp_path):
    assert findings(recorded(HONEST[1])) == ['the recording does not show where the robot was']
    [finding] = findings(str(tmp_path / 'nothing.bag'))
    assert finding.startswith('the recording cannot be read: ')


def test_each_message_is_recorded_with_its_sender_and_its_time_and_no_other_topic(recorded):
    helper = (COMMANDS[0], '/helper', 0.3, Twist())
    odometry = ('/rumba/odom', '/simulator', 0.3, Odometry())
    with rosbag.Bag(recorded(*HONEST, helper, odometry, HONEST[1])) as bag:
        found = [(topic, header['callerid'].decode(), stamp.to_sec(), message) for topic, message, stamp, header
                 in bag.read_messages(return_connection_header=True)]
    assert sorted(map(str, found)) == sorted(map(str, [*HONEST, helper, HONEST[1]]))  # rosbag makes types of its own


def test_a_recording_that_is_finished_takes_no_more(tmp_path):
    recording = Recording(str(tmp_path / 'exam.bag'), 'rumba')
    recording.close()
    recording.take(frame(*HONEST[0]))
    recording.close()
    with pytest.raises(ConfigError, match='recording: .*: No such file or directory'):
        Recording(str(tmp_path / 'none' / 'exam.bag'), 'rumba')
