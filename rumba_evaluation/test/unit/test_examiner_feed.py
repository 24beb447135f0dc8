"""In an examination, the judge takes what the simulator tells from its private channel, and nothing else."""

import time

import pytest
import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import Header

from rumba_evaluation.ros.judge.examiner_feed import ExaminerFeed
from rumba_evaluation.ros.judge.robot_feed import RobotFeed
from rumba_msg.msg import Bumper, CleaningStatus, Lockstep, LockstepAnswer
from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.participants import examiner
from rumba_sim.ros.participants.examiner import ExaminerClient, ExaminerServer, socket_path

CLEANING, BUMPER, TICK = '/rumba/cleaning_status', '/rumba/bumper', '/simulator/lockstep'
PATIENCE = 20.0  # [s]
STATE = ('/simulator', True, '/simulator')


class Heard:
    """What a feed has told, in the order in which it came."""

    def __init__(self):
        self.all = []
        self.voids = []
        self.is_over = False

    def end(self):
        """The simulator has ended."""
        self.is_over = True

    def wait(self, condition):
        """Wait until a condition holds."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, f'waited in vain; heard {self.all}'
            time.sleep(0.005)


@pytest.fixture
def server(tmp_path, monkeypatch):
    """A simulator in lockstep with three topics, which keeps the answers."""
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    monkeypatch.setattr(rospy, 'get_name', lambda: '/simulator')
    monkeypatch.setattr(RobotFeed, 'find', lambda self, path: ('by ROS', path))
    monkeypatch.setattr(RobotFeed, 'subscribe', lambda self, topic, kind, take: take(topic, 'by ROS'))
    found = ExaminerServer(socket_path())
    for topic, kind in ((CLEANING, CleaningStatus), (BUMPER, Bumper), (TICK, Lockstep)):
        found.declare(topic, kind)
    found.answers = []
    found.open(True, found.answers.append)
    yield found
    found.close()


@pytest.fixture
def heard():
    """What the feed tells."""
    return Heard()


@pytest.fixture
def feed(server, heard):
    """A feed that has begun, and listens to one topic."""
    found = ExaminerFeed(PATIENCE, None, heard.voids.append, heard.end)
    found.subscribe(CLEANING, CleaningStatus, lambda message, sender: heard.all.append((message.coverage, sender)))
    found.begin(lambda *state: heard.all.append(state), lambda tick: heard.all.append(tick.header.stamp.secs))
    yield found
    found.close()


def tell(server, second, coverage):
    """Tell of a tick."""
    stamp = rospy.Time(second)
    server.tell(CLEANING, CleaningStatus(Header(stamp=stamp), *[coverage] * 6), stamp)
    server.tell(BUMPER, Bumper(), stamp)
    server.tell(TICK, Lockstep(header=Header(stamp=stamp), run='run'), stamp)


def test_all_of_a_tick_comes_before_it_and_the_answer_goes_back(server, feed, heard):
    tell(server, 1, 0.25)
    feed.follow()
    tell(server, 2, 0.5)
    heard.wait(lambda: len(heard.all) == 5)
    assert heard.all == [STATE, (0.25, '/simulator'), 1, (0.5, '/simulator'), 2]
    feed.answer(rospy.Time(2))
    heard.wait(lambda: server.answers)
    assert server.answers == [LockstepAnswer(Header(stamp=rospy.Time(2)), 'run', '/simulator', LockstepAnswer.DONE, '')]


def test_time_is_that_of_the_messages_since_a_command_may_come_late(server, feed, heard):
    feed.follow()
    tell(server, 2, 0.5)
    server.tell_command('/rumba/cmd_vel', Twist(), rospy.Time(1), '/student')
    server.close()
    heard.wait(lambda: heard.is_over)
    assert feed.now() == 2.0 and not heard.voids


def test_a_field_is_taken_from_ros_only_if_the_simulator_does_not_tell_of_its_topic(feed):
    topic, kind, value = feed.find(f'{CLEANING}/header/stamp')
    assert (topic, kind, value(CleaningStatus(header=Header(stamp=rospy.Time(7))))) == (
        CLEANING, CleaningStatus, rospy.Time(7))
    assert feed.find(BUMPER)[2](3) == 3
    assert feed.find('/rumba/cmd_vel/linear/x') == ('by ROS', '/rumba/cmd_vel/linear/x')
    assert feed.find(f'{CLEANING}/missing') == ('by ROS', f'{CLEANING}/missing')
    taken = []
    feed.subscribe(BUMPER, Bumper, lambda *message: taken.append(message))
    assert taken == []
    feed.subscribe('/student/level', Bumper, lambda *message: taken.append(message))
    assert taken == [('/student/level', 'by ROS')]


def test_the_run_is_void_if_another_process_connects(feed, heard):
    feed.follow()
    with pytest.raises(WorldError, match=examiner.REFUSED):
        ExaminerClient().connect(socket_path(), PATIENCE)
    heard.wait(lambda: heard.voids)
    assert heard.voids == [examiner.REFUSED]
