"""The recording of an examination shows who commanded, and whether the robot was moved or the simulator tuned."""

import pytest
import rosbag
import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from rumba_evaluation.ros import exam_recording
from rumba_evaluation.ros.exam_recording import COMMANDS, TRUTH, TUNING, findings


@pytest.fixture
def recorded(tmp_path):
    """A function that records messages, given as topic, node, time [s] and message; returns the path of the bag."""
    def record(*messages):
        path = str(tmp_path / 'exam.bag')
        with rosbag.Bag(path, 'w') as bag:
            for topic, node, seconds, message in messages:
                header = {'topic': topic, 'type': message._type, 'md5sum': message._md5sum, 'callerid': node,
                          'message_definition': message._full_text}
                bag._topic_connections.pop(topic, None)  # each publisher has a connection, as in recordings
                bag.write(topic, message, rospy.Time.from_sec(seconds), connection_header=header)
        return path
    return record


def at(x, seconds):
    """A message of the truth."""
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(seconds)
    message.pose.pose.position.x = x
    return TRUTH, '/simulator', seconds, message


def drain(value, seconds):
    """A message of the tuning."""
    return TUNING, '/simulator', seconds, Config(doubles=[DoubleParameter('battery_drain', value)])


HONEST = [at(1.0, 0.1), (COMMANDS[0], '/student', 0.1, Twist()), at(1.03, 0.2), at(1.5, 2.0), drain(1.0, 0.1)]


@pytest.mark.parametrize('more, found', [
    ([], []),
    ([(COMMANDS[0], '/helper', 1.0, Twist())], ['/rumba/cmd_vel was published by /helper and /student']),
    ([(COMMANDS[1], '/student', 1.0, Twist())], ['/rumba/teleop/cmd_vel was published by /student']),
    ([at(3.0, 2.1)], ['the robot was moved by a call, from (1.50, 0.00) m to (3.00, 0.00) m after 2.1 s']),
    ([drain(1.0, 2.0)], []),
    ([drain(0.0, 3.0)], ['the setting battery_drain was changed to 0.0 after 3.0 s'])])
def test_what_was_not_allowed_is_told(recorded, more, found):
    assert findings(recorded(*HONEST, *more)) == found


def test_a_recording_that_begins_late_or_is_missing_is_told(recorded, tmp_path):
    assert findings(recorded(at(1.0, 7.0))) == ['the recording begins only after 7.0 s']
    assert findings(recorded(HONEST[1])) == ['the recording does not show where the robot was']
    [finding] = findings(str(tmp_path / 'nothing.bag'))
    assert finding.startswith('the recording cannot be read: ')


def test_everything_that_is_looked_at_is_recorded():
    for topic in (TRUTH, *COMMANDS, TUNING):
        assert f' {topic}' in exam_recording.RECORDER
