"""Which velocity a robot is commanded: none if something is silent, never more than it may drive, a person's first."""

import math
from typing import Dict, NamedTuple, Optional, Sequence

from rumba_sim.model.settings.robot_config import DriveConfig

STANDING = 2.0  # [s] of the wall clock without a sign, after which the robot is stopped although its time stands still
REPEATED = 1.0  # [s] for which a stop is commanded again and again; then others may drive, who do not go by the gate
CLEANER, PERSON = 'cleaner', 'person'  # who commands


class Velocity(NamedTuple):
    """A command."""

    v: float  # [m/s]
    w: float  # [rad/s]
    seeks_dock: bool = False  # instead, the robot is to find its dock by itself, or to stay on it


class Moment(NamedTuple):
    """A time."""

    robot: float  # [s] of the robot's clock
    wall: float  # [s] of the wall clock


STOP = Velocity(0.0, 0.0)
SEEK_DOCK = Velocity(0.0, 0.0, seeks_dock=True)


class Gate:
    """What comes in, and what goes out.

    Attributes:
        reason: why the robot is stopped, for a person; empty if it is not.
    """

    def __init__(self, drive: DriveConfig, silence: float, needed: Sequence[str]) -> None:
        """Know the limits.

        Args:
            drive: of the robot.
            silence: how long a source, or who commands, may be silent [s].
            needed: names of the sources without which the robot must not drive.
        """
        self.reason = ''
        self._drive, self._silence = drive, silence
        self._heard: Dict[str, Optional[Moment]] = {name: None for name in needed}
        self._commands: Dict[str, Velocity] = {}
        self._fault = ''  # that was reported, until it is cleared
        self._last = STOP
        self._stopped: Optional[Moment] = None  # when a stop was commanded first, after something else

    def hear(self, source: str, now: Moment) -> None:
        """A source gave a sign."""
        self._heard[source] = now

    def command(self, who: str, velocity: Velocity, now: Moment) -> None:
        """Somebody commands a velocity; one that is no number is a stop."""
        self._heard[who] = now
        self._commands[who] = velocity if all(map(math.isfinite, velocity)) else STOP

    def stop(self, reason: str) -> None:
        """Stop, also for a person, until `release`."""
        self._fault = reason

    def release(self) -> None:
        """Drive again."""
        self._fault = ''

    def output(self, now: Moment) -> Optional[Velocity]:
        """What to command now; None: nothing, so that others may."""
        wanted = self._wanted(now)
        if wanted is None or wanted == STOP:
            if self._last != STOP:
                self._stopped = now
            self._last = STOP
            if wanted is None and (self._stopped is None or now.wall - self._stopped.wall > REPEATED):
                return None
            return STOP
        self._last = limited(wanted, self._drive)
        return self._last

    def _wanted(self, now: Moment) -> Optional[Velocity]:
        self.reason = self._fault
        if self._fault:
            return None
        if self._is_heard(PERSON, now):
            return self._commands[PERSON]
        if not self._is_heard(CLEANER, now):
            return None
        silent = [name for name in self._heard if name not in (PERSON, CLEANER) and not self._is_heard(name, now)]
        if silent:
            self.reason = f'nothing came on {" and ".join(silent)} for {self._silence:g} s'
            return STOP
        return self._commands[CLEANER]

    def _is_heard(self, name: str, now: Moment) -> bool:
        heard = self._heard.get(name)
        return heard is not None and now.robot - heard.robot <= self._silence and now.wall - heard.wall <= STANDING


def limited(velocity: Velocity, drive: DriveConfig) -> Velocity:
    """A velocity within the limits of a robot, along the same curve."""
    v, w, _ = velocity
    wheel = abs(v) + 0.5 * drive.wheel_base * abs(w)  # the faster one
    share = min(1.0, drive.max_speed / wheel if wheel > 0.0 else 1.0, drive.max_turn_rate / abs(w) if w else 1.0)
    return velocity._replace(v=v * share, w=w * share)
