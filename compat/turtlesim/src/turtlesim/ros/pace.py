"""How fast time passes, and what /clock tells."""

import contextlib
import time
from typing import Optional

import rosgraph
import rospy
from rosgraph_msgs.msg import Clock

from turtlesim.model.errors import TurtlesimError
from turtlesim.model.turtles import STEP

STEP_NS = round(STEP * 1e9)
LATE = 0.1  # [s] behind the wall clock by more, the node gives up to catch up
TIMER_SLACK = 1000  # [ns]


class Pace:
    """Waits for the wall clock as far as the speed asks; at a speed other than 1 time is simulated, told on /clock."""

    def __init__(self, speed: float) -> None:
        """Go at a speed in times real time; 0: as fast as possible.

        Raises:
            TurtlesimError: somebody else tells the time.
        """
        self._speed = speed
        self._steps = 0
        self._due = 0.0
        self._clock: Optional[rospy.Publisher] = None
        if speed != 1.0:
            _refuse_second_clock()

    def begin(self) -> None:
        """Let time begin."""
        if self._speed != 1.0:
            rospy.on_shutdown(_forget_simulated_time)
            rospy.set_param('/use_sim_time', True)
            rospy.loginfo('speed is not 1: /use_sim_time is now true, for nodes that start from now on')
            self._clock = rospy.Publisher('/clock', Clock, queue_size=10)
        self._due = time.monotonic()

    def step(self) -> None:
        """A step has passed: tell it."""
        self._steps += 1
        if self._clock is not None and self._clock.get_num_connections():
            self._clock.publish(rospy.Time(*divmod(self._steps * STEP_NS, 1_000_000_000)))

    def next_step(self) -> float:
        """When the next step is due, as a time of `time.monotonic`; a time in the past where it is due at once."""
        now = time.monotonic()
        if self._speed == 0.0:
            return now
        self._due += STEP / self._speed
        if self._due < now - LATE:
            self._due = now
        return self._due


def wake_on_time() -> None:
    """Have the kernel wake the main thread when it asked for, not up to 50 us later, where it can.

    rospy sleeps for 0 s after each message that it sends; Python 3.11 makes 60 us of that, at times longer than all
    other work.
    """
    with contextlib.suppress(OSError), open('/proc/self/timerslack_ns', 'w') as slack:
        slack.write(str(TIMER_SLACK))


def _refuse_second_clock() -> None:
    me = rospy.get_name()
    publishers, _, _ = rosgraph.Master(me).getSystemState()
    others = [node for topic, nodes in publishers if topic == '/clock' for node in nodes if node != me]
    if others:
        raise TurtlesimError(f'speed is not 1, but {others[0]} tells the time on /clock already: end it first, '
                             'or run this with _speed:=1')


def _forget_simulated_time() -> None:
    """Take /use_sim_time back: with nobody to tell it, time would stand still for whatever node starts next."""
    with contextlib.suppress(KeyError, OSError):  # somebody else did, or the master has gone
        rospy.delete_param('/use_sim_time')
