"""The speed of simulated time, and the stamps of messages."""

import contextlib
import time

import rospy
from rosgraph_msgs.msg import Clock

LATE = 0.1  # [s] if the simulator is later than this, it does not catch up
SET_BACK = 1_000_000_000  # [ns] by which the wall clock must be set back to be worth a line
TIMER_SLACK = 1000  # [ns]
HOLD_PERIOD = 0.1  # [s] between messages on /clock while paused: a node that starts then needs the time


class Pace:
    """Turns ticks into stamps, and computes when the next tick is due.

    In real time, stamps are the time of the wall clock, as those of the driver of a real robot; if that clock is set
    back, they go on from where they were. In simulated time, they count the ticks since the start, and are published on
    /clock. They never run backward.

    Attributes:
        due: when the next tick is due, as a time of `time.monotonic`; in the past if it is due at once.
        late: how often the simulator was too late and did not catch up.
        is_simulated: whether /clock is published.
        stamp: time of the last tick.
    """

    def __init__(self, step_rate: int, speed: float, is_simulated: bool, ticks: int = 0) -> None:
        """Start now.

        Args:
            step_rate: [Hz] of ticks.
            speed: [times real time]; 0: as fast as possible.
            is_simulated: whether to publish /clock.
            ticks: number of ticks that have passed before.
        """
        self._speed = speed
        self.late = 0
        self.is_simulated = is_simulated
        self._step_rate = step_rate
        self._ticks = ticks
        self._is_set_back = False
        self._ahead = _ahead()
        # Messages before the first tick have the stamp of that tick: in ROS, time 0 means `unknown`.
        self.stamp = _stamp(self._simulated_ns(ticks + 1)) if is_simulated else self._real()
        self.due = time.monotonic()
        self._clock = rospy.Publisher('/clock', Clock, queue_size=10) if is_simulated else None

    @property
    def speed(self) -> float:
        """Wanted speed [times real time]; 0: as fast as possible. If it changes, the next tick is due at once."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        if speed != self._speed:
            self._speed = speed
            self.hurry()

    def hurry(self) -> None:
        """Make the next tick due now."""
        self.due = time.monotonic()

    def tick(self, is_told: bool = True) -> None:
        """Count a tick, take its stamp, and publish the clock if it is to be told."""
        self._ticks += 1
        if self._clock is not None:
            self.stamp = _stamp(self._simulated_ns(self._ticks))
            if is_told and self._clock.get_num_connections():
                self._clock.publish(self.stamp)
        else:
            self.stamp = self._real()

    def _simulated_ns(self, ticks: int) -> int:
        return ticks * 1_000_000_000 // self._step_rate

    def _real(self) -> rospy.Time:
        """The time of the wall clock, but as if it had never been set back."""
        ahead = _ahead()
        if self._ahead - ahead > SET_BACK and not self._is_set_back:
            self._is_set_back = True
            seconds = (self._ahead - ahead) / 1e9
            rospy.logwarn(f'the wall clock was set back by {seconds:.1f} s: stamps go on from where they were, and are '
                          'ahead of it until the simulator is started again')
        self._ahead = max(self._ahead, ahead)
        return _stamp(time.monotonic_ns() + self._ahead)

    def next_tick(self) -> None:
        """Compute when the next tick is due."""
        now = time.monotonic()
        if self._speed == 0.0:
            self.due = now
            return
        self.due += 1.0 / (self._step_rate * self._speed)
        if self.due < now - LATE:
            self.late += 1
            self.due = now

    def hold(self) -> None:
        """Publish the clock again while paused; this is due again after a while."""
        self.due = time.monotonic() + HOLD_PERIOD
        self.tell_again()

    def tell_again(self) -> None:
        """Publish the clock again."""
        if self._clock is not None:
            self._clock.publish(self.stamp)


def _ahead() -> int:
    """By how much the wall clock is ahead of the monotonic one [ns], or less if this process was interrupted here."""
    return time.time_ns() - time.monotonic_ns()


def _stamp(nanoseconds: int) -> rospy.Time:
    return rospy.Time(*divmod(nanoseconds, 1_000_000_000))


def wake_on_time() -> None:
    """Have Linux wake the main thread in time, not up to 50 us later, if this system allows it.

    rospy sleeps for 0 s after each message that it sends; with Python 3.11 this takes 60 us, which can be longer than
    the rest of a tick.
    """
    with contextlib.suppress(OSError), open('/proc/self/timerslack_ns', 'w') as slack:
        slack.write(str(TIMER_SLACK))
