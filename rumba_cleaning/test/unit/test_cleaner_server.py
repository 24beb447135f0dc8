"""The servers of the cleaner's actions, without a master: goals of a time that is over, and those still open."""

import types

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus

from rumba_cleaning.ros.cleaner import action_server
from rumba_msg.msg import GoToAction, GoToActionGoal, GoToResult


class Topics:
    """Topics and time without ROS.

    Attributes:
        now: [s].
        accepted: handles of the goals that were passed on.
        results: status and text of each result, by the id of the goal.
        timers: periods and arguments of the timers.
    """

    def __init__(self, monkeypatch):
        self.now = 100.0
        self.accepted, self.timers = [], []
        self.results = {}
        for name, stand_in in (
                ('Publisher', self._publisher), ('Subscriber', lambda *_, **__: None), ('is_shutdown', lambda: False),
                ('Timer', self._timer), ('Time', rospy.Time)):
            monkeypatch.setattr(action_server.rospy, name, stand_in)
        monkeypatch.setattr(rospy.Time, 'now', lambda: rospy.Time.from_sec(self.now))
        self.server = action_server.Server('rumba/go_to', GoToAction, self.accepted.append, auto_start=False)
        self.server.start()

    def _publisher(self, name, *_, **__):
        return types.SimpleNamespace(publish=self._keep if name.endswith('/result') else lambda _: None)

    def _keep(self, message):
        status = message.status
        self.results[status.goal_id.id] = status.status, status.text

    def _timer(self, *_, **arguments):
        self.timers.append(arguments)
        return types.SimpleNamespace(shutdown=lambda: None)

    def goal(self, name, stamp=None):
        """Send a goal; returns its handle, or None if it was not passed on."""
        self.accepted.clear()
        stamp = rospy.Time.from_sec(self.now if stamp is None else stamp)
        self.server.internal_goal_callback(GoToActionGoal(goal_id=GoalID(stamp, name)))
        return self.accepted[0] if self.accepted else None

    def cancel(self, stamp):
        """Cancel all goals up to a stamp [s]."""
        self.server.internal_cancel_callback(GoalID(rospy.Time.from_sec(stamp), ''))


@pytest.fixture
def topics(monkeypatch):
    """The topics of a server that is started."""
    return Topics(monkeypatch)


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


def test_a_goal_with_the_id_of_one_of_a_time_that_is_over_is_a_new_one(topics):
    handle = topics.goal('mine')
    handle.set_accepted()
    assert topics.goal('mine') is None
    handle.set_succeeded()
    assert topics.goal('mine') is None
    topics.now = 2.0
    assert topics.goal('mine') is not None


def test_the_status_goes_on_after_time_went_back(topics):
    assert [timer['reset'] for timer in topics.timers] == [True]


def test_at_the_end_all_open_goals_are_answered_and_no_more_are_taken(topics):
    topics.goal('done').set_accepted()
    topics.accepted[0].set_succeeded(text='there')
    topics.goal('active').set_accepted()
    topics.goal('pending')
    cancelled = topics.goal('cancelled')
    cancelled.set_cancel_requested()
    topics.server.internal_cancel_callback(GoalID(rospy.Time(), 'unknown'))
    topics.server.close(GoToResult(), 'the end')
    assert topics.results == {'done': (GoalStatus.SUCCEEDED, 'there'), 'active': (GoalStatus.ABORTED, 'the end'),
                              'pending': (GoalStatus.ABORTED, 'the end'), 'cancelled': (GoalStatus.ABORTED, 'the end')}
    assert topics.goal('late') is None
