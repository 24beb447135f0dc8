"""The time of stamps: that of /clock while time is simulated, else that of the wall clock."""

import struct
import threading
import time
from typing import Any, Optional, Tuple

import rospy

STAMP = struct.Struct('<II')  # a message of /clock: seconds and nanoseconds
SECOND = 1_000_000_000  # [ns]
PATIENCE = 1.0  # [s] for the first message
CLOCK = '/clock'


class Clock:
    """Knows the time. The node itself goes by the wall clock, since it also serves while simulated time stands."""

    def __init__(self) -> None:
        """Go by the wall clock until told otherwise."""
        self._subscriber: Any = None
        self._newest: Optional[bytes] = None
        self._has_come = threading.Event()

    def follow(self, is_simulated: bool) -> None:
        """Go by /clock or by the wall clock; waits for the master, and a moment for the first message."""
        if is_simulated and self._subscriber is None:
            self._subscriber = rospy.Subscriber(CLOCK, rospy.AnyMsg, self._take, queue_size=1, tcp_nodelay=True)
            self._has_come.wait(PATIENCE)
        elif not is_simulated and self._subscriber is not None:
            self._subscriber.unregister()
            self._subscriber, self._newest = None, None
            self._has_come.clear()

    def _take(self, message: Any) -> None:
        if len(message._buff) == STAMP.size and STAMP.unpack(message._buff)[1] < SECOND:
            self._newest = message._buff
            self._has_come.set()

    def now(self) -> Tuple[int, int]:
        """Seconds and nanoseconds; both 0 if time is simulated and has not begun."""
        newest = self._newest
        if newest is not None:
            seconds, rest = STAMP.unpack(newest)
        elif self._subscriber is not None:
            seconds, rest = 0, 0
        else:
            seconds, rest = divmod(time.time_ns(), SECOND)
        return seconds, rest
