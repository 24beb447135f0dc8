"""What the tests of the cleaner share: a cleaner as a user starts it, its actions, and what it says of them."""

import signal
import subprocess
import time
import unittest

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D, Twist
from simulators import TIMEOUT, Heard, lookup, wait

from rumba_msg.msg import CleanAction, DockAction, GoToAction, GoToGoal, MissionStatus, UndockAction

ENDS_WITHIN = 5.0  # [s]: it has thirty topics to take back
ACTIONS = {'clean': CleanAction, 'dock': DockAction, 'undock': UndockAction, 'go_to': GoToAction}
ENDS = {GoalStatus.PREEMPTED: 'preempted', GoalStatus.SUCCEEDED: 'succeeded', GoalStatus.ABORTED: 'aborted',
        GoalStatus.REJECTED: 'rejected', GoalStatus.RECALLED: 'recalled', GoalStatus.LOST: 'lost'}


def go_to(x, y, theta=float('nan'), time_limit=0.0):
    """A goal of go_to."""
    return GoToGoal(Pose2D(x, y, theta), time_limit)


def shared(test_class):
    """A test whose cleanups are those of a whole class of tests."""
    test = unittest.TestCase()
    test.addCleanup = test_class.addClassCleanup
    return test


class Cleaner:
    """A cleaner for one test, and, once it is connected, the clients of its actions."""

    def __init__(self, test, *arguments, name='/cleaner', robot='/rumba'):
        self._test = test
        self._robot = robot
        if rospy.has_param(name):
            rospy.delete_param(name)
        # As in a launch file: simulator and cleaner start at the same time, in simulated time both.
        rospy.set_param('/use_sim_time', True)
        self.process = subprocess.Popen(['rosrun', 'rumba_cleaning', 'cleaner', *arguments])
        test.addCleanup(self.end)

    def connect(self):
        """Wait until it is there; returns itself."""
        test = self._test
        wait(test, lambda: self.process.poll() is not None or lookup(f'{self._robot}/go_to_position'), 'the cleaner')
        test.assertIsNone(self.process.poll(), 'the cleaner ended')
        self.clients = {}
        for action, kind in ACTIONS.items():
            self.clients[action] = actionlib.ActionClient(f'{self._robot}/{action}', kind)
            test.addCleanup(self.clients[action].stop)
            test.assertTrue(self.clients[action].wait_for_server(rospy.Duration(TIMEOUT)), action)
        self.status = Heard(test, f'{self._robot}/mission_status', MissionStatus)
        self.commands = Heard(test, f'{self._robot}/cmd_vel', Twist)
        return self

    def send(self, action, goal):
        """Send a goal; returns it as it goes on."""
        return Goal(self._test, self.clients[action].send_goal, goal)

    def refuses(self, pattern, action, goal):
        """Send a goal that must be aborted for a reason, without any command to the wheels."""
        self.commands.messages.clear()
        answer = self.send(action, goal).ends('aborted')
        self._test.assertRegex(answer.message, pattern)
        self._test.assertNotIn('\n', answer.message)
        self._test.assertFalse([twist for twist in self.commands.messages if twist.linear.x or twist.angular.z])

    def states(self):
        """What mission_status told so far, without repetitions."""
        told = [message.state for message in self.status.messages]
        return [state for index, state in enumerate(told) if index == 0 or told[index - 1] != state]

    def waits_to_drive(self):
        """Wait until it commands the wheels from now on."""
        self.commands.fresh(lambda twist: abs(twist.linear.x) > 0.1)

    def end(self):
        """End it, in time and cleanly."""
        if self.process.returncode is None:
            begin = time.monotonic()
            self.process.send_signal(signal.SIGTERM)
            try:
                self._test.assertEqual(self.process.wait(TIMEOUT), 0)
                self._test.assertLess(time.monotonic() - begin, ENDS_WITHIN)
            finally:
                self.process.kill()
                self.process.wait()


class Goal:
    """One goal and its feedback."""

    def __init__(self, test, send, goal):
        self._test = test
        self.feedback = []
        self.handle = send(goal, feedback_cb=lambda _, feedback: self.feedback.append(feedback))

    @property
    def has_ended(self):
        """Whether there is a result."""
        return self.handle.get_comm_state() == actionlib.CommState.DONE

    def is_active(self):
        """Wait until it was taken up, and has told so; returns itself."""
        wait(self._test, lambda: self.feedback, 'feedback')
        return self

    def ends(self, how):
        """Wait for the end, which must be as told; returns the result."""
        wait(self._test, lambda: self.has_ended, 'a result')
        result = self.handle.get_result()
        self._test.assertEqual(ENDS[self.handle.get_goal_status()], how, result)
        return result
