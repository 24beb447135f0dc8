"""Whose answer a world in lockstep waits for, by the wall clock of a test."""

import pytest
import rospy
from std_msgs.msg import Header

from rumba_msg.msg import LockstepAnswer
from rumba_sim.ros.simulator import participants
from rumba_sim.ros.simulator.participants import FIRST_COMMAND, SILENT, STARTING, Participants

PATIENCE = FIRST_COMMAND  # on purpose: they are different things
TOPIC = '/rumba/cmd_vel'


class Clock:
    """A wall clock that a test advances."""

    now = 1000.0

    def monotonic(self):
        """The time [s]."""
        return self.now


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """The clock of the participants."""
    made = Clock()
    monkeypatch.setattr(participants, 'time', made)
    return made


def answer(node, seconds, state=LockstepAnswer.DONE, command=''):
    return LockstepAnswer(Header(stamp=rospy.Time(seconds)), '', node, state, command)


def begun(members, *awaited):
    members.begin(rospy.Time(1))
    return members.missing() == set(awaited)


def test_nobody_is_waited_for_who_has_never_answered():
    assert begun(Participants([], PATIENCE))


def test_whoever_answers_is_waited_for_from_the_next_tick_on():
    members = Participants([], PATIENCE)
    members.begin(rospy.Time(1))
    members.take(answer('/a', 1))
    assert members.missing() == set()
    members.begin(rospy.Time(2))
    assert members.missing() == {'/a'}
    assert members.missing(but='/a') == set()
    members.take(answer('/a', 2))
    assert members.missing() == set()


def test_an_answer_to_an_older_tick_does_not_count():
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(2))
    members.take(answer('/a', 1))
    assert members.missing() == {'/a'}


@pytest.mark.parametrize('is_command_first', [False, True])
def test_an_answer_counts_once_the_command_that_it_announces_has_come(is_command_first):
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(1))
    steps = [lambda: members.take(answer('/a', 1, command=TOPIC)), lambda: members.commanded(TOPIC)]
    first, second = reversed(steps) if is_command_first else steps
    first()
    assert members.missing() == {'/a'}
    second()
    assert members.missing() == set()


def test_a_command_for_the_tick_before_does_not_count():
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(1))
    members.commanded(TOPIC)
    members.begin(rospy.Time(2))
    members.take(answer('/a', 2, command=TOPIC))
    assert members.missing() == {'/a'}


def test_a_topic_is_waited_for_by_its_commands():
    members = Participants([TOPIC], PATIENCE)
    assert begun(members, TOPIC)
    members.commanded('/rumba2/cmd_vel')
    assert members.missing() == {TOPIC}
    members.commanded(TOPIC)
    assert members.missing() == set()


def test_whoever_leaves_is_waited_for_no_longer():
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(1))
    members.take(answer('/a', 1, LockstepAnswer.LEAVES))
    assert members.missing() == set()
    assert begun(members)


def resting():
    """Members of whom one rests since the tick before."""
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(1))
    members.take(answer('/a', 1, LockstepAnswer.RESTS))
    members.begin(rospy.Time(2))
    return members


def test_whoever_rests_is_not_waited_for_and_never_given_up(clock):
    members = resting()
    clock.now += 1000.0 * PATIENCE
    assert members.missing() == set() and members.give_up(lambda _: True) == []
    members.take(answer('/a', 1, LockstepAnswer.RESTS))  # the world is ahead: it rests all the same
    assert begun(members)


@pytest.mark.parametrize('state', [LockstepAnswer.DONE, LockstepAnswer.BUSY])
def test_whoever_rested_and_answers_is_waited_for(state):
    members = resting()
    members.take(answer('/a', 1, state))
    assert begun(members, '/a')


def test_whoever_rested_and_is_woken_is_waited_for_until_it_answers_the_tick_after_that():
    members = resting()
    members.wake()
    assert begun(members, '/a')
    members.begin(rospy.Time(3))
    members.take(answer('/a', 2, LockstepAnswer.RESTS))  # of before it was woken
    assert members.missing() == {'/a'}
    members.take(answer('/a', 3, LockstepAnswer.RESTS))
    assert members.missing() == set() and begun(members)


def test_whoever_rests_is_waited_for_until_the_command_has_come_that_it_announced():
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(1))
    members.take(answer('/a', 1, LockstepAnswer.RESTS, TOPIC))
    assert members.missing() == {'/a'}
    members.commanded(TOPIC)
    assert members.missing() == set() and begun(members)


def silent(name):
    """Members of whom one was heard in the tick before, and is not heard now."""
    members = Participants([name], PATIENCE)
    members.begin(rospy.Time(1))
    members.commanded(name) if name == TOPIC else members.take(answer(name, 1))
    members.begin(rospy.Time(2))
    return members


@pytest.mark.parametrize('name', ['/a', TOPIC])
def test_whoever_is_silent_for_too_long_is_waited_for_again_after_its_next_sign(clock, name):
    members = silent(name)
    clock.now += PATIENCE
    assert members.give_up(lambda _: True) == []
    clock.now += 0.1
    assert members.give_up(lambda _: True) == [(name, PATIENCE)]
    assert members.missing() == set()
    assert begun(members)
    members.commanded(name) if name == TOPIC else members.take(answer(name, 1))
    assert begun(members, name)


def test_a_node_that_is_busy_is_waited_for(clock):
    members = silent('/a')
    for _ in range(10):
        clock.now += 0.9 * PATIENCE
        members.take(answer('/a', 0, LockstepAnswer.BUSY))
        assert members.give_up(lambda _: True) == []
    assert members.missing() == {'/a'}


def test_whoever_was_never_heard_has_time_to_start(clock):
    members = Participants(['/a', TOPIC], PATIENCE)
    members.begin(rospy.Time(1))
    clock.now += STARTING * PATIENCE
    assert members.give_up(lambda _: False) == []
    clock.now += 0.1
    assert members.give_up(lambda _: False) == [('/a', STARTING * PATIENCE), (TOPIC, STARTING * PATIENCE)]


def test_the_first_command_after_a_topic_has_a_publisher_may_be_lost(clock):
    members = Participants([TOPIC], PATIENCE)
    members.begin(rospy.Time(1))
    clock.now += 20.0
    members.give_up(lambda _: True)
    clock.now += FIRST_COMMAND
    assert members.missing() == {TOPIC}
    clock.now += 0.1
    assert members.give_up(lambda _: True) == []
    assert members.missing() == set()
    assert begun(members, TOPIC)
    clock.now += PATIENCE + 0.1
    assert members.give_up(lambda _: True) == [(TOPIC, PATIENCE)]


def test_a_sign_of_life_alone_makes_nobody_a_member():
    members = Participants([], PATIENCE)
    members.begin(rospy.Time(1))
    members.take(answer('/a', 0, LockstepAnswer.BUSY))
    assert begun(members)


def test_whoever_was_awaited_and_gives_signs_is_waited_for_however_long_it_takes_to_start(clock):
    members = Participants(['/a'], PATIENCE)
    members.begin(rospy.Time(1))
    for _ in range(10 * int(STARTING)):
        clock.now += 0.9 * PATIENCE
        members.take(answer('/a', 0, LockstepAnswer.BUSY))
        assert members.give_up(lambda _: True) == []
    assert members.missing() == {'/a'}


def test_only_a_node_that_was_heard_and_has_been_silent_for_a_while_may_have_ended(clock):
    members = Participants(['/a', '/b', TOPIC], 10.0 * SILENT)
    members.begin(rospy.Time(1))
    members.take(answer('/a', 1))
    members.commanded(TOPIC)
    members.begin(rospy.Time(2))
    clock.now += SILENT
    assert members.silent() == []
    clock.now += 0.1
    assert members.silent() == ['/a']
    members.forget('/a')
    assert members.silent() == [] and members.missing() == {'/b', TOPIC} and not members.has('/a')
