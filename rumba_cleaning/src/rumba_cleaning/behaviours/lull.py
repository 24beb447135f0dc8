"""Notices that a robot cleans in vain: coverage has hardly risen for a while."""

# Our choice: missions among obstacles are to be home within 1.15 times the time at which they reached what they can.
LITTLE = 0.001  # of coverage
SHARE, SHORTEST = 0.05, 20.0  # of the time so far, and [s]: a lull is longer than both


class Lull:
    """The time since coverage last rose by LITTLE."""

    def __init__(self) -> None:
        """Begin, with nothing swept."""
        self._time = self._risen_at = 0.0  # [s]
        self._coverage = 0.0  # when it last rose

    def watch(self, coverage: float, dt: float) -> None:
        """Take note of coverage [0..1] after a step [s]."""
        self._time += dt
        if coverage > self._coverage + LITTLE:
            self._coverage, self._risen_at = coverage, self._time

    @property
    def is_long(self) -> bool:
        """Whether it has lasted for so long that little more will come."""
        return self._time - self._risen_at > max(SHARE * self._time, SHORTEST)
