"""Whether there is a turtle, and what to say and do while there is none; times are those of the wall clock."""

import math
from typing import Optional

REMINDER_PERIOD = 10.0  # [s] from one line to the next
UNHEARD_AFTER = 2.0  # [s] without a publisher of poses: long enough for a turtlesim that starts at the same time
SILENT_AFTER = 10.0  # [s] without a pose although there is a publisher: a turtlesim can be slow
GONE_AFTER = 10.0  # [s] without a publisher, or with poses that cannot be used: the robot has no body
HUNG_AFTER = 60.0  # [s] the same, for a publisher that is silent


class Watch:
    """Follows the poses of one turtle, given by the name of their topic."""

    def __init__(self, topic: str, now: float) -> None:
        """Start to wait for the first pose."""
        self._topic = topic
        self._seen = now  # the newest pose
        self._odd = -math.inf  # the newest pose that no turtle can have
        self._due = -math.inf  # when the next line is due
        self._is_missed = False

    def see(self, now: float) -> bool:
        """Note a pose; returns whether the turtle had been missed."""
        was_missed, self._is_missed = self._is_missed, False
        self._seen, self._due = now, -math.inf
        return was_missed

    def see_odd(self, now: float) -> None:
        """Note a pose that no turtle can have."""
        self._odd = now

    def line(self, now: float, is_heard: bool) -> Optional[str]:
        """Why no pose comes, for a person, if it is time to say so.

        Args:
            now: present time [s].
            is_heard: whether a node publishes the poses.
        """
        missed = now - self._seen
        if missed < (UNHEARD_AFTER if not is_heard or self._is_odd else SILENT_AFTER) or now < self._due:
            return None
        self._due, self._is_missed = now + REMINDER_PERIOD, True
        if not is_heard:
            return f'no turtle: nothing publishes {self._topic}'
        if self._is_odd:
            return (f'{self._topic} has numbers that are not finite, or too large: turtlesim may miss its pictures; '
                    'ignored')
        return f'no pose on {self._topic} for {missed:.0f} s: turtlesim hangs, or its time stands still'

    def is_gone(self, now: float, is_heard: bool) -> bool:
        """Whether the turtle has been missing for so long that the robot has no body."""
        return now - self._seen > (HUNG_AFTER if is_heard and not self._is_odd else GONE_AFTER)

    @property
    def _is_odd(self) -> bool:
        return self._odd > self._seen
