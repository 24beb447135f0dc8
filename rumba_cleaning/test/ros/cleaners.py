"""What the tests of the cleaner share: a cleaner as a user starts it, and clients of its actions."""

import functools
import signal
import threading
import time

import actionlib
import programs
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D, Twist
from simulators import ENDS_WITHIN, LOOK_PERIOD, TIMEOUT, Heard, wait, wait_for_service
from teams import QUICKLY

from rumba_msg.msg import CleanAction, DockAction, GoToAction, GoToGoal, MissionStatus, Outcome, UndockAction

programs.LIBRARIES += ['actionlib_msgs.msg', 'rumba_cleaning.mission', 'rumba_cleaning.planning.warm_up']
# A map file of cells of 5 cm, to which a test adds what stands on it.
FLOOR = """image: floor.pgm
resolution: 0.05
origin: [0, 0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
AT_ONCE = rospy.Duration(nsecs=1)
KEY_PERIOD = 0.1  # [s] from one command of a person to the next, as of teleop_key
ACTIONS = {'clean': CleanAction, 'dock': DockAction, 'undock': UndockAction, 'go_to': GoToAction}
# Statuses of actionlib by the code of the outcome; goals with any other code are aborted.
STATUSES = {Outcome.SUCCEEDED: GoalStatus.SUCCEEDED, Outcome.CANCELLED: GoalStatus.PREEMPTED,
            Outcome.PREEMPTED: GoalStatus.PREEMPTED}


def go_to(x, y, theta=float('nan'), time_limit=0.0):
    """A goal of go_to."""
    return GoToGoal(Pose2D(x, y, theta), time_limit)


def drives(twist):
    """Whether a command moves a robot."""
    return bool(twist.linear.x or twist.angular.z)


class Cleaner:
    """A cleaner for one test, and, once it is connected, the clients of its actions."""

    def __init__(self, test, *arguments, name='/cleaner', robot='/rumba', stderr=None):
        self._test = test
        self._robot = robot
        if rospy.has_param(name):
            rospy.delete_param(name)
        # As in a launch file: simulator and cleaner start at the same time, both in simulated time.
        rospy.set_param('/use_sim_time', True)
        self.process = programs.start('rumba_cleaning', 'cleaner', f'_planning_rounds:={QUICKLY.planning_rounds}',
                                      *arguments, stderr=stderr, universal_newlines=True)
        test.addCleanup(self.end)

    def connect(self):
        """Wait until it is there; returns itself."""
        test = self._test
        wait_for_service(test, f'{self._robot}/go_to_position', self.process)
        self.clients = {}
        for action, kind in ACTIONS.items():
            self.clients[action] = actionlib.ActionClient(f'{self._robot}/{action}', kind)
            test.addCleanup(self.clients[action].stop)
            # Its own time limit is in simulated time, in which a second may be over at once.
            wait(test, functools.partial(self.clients[action].wait_for_server, AT_ONCE), action, LOOK_PERIOD)
        self.status = Heard(test, f'{self._robot}/mission_status', MissionStatus)
        self.commands = Heard(test, f'{self._robot}/cmd_vel', Twist)
        return self

    def send(self, action, goal):
        """Send a goal; returns it as it goes on."""
        return Goal(self._test, self.clients[action].send_goal, goal)

    def refuses(self, pattern, action, goal, code=Outcome.REFUSED):
        """Send a goal that must end with an outcome for a reason, without any command to the wheels."""
        if self.commands.messages:  # those of the goal before may still be on their way
            self.commands.last(lambda twist: not drives(twist))
        self.commands.messages.clear()
        message = self.send(action, goal).ends(code).outcome.message
        self._test.assertRegex(message, pattern)
        self._test.assertNotIn('\n', message)
        self._test.assertFalse(list(filter(drives, self.commands.messages)))

    def settles(self):
        """Wait until it says that it is idle or stranded, which may come after the result; returns that status."""
        return self.status.last(lambda status: status.state in (MissionStatus.IDLE, MissionStatus.STRANDED))

    def states(self):
        """What mission_status said until it settled, without repetitions."""
        self.settles()
        said = [message.state for message in self.status.messages]
        return [state for index, state in enumerate(said) if index == 0 or said[index - 1] != state]

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
        """Wait until its first feedback; returns itself."""
        wait(self._test, lambda: self.feedback, 'feedback')
        return self

    def ends(self, code):
        """Wait for the end, which must have this outcome; returns the result."""
        wait(self._test, lambda: self.has_ended, 'a result')
        result = self.handle.get_result()
        self._test.assertEqual(result.outcome.code, code, result)
        self._test.assertEqual(self.handle.get_goal_status(), STATUSES.get(code, GoalStatus.ABORTED), result)
        return result


class Person:
    """Somebody who presses a key from `press` to `release`."""

    def __init__(self, test):
        self._publisher = rospy.Publisher('/rumba/teleop/cmd_vel', Twist, queue_size=1)
        test.addCleanup(self._publisher.unregister)
        wait(test, lambda: self._publisher.get_num_connections() >= 2, 'simulator and cleaner to listen')
        test.addCleanup(self.release)
        self._thread = None

    def press(self, v, w):
        """Drive with a velocity [m/s], [rad/s]."""
        twist = Twist()
        twist.linear.x, twist.angular.z = v, w
        self._released = threading.Event()
        self._thread = threading.Thread(target=self._publish, args=(twist,), daemon=True)
        self._thread.start()

    def _publish(self, twist):
        while not self._released.wait(KEY_PERIOD):
            self._publisher.publish(twist)

    def release(self):
        """Press no key."""
        if self._thread is not None:
            self._released.set()
            self._thread.join()
            self._thread = None
