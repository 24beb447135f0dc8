"""When a node that takes part in a lockstep says that it is alive, without a master."""

import threading
import time
import types

import pytest
import rospy
from std_msgs.msg import Header

from rumba_msg.msg import Lockstep, LockstepAnswer
from rumba_sim.ros.participants import lockstep
from rumba_sim.ros.participants.lockstep import LONGEST, Participant, Work

PATIENCE = 30.0  # [s]
WHILE = 0.1  # [s] many signs
RUN = 'run'


class Answers:
    """What a participant publishes."""

    def __init__(self, monkeypatch):
        self.states = []
        self._changed = threading.Condition()
        publisher = types.SimpleNamespace(publish=self._take)
        monkeypatch.setattr(lockstep.rospy, 'Publisher', lambda *_, **__: publisher)
        monkeypatch.setattr(lockstep.rospy, 'Subscriber', lambda *_, **__: None)
        monkeypatch.setattr(lockstep, 'SIGN_PERIOD', 0.005)

    def _take(self, answer):
        with self._changed:
            self.states.append(answer.state)
            self._changed.notify_all()

    def await_signs(self):
        """Wait for three signs of life from now on."""
        with self._changed:
            self.states.clear()
            assert self._changed.wait_for(lambda: self.states.count(LockstepAnswer.BUSY) >= 3, PATIENCE)

    def are_silent(self):
        """Whether no sign of life comes for a while."""
        with self._changed:
            self.states.clear()
        time.sleep(WHILE)
        return LockstepAnswer.BUSY not in self.states


@pytest.fixture
def answers(monkeypatch):
    """Those of the participant that a test makes."""
    return Answers(monkeypatch)


def tick(seconds):
    return Lockstep(header=Header(stamp=rospy.Time(seconds)), run=RUN)


def test_a_participant_is_alive_while_it_works_at_a_tick(answers):
    done = threading.Event()
    participant = Participant(lambda _: done.wait(PATIENCE))
    assert answers.are_silent()
    thread = threading.Thread(target=participant._take, args=[tick(1)])
    thread.start()
    answers.await_signs()
    done.set()
    thread.join()
    assert answers.are_silent()


def test_a_participant_is_alive_while_something_else_takes_long_but_not_while_it_rests(answers):
    participant = Participant(lambda _: None, lambda: True)
    answers.await_signs()
    participant.answer(rospy.Time(1), rests=True)
    assert answers.are_silent()
    participant.wake()
    answers.await_signs()


def test_a_node_works_from_its_start_until_it_rests_and_while_it_does_something(monkeypatch):
    work = Work()
    assert work.goes_on
    work.rest()
    assert not work.goes_on
    with work:
        assert work.goes_on
        begin = time.monotonic()
        monkeypatch.setattr(lockstep.time, 'monotonic', lambda: begin + LONGEST + 1.0)
        assert not work.goes_on  # it has hung
    assert not work.goes_on
