"""The servers of the cleaner's actions, without a master: goals of a time that is over, and those still open."""

import contextlib
import time
import types

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus

from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner.goals import action_server
from rumba_cleaning.ros.cleaner.goals.action_server import LONGEST_ID, MOST, Outlet
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_msg.msg import GoToAction, GoToActionGoal, GoToResult


def result(outcome, text):
    """The result of a goal."""
    return GoToResult(outcome=conversions.outcome(outcome, text))


class Topics:
    """Topics and time without ROS.

    Attributes:
        now: [s].
        accepted: handles of the goals that were passed on.
        results: status and text of each result, by the id of the goal.
        statuses: ids of the goals in each status.
    """

    def __init__(self, monkeypatch):
        self.now = 100.0
        self.accepted, self.statuses = [], []
        self.results = {}
        monkeypatch.setattr(action_server, 'Outlet', self._publisher)
        for name, stand_in in (
                ('Subscriber', lambda *_, **__: None), ('is_shutdown', lambda: False), ('Time', rospy.Time)):
            monkeypatch.setattr(action_server.rospy, name, stand_in)
        monkeypatch.setattr(rospy.Time, 'now', lambda: rospy.Time.from_sec(self.now))
        self.server = action_server.Server('rumba/go_to', GoToAction, self.accepted.append, lambda _: None, result)

    def _publisher(self, name, *_, **__):
        return types.SimpleNamespace(publish=getattr(self, f'_on_{name.rpartition("/")[2]}'))

    def _on_result(self, message):
        status = message.status
        assert message.result.outcome.message == status.text
        self.results[status.goal_id.id] = status.status, status.text

    def _on_status(self, message):
        self.statuses.append([status.goal_id.id for status in message.status_list])

    def _on_feedback(self, _):
        """Nobody listens."""

    def goal(self, name, stamp=None):
        """Send a goal; returns its handle, or None if it was not passed on."""
        self.accepted.clear()
        stamp = rospy.Time.from_sec(self.now if stamp is None else stamp)
        self.server.internal_goal_callback(GoToActionGoal(goal_id=GoalID(stamp, name)))
        return self.accepted[0] if self.accepted else None

    def cancel(self, stamp, name=''):
        """Cancel all goals up to a stamp [s], and the one of an id."""
        self.server.internal_cancel_callback(GoalID(rospy.Time.from_sec(stamp), name))


@pytest.fixture
def topics(monkeypatch):
    """The topics of a server that is started."""
    topics = Topics(monkeypatch)
    yield topics
    topics.server.close('')


def test_a_cancel_counts_for_goals_that_are_older(topics):
    topics.cancel(100.0)
    assert topics.goal('late', 99.0) is None
    assert topics.results['late'][0] == GoalStatus.RECALLED
    topics.now = 101.0
    assert topics.goal('new') is not None


@pytest.mark.parametrize('stamp', [100.0, 4e9])
def test_a_cancel_that_is_later_than_now_is_of_a_time_that_is_over(topics, stamp):
    topics.cancel(stamp)
    topics.now = 2.0
    assert topics.goal('first') is not None
    assert topics.goal('second') is not None


@pytest.mark.parametrize('stamp, told', [(99.0, 99.0), (1.8e9, 100.0), (0.0, 100.0)])
def test_the_status_tells_when_a_goal_came_also_if_its_client_has_another_clock(topics, stamp, told):
    topics.goal('mine', stamp)
    assert topics.server.status_list[-1].status.goal_id.stamp.to_sec() == told


def test_a_goal_with_the_id_of_one_of_a_time_that_is_over_is_a_new_one(topics):
    handle = topics.goal('mine')
    handle.set_accepted()
    assert topics.goal('mine') is None
    handle.set_succeeded()
    assert topics.goal('mine') is None
    topics.now = 2.0
    assert topics.goal('mine') is not None


def test_the_status_goes_on_after_time_went_back(topics):
    topics.goal('mine').set_accepted()
    topics.now = 2.0
    before = len(topics.statuses)
    end = time.monotonic() + 30.0
    while len(topics.statuses) < before + 2 and time.monotonic() < end:
        time.sleep(0.01)
    assert topics.statuses[before:before + 2] == [['mine'], ['mine']]


def test_at_the_end_all_open_goals_are_answered_and_no_more_are_taken(topics):
    topics.goal('done').set_accepted()
    topics.accepted[0].set_succeeded(result(Outcome.SUCCEEDED, 'there'), 'there')
    topics.goal('active').set_accepted()
    topics.goal('pending')
    cancelled = topics.goal('cancelled')
    cancelled.set_cancel_requested()
    topics.cancel(0.0, 'unknown')
    topics.server.close('the end')
    assert topics.results == {'done': (GoalStatus.SUCCEEDED, 'there'), 'active': (GoalStatus.ABORTED, 'the end'),
                              'pending': (GoalStatus.ABORTED, 'the end'), 'cancelled': (GoalStatus.ABORTED, 'the end')}
    assert topics.goal('late') is None


# --- floods -----------------------------------------------------------------------------------------------------------

def test_a_cancel_that_overtakes_its_goal_counts_for_a_while(topics):
    topics.cancel(0.0, 'early')
    assert topics.goal('early') is None
    assert topics.results['early'] == (GoalStatus.RECALLED, 'cancelled')
    topics.now += action_server.REMEMBERED + 1.0
    assert topics.goal('early') is not None


def test_cancels_of_unknown_goals_print_nothing_and_are_forgotten(topics, caplog):
    for number in range(4000):
        topics.cancel(0.0, f'unknown{number}')
    topics.cancel(0.0, 'x' * 100_000)
    assert not caplog.records
    assert topics.goal('unknown0') is not None and topics.goal('x' * LONGEST_ID) is not None
    assert topics.goal('unknown3999') is None


def test_of_many_goals_at_once_each_is_answered_and_the_status_stays_short(topics):
    for number in range(4000):
        topics.goal(f'waits{number}')
    refused = {name: text for name, (status, text) in topics.results.items() if status == GoalStatus.REJECTED}
    assert list(refused) == [f'waits{number}' for number in range(MOST, 4000)]
    assert set(refused.values()) == {f'{MOST} goals wait already: send it again later'}
    topics.server.close('the end')
    assert len(topics.results) == 4000
    assert max(map(len, topics.statuses)) <= MOST


def test_of_many_goals_one_after_another_only_the_newest_are_in_the_status(topics):
    for number in range(1000):
        topics.goal(f'mine{number}').set_accepted()
        topics.accepted[0].set_aborted(result(Outcome.NO_PATH, ''))
    assert max(map(len, topics.statuses)) <= MOST + 1
    assert topics.statuses[-1][-1] == 'mine999'
    assert len(topics.results) == 1000


def test_a_goal_that_is_sent_again_among_many_keeps_its_state(topics):
    handle = topics.goal('mine')
    for number in range(MOST):
        topics.goal(f'other{number}')
    assert topics.goal('mine') is None and 'mine' not in topics.results
    handle.set_accepted()
    handle.set_succeeded(result(Outcome.SUCCEEDED, 'there'), 'there')
    assert topics.results['mine'] == (GoalStatus.SUCCEEDED, 'there')


def test_an_id_that_every_status_would_carry_is_refused_if_it_is_long(topics):
    name = 'x' * (LONGEST_ID + 1)
    assert topics.goal(name) is None
    assert topics.results[name] == (GoalStatus.REJECTED, f'the id has {LONGEST_ID + 1} characters: must be at most 300')


@pytest.mark.parametrize('is_over', [False, True])
def test_a_topic_that_the_end_of_the_node_has_closed_is_no_error(monkeypatch, is_over):
    monkeypatch.setattr(action_server.rospy, 'is_shutdown', lambda: is_over)
    outlet = object.__new__(Outlet)
    outlet.impl = None  # as Publisher.unregister leaves it
    with contextlib.nullcontext() if is_over else pytest.raises(rospy.ROSException, match='unregistered'):
        outlet.publish(GoalStatus())
