"""The server of an action, by actionlib, which answers every goal."""

import warnings
from typing import Any, List

import rospy
from actionlib import ActionServer, ServerGoalHandle
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

QUEUE = 50  # messages for a client that may be behind
STATUS_PERIOD = 0.2  # [s]
REMEMBERED = 5.0  # [s] after its end, for which a goal is in the status
WAITING, STARTED = (GoalStatus.PENDING, GoalStatus.RECALLING), (GoalStatus.ACTIVE, GoalStatus.PREEMPTING)


class Server(ActionServer):
    """An action server that outlives a simulator, and leaves no goal open at the end of its node.

    The time of a simulator that is started again begins anew. In its base class, a cancel from the time before then
    cancels every new goal, a new goal may be taken for an old one of the same id, and the status is published no more.
    (A SimpleActionServer even refuses goals with an older stamp than the last one had, and knows nothing of other
    actions.)
    """

    last_cancel: rospy.Time  # of the base class, as the next one: the newest stamp of a cancel
    status_list: List[Any]  # a tracker for each goal, and for each cancel of an unknown one

    def initialize(self) -> None:
        """Open the topics, and publish the status from now on."""
        self.status_pub = rospy.Publisher(f'{self.ns}/status', GoalStatusArray, queue_size=QUEUE, latch=True)
        self.feedback_pub = rospy.Publisher(f'{self.ns}/feedback', self.ActionFeedback, queue_size=QUEUE)
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # Without a queue, a result is on its way when `publish` returns.
            self.result_pub = rospy.Publisher(f'{self.ns}/result', self.ActionResult, queue_size=None)
        self.goal_sub = rospy.Subscriber(f'{self.ns}/goal', self.ActionGoal, self.internal_goal_callback)
        self.cancel_sub = rospy.Subscriber(f'{self.ns}/cancel', GoalID, self.internal_cancel_callback)
        self.status_list_timeout = rospy.Duration(REMEMBERED)
        self.status_timer = rospy.Timer(rospy.Duration(STATUS_PERIOD), self.publish_status_async, reset=True)

    def internal_goal_callback(self, goal: Any) -> None:
        """Take a goal; what was cancelled or has ended later than now belongs to a time that is over."""
        with self.lock:
            now = rospy.Time.now()
            if self.last_cancel > now:
                self.last_cancel = rospy.Time()
            self.status_list = [each for each in self.status_list if each.handle_destruction_time <= now]
            super().internal_goal_callback(goal)

    def close(self, result: Any, text: str) -> None:
        """Abort the goals that have no result yet, and take no more; may be called from any thread."""
        with self.lock:
            self.started = False
            for tracker in self.status_list:
                handle = ServerGoalHandle(tracker, self, tracker.handle_tracker)
                if tracker.goal is not None and tracker.status.status in WAITING:
                    handle.set_accepted()
                if tracker.goal is not None and tracker.status.status in STARTED:
                    handle.set_aborted(result, text)
            self.status_timer.shutdown()
