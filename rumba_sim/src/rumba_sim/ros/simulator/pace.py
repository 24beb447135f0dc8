"""How fast simulated time passes, and what the stamps of messages are."""

import contextlib
import time

import rospy
from rosgraph_msgs.msg import Clock

LATE = 0.1  # [s] behind the wall clock by more, the simulator gives up to catch up
TIMER_SLACK = 1000  # [ns]
HOLD_PERIOD = 0.1  # [s] while paused, the clock is told again: a node that starts then needs to know it


class Pace:
    """Turns ticks into stamps, and waits for the wall clock as far as the speed asks.

    In real time stamps are those of the wall clock, as of any robot's driver. In simulated time they count ticks from
    the beginning, are told on /clock, and never run backward.

    Attributes:
        speed: how many times faster than real time; 0: as fast as possible.
        late: how often the simulator was late and gave up to catch up.
        is_simulated: whether /clock is published.
    """

    def __init__(self, step_rate: int, speed: float, is_simulated: bool) -> None:
        """Begin now."""
        self.speed = speed
        self.late = 0
        self.is_simulated = is_simulated
        self._step_rate = step_rate
        self._ticks = 0
        # What is told before the first tick is as old as that: time 0 means `unknown` to ROS.
        self.stamp = self._after(1) if is_simulated else rospy.Time.now()
        self._due = time.monotonic()
        self._clock = rospy.Publisher('/clock', Clock, queue_size=10) if is_simulated else None

    def tick(self) -> None:
        """A tick has passed: take its stamp, and tell it."""
        self._ticks += 1
        if self._clock is not None:
            self.stamp = self._after(self._ticks)
            if self._clock.get_num_connections():
                self._clock.publish(self.stamp)
        else:
            self.stamp = max(rospy.Time.now(), self.stamp)

    def _after(self, ticks: int) -> rospy.Time:
        return rospy.Time(*divmod(ticks * 1_000_000_000 // self._step_rate, 1_000_000_000))

    def next_tick(self) -> float:
        """When the next tick is due, as a time of `time.monotonic`; a time in the past where it is due at once."""
        now = time.monotonic()
        if self.speed == 0.0:
            self._due = now
            return now
        self._due += 1.0 / (self._step_rate * self.speed)
        if self._due < now - LATE:
            self.late += 1
            self._due = now
        return self._due

    def hold(self) -> float:
        """While no tick passes: tell the clock again; returns until when to wait."""
        self._due = time.monotonic()
        if self._clock is not None:
            self._clock.publish(self.stamp)
        return self._due + HOLD_PERIOD


def wake_on_time() -> None:
    """Have the kernel wake the main thread when it asked for, not up to 50 us later, where it can.

    rospy sleeps for 0 s after each message that it sends; Python 3.11 makes 60 us of that, at times longer than all
    other work.
    """
    with contextlib.suppress(OSError), open('/proc/self/timerslack_ns', 'w') as slack:
        slack.write(str(TIMER_SLACK))
