"""The speed of simulated time, and the stamps of messages."""

import contextlib
import time

import rospy
from rosgraph_msgs.msg import Clock

LATE = 0.1  # [s] if the simulator is later than this, it does not catch up
TIMER_SLACK = 1000  # [ns]
HOLD_PERIOD = 0.1  # [s] between messages on /clock while paused: a node that starts then needs the time


class Pace:
    """Turns ticks into stamps, and computes when the next tick is due.

    In real time, stamps are the time of the wall clock, as those of the driver of a real robot. In simulated time, they
    count the ticks since the start, are published on /clock, and never run backward.

    Attributes:
        speed: [times real time]; 0: as fast as possible.
        late: how often the simulator was too late and did not catch up.
        is_simulated: whether /clock is published.
        stamp: time of the last tick.
    """

    def __init__(self, step_rate: int, speed: float, is_simulated: bool) -> None:
        """Start now.

        Args:
            step_rate: [Hz] of ticks.
            speed: [times real time]; 0: as fast as possible.
            is_simulated: whether to publish /clock.
        """
        self.speed = speed
        self.late = 0
        self.is_simulated = is_simulated
        self._step_rate = step_rate
        self._ticks = 0
        # Messages before the first tick have the stamp of that tick: in ROS, time 0 means `unknown`.
        self.stamp = self._after(1) if is_simulated else rospy.Time.now()
        self._due = time.monotonic()
        self._clock = rospy.Publisher('/clock', Clock, queue_size=10) if is_simulated else None

    def tick(self) -> None:
        """Count a tick, take its stamp, and publish the clock."""
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
        """When the next tick is due, as a time of `time.monotonic`; in the past if it is due at once."""
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
        """Publish the clock again while paused; returns until when to wait, as a time of `time.monotonic`."""
        self._due = time.monotonic()
        if self._clock is not None:
            self._clock.publish(self.stamp)
        return self._due + HOLD_PERIOD


def wake_on_time() -> None:
    """Have Linux wake the main thread in time, not up to 50 us later, if this system allows it.

    rospy sleeps for 0 s after each message that it sends; with Python 3.11 this takes 60 us, which can be longer than
    the rest of a tick.
    """
    with contextlib.suppress(OSError), open('/proc/self/timerslack_ns', 'w') as slack:
        slack.write(str(TIMER_SLACK))
