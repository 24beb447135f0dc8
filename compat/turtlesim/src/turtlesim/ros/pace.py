"""How fast time passes, and the messages on /clock."""

import contextlib
import socket
import time
from typing import Optional

import rosgraph
import rospy
from rosgraph_msgs.msg import Clock

from turtlesim.model.errors import TurtlesimError
from turtlesim.model.turtles import STEP
from turtlesim.ros import simulated_time

STEP_NS = round(STEP * 1e9)
LATE = 0.1  # [s] a node that is later than this does not catch up
PATIENCE = 2.0  # [s] for the answer of a node that the master knows
TIMER_SLACK = 1000  # [ns]
QUEUE = 100  # messages that wait for a slow subscriber before the oldest is dropped


class Pace:
    """Waits for the wall clock as the speed demands; at a speed other than 1, time is simulated and sent on /clock."""

    def __init__(self, speed: float) -> None:
        """Take the speed [times real time]; 0: as fast as possible.

        Raises:
            TurtlesimError: another node publishes /clock.
        """
        self._speed = speed
        self._steps = 0
        self._due = 0.0
        self._clock: Optional[rospy.Publisher] = None
        if speed != 1.0:
            _refuse_second_clock()

    def begin(self) -> None:
        """Start the time."""
        if self._speed != 1.0:
            rospy.on_shutdown(simulated_time.restore)
            simulated_time.claim()
            rospy.loginfo('speed is not 1: /use_sim_time is now true, for nodes that start from now on')
            self._clock = rospy.Publisher('/clock', Clock, queue_size=QUEUE)
        self._due = time.monotonic()

    def step(self) -> None:
        """Count a step, and publish the time after it."""
        self._steps += 1
        if self._clock is not None and self._clock.get_num_connections():
            self._clock.publish(rospy.Time(*divmod(self._steps * STEP_NS, 1_000_000_000)))

    def next_step(self) -> float:
        """Return when the next step is due, a time of `time.monotonic`; one in the past if it is due now."""
        now = time.monotonic()
        if self._speed == 0.0:
            return now
        self._due += STEP / self._speed
        if self._due < now - LATE:
            self._due = now
        return self._due


def wake_on_time() -> None:
    """Have the kernel wake this thread on time and not up to 50 us later, if the system allows it.

    rospy sleeps for 0 s after each message that it sends. Under Python 3.11 such a sleep takes 60 us, often more than
    all other work.
    """
    with contextlib.suppress(OSError), open('/proc/self/timerslack_ns', 'w') as slack:
        slack.write(str(TIMER_SLACK))


def _refuse_second_clock() -> None:
    master = rosgraph.Master(rospy.get_name())
    publishers, _, _ = master.getSystemState()
    for node in dict(publishers).get('/clock', []):
        if node != rospy.get_name() and _answers(master, node):
            raise TurtlesimError(f'speed is not 1, but {node} publishes /clock already: end it first, '
                                 'or start this node with _speed:=1')


def _answers(master: rosgraph.Master, node: str) -> bool:
    """Whether a node is alive: the master still lists the topics of one that was killed."""
    try:
        address = rosgraph.network.parse_http_host_and_port(master.lookupNode(node))
        socket.create_connection(address, PATIENCE).close()
    except (rosgraph.MasterException, OSError):
        return False
    return True
