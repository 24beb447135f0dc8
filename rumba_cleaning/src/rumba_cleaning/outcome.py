"""How a behaviour ended, as a code for programs."""

import enum


class Outcome(enum.IntEnum):
    """The constants of rumba_msg/Outcome."""

    UNKNOWN = 0
    """It has not ended."""
    SUCCEEDED = 1
    """The goal is reached, or the behaviour has done its job."""
    CANCELLED = 2
    """A client cancelled the goal."""
    PREEMPTED = 3
    """A newer goal took its place."""
    REFUSED = 4
    """The goal cannot be carried out as it stands."""
    TIMED_OUT = 5
    """Not done within the time limit."""
    INCOMPLETE = 6
    """Nothing more can be reached, or too little of it, or the strategy has done its job, but the target is not met."""
    NO_PATH = 7
    """No path leads to the target or to the dock."""
    BLOCKED = 8
    """Something keeps the robot from going on."""
    BATTERY_LOW = 9
    """The charge does not last for what is left to do."""
    BATTERY_EMPTY = 10
    """The robot stands still without charge."""
    FALLEN = 11
    """A wheel hangs over a cliff."""
    NO_READINGS = 12
    """The robot is gone, or one of its sensors is silent."""
    FAILED = 13
    """The behaviour gave up for a reason of its own."""
    ERROR = 14
    """An exception was raised."""
    LOST = 15
    """The robot does not know where it is."""

    @property
    def words(self) -> str:
        """Its name for people."""
        return self.name.lower().replace('_', ' ')
