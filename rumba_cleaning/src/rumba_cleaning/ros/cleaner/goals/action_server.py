"""The server of an action, by actionlib, which answers every goal."""

import collections
import threading
import warnings
from typing import Any, Callable, Deque, List, Tuple

import rospy
from actionlib import ActionServer, ServerGoalHandle
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from std_msgs.msg import Header

from rumba_cleaning.outcome import Outcome

QUEUE = 50  # messages for a client that may be behind
STATUS_PERIOD = 0.2  # [s] of the wall clock
REMEMBERED = 5.0  # [s] after its end, for which a goal is in the status; after a cancel, for which its goal may come
MOST = 50  # goals without a result, goals that have ended, and cancels: each status carries all goals
FAR = 3600.0  # [s] from now, beyond which the stamp of a goal is of another clock: it gets the time at which it came
LONGEST_ID = 300  # [characters]
WAITING, STARTED = (GoalStatus.PENDING, GoalStatus.RECALLING), (GoalStatus.ACTIVE, GoalStatus.PREEMPTING)


class Outlet(rospy.Publisher):
    """A publisher that drops what other threads publish while the node ends, which closes its topics."""

    def publish(self, *args: Any, **fields: Any) -> None:
        """Publish a message, as the base class does; raise ROSException if the topic is closed in a node that runs."""
        try:
            super().publish(*args, **fields)
        except rospy.ROSException:
            if not rospy.is_shutdown():
                raise


class Server(ActionServer):
    """An action server that outlives a simulator and floods, and leaves no goal open at the end of its node.

    The time of a simulator that is started again begins anew. In its base class, a cancel from the time before then
    cancels every new goal, a new goal may be taken for an old one of the same id, and the status is published no more.
    (A SimpleActionServer even refuses goals with an older stamp than the last one had, and knows nothing of other
    actions.) The base class also remembers any number of goals, and of cancels of goals that never came, and sends all
    of them with each change.
    """

    last_cancel: rospy.Time  # of the base class, as the next one: the newest stamp of a cancel
    status_list: List[Any]  # a tracker for each goal

    def __init__(self, name: str, action: Any, on_goal: Callable[[ServerGoalHandle], None],
                 on_cancel: Callable[[ServerGoalHandle], None], result: Callable[[Outcome, str], Any]) -> None:
        """Serve an action.

        Args:
            name: of the action, a prefix of its topics.
            action: its class.
            on_goal: called with each goal that is not refused, in a thread of rospy.
            on_cancel: called with each of these that is cancelled, in a thread of rospy.
            result: the result of a goal, from its outcome and a text; called in any thread.
        """
        super().__init__(name, action, on_goal, on_cancel, auto_start=False)
        self._result = result
        self._cancels: Deque[Tuple[str, rospy.Time]] = collections.deque(maxlen=MOST)  # of goals that did not come yet
        self._closed = threading.Event()
        self.start()

    def initialize(self) -> None:
        """Open the topics, and publish the status from now on."""
        self.status_pub = Outlet(f'{self.ns}/status', GoalStatusArray, queue_size=QUEUE, latch=True)
        self.feedback_pub = Outlet(f'{self.ns}/feedback', self.ActionFeedback, queue_size=QUEUE)
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # Without a queue, a result is on its way when `publish` returns.
            self.result_pub = Outlet(f'{self.ns}/result', self.ActionResult, queue_size=None)
        self.goal_sub = rospy.Subscriber(f'{self.ns}/goal', self.ActionGoal, self.internal_goal_callback)
        self.cancel_sub = rospy.Subscriber(f'{self.ns}/cancel', GoalID, self.internal_cancel_callback)
        self.status_list_timeout = rospy.Duration(REMEMBERED)
        threading.Thread(target=self._publish_regularly, daemon=True).start()

    def _publish_regularly(self) -> None:
        while not self._closed.wait(STATUS_PERIOD):
            self.publish_status_async(None)

    def internal_goal_callback(self, goal: Any) -> None:
        """Take a goal, unless it was sent before, or was cancelled, or is refused."""
        with self.lock:
            if not self.started:
                return
            now = rospy.Time.now()
            self._forget(now)
            name = goal.goal_id.id
            if any(tracker.status.goal_id.id == name for tracker in self.status_list):
                return
            if self._is_cancelled(goal.goal_id, now):
                self._answer(goal.goal_id, GoalStatus.RECALLED, Outcome.CANCELLED, 'cancelled')
            elif len(name) > LONGEST_ID:
                self._answer(goal.goal_id, GoalStatus.REJECTED, Outcome.REFUSED,
                             f'the id has {len(name)} characters: must be at most {LONGEST_ID}')
            elif len(self._open()) >= MOST:
                self._answer(goal.goal_id, GoalStatus.REJECTED, Outcome.REFUSED,
                             f'{MOST} goals wait already: send it again later')
            else:
                if abs((goal.goal_id.stamp - now).to_sec()) > FAR:
                    goal.goal_id.stamp = now
                super().internal_goal_callback(goal)

    def _forget(self, now: rospy.Time) -> None:
        """Forget the oldest of many goals that have ended, and what was cancelled or has ended later than now.

        That belongs to a time that is over.
        """
        if self.last_cancel > now:
            self.last_cancel = rospy.Time()
        self.status_list = [each for each in self.status_list if each.handle_destruction_time <= now]
        opened = self._open()
        for each in [each for each in self.status_list if each not in opened][:-MOST]:
            self.status_list.remove(each)

    def _open(self) -> List[Any]:
        """The trackers of goals without a result."""
        return [each for each in self.status_list if each.status.status in WAITING + STARTED]

    def _is_cancelled(self, goal_id: GoalID, now: rospy.Time) -> bool:
        """Whether a cancel came before the goal."""
        return (not goal_id.stamp.is_zero() and goal_id.stamp <= self.last_cancel
                or any(name == goal_id.id and 0.0 <= (now - when).to_sec() <= REMEMBERED
                       for name, when in self._cancels))

    def _answer(self, goal_id: GoalID, status: int, outcome: Outcome, text: str) -> None:
        """Publish the result of a goal that is never begun."""
        if not rospy.is_shutdown():
            self.result_pub.publish(self.ActionResult(Header(stamp=rospy.Time.now()), GoalStatus(goal_id, status, text),
                                                      self._result(outcome, text)))

    def internal_cancel_callback(self, goal_id: GoalID) -> None:
        """Cancel goals, also one that comes later."""
        with self.lock:
            super().internal_cancel_callback(goal_id)
            if self.status_list and self.status_list[-1].goal is None:  # the base class does not know this goal
                self.status_list.pop()
                if len(goal_id.id) <= LONGEST_ID:
                    self._cancels.append((goal_id.id, rospy.Time.now()))

    def close(self, text: str) -> None:
        """Abort the goals that have no result yet, and take no more; may be called from any thread."""
        with self.lock:
            self.started = False
            self._closed.set()
            for tracker in self._open():
                handle = ServerGoalHandle(tracker, self, tracker.handle_tracker)
                if tracker.status.status in WAITING:
                    handle.set_accepted()
                handle.set_aborted(self._result(Outcome.FAILED, text), text)
