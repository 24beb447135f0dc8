"""The dock of a robot that finds it by itself, as a Create does: whether it stands there, and when it must let go.

Such a robot obeys velocities in its modes safe and full. Once it is told to dock it is passive: it follows the beams of
its dock, charges there, and ignores velocities, until it is told to undock, which only takes it back to the mode full.
Full mode ends charging, so that the charger does not tell whether the robot still stands on the contacts.

Sources: create_robot, create_driver/src/create_driver.cpp (`dockCallback`, `undockCallback`); iRobot Create 2 Open
Interface specification (modes; packets 17, 21, 35; the characters 160 to 173 of the dock).
"""

from typing import Optional

from rumba_cleaning.own_robot.gate import STOP, Velocity
from rumba_sim.model.common.geometry import Pose, hypot

DOCK, UNDOCK = 'dock', 'undock'  # what a driver can be told
PASSIVE = 1  # mode, and below it is off
NOT_CHARGING, FAULT = 0, 5  # states of the charger
AGAIN = {DOCK: 5.0, UNDOCK: 0.5}  # [s] after which the same is told again if the mode has not changed; our choice: a
#                                   driver tells its mode ten times a second, and one for a Create 1 sleeps for 1 s
MOVED = 0.05  # [m] from where it charged, from which on a robot is not docked
LAPSE = 10.0  # [s] without a current, in which contacts that bounce close again, or the charger begins; our choice
BEAMS = range(160, 174)  # characters of a dock: 160, and 1 for the force field, 4 and 8 for its buoys
VIRTUAL_WALL = 162  # a character of something else


class OwnDock:
    """What is known of it, and what the driver is to be told.

    Attributes:
        is_passive: whether the robot obeys nobody.
        infrared: the beams of a dock that it receives, as a sum of bits of rumba_msg/DockStatus.
    """

    def __init__(self, is_docked: bool) -> None:
        """Know whether the robot stands on its dock at first."""
        self.is_passive = False
        self.infrared = 0
        self._begins = is_docked
        self._pose: Optional[Pose] = None  # by odometry
        self._berth: Optional[Pose] = None  # where it was docked last, if it is still there
        self._is_charging = False
        self._idle_since = 0.0  # [s] since when no current has flowed although the robot is passive
        self._told = ''  # what the driver was told last, until the robot charges, or obeys again
        self._told_at = 0.0  # [s]

    @property
    def is_docked(self) -> bool:
        """Whether the robot stands on its dock."""
        return self._berth is not None

    def take_mode(self, mode: int, now: float) -> None:
        """The driver tells its mode, at a time [s]."""
        is_passive = mode <= PASSIVE
        if is_passive and not self.is_passive:
            self._idle_since = now
        self.is_passive = is_passive

    def take_charging_state(self, state: int) -> None:
        """The driver tells what the charger does."""
        self._is_charging = state not in (NOT_CHARGING, FAULT)
        if self._is_charging and self._told == DOCK:
            self._told = ''

    def take_infrared(self, character: int) -> None:
        """The driver tells what the receiver for all directions gets."""
        self.infrared = character - BEAMS[0] if character in BEAMS and character != VIRTUAL_WALL else 0

    def take_odometry(self, pose: Pose, now: float) -> None:
        """Where the robot is by its odometry, at a time [s]."""
        if self._pose is None and self._begins:
            self._berth = pose
        self._pose = pose
        berth = self._berth
        if self._is_charging:
            self._berth, self._idle_since = pose, now
        elif berth is not None and (hypot(pose.x - berth.x, pose.y - berth.y) > MOVED
                                    or self.is_passive and now - self._idle_since > LAPSE):
            self._berth = None

    def due(self, velocity: Optional[Velocity], now: float) -> str:
        """What to tell the driver now.

        Args:
            velocity: what the robot is commanded; None: nothing.
            now: time [s].

        Returns:
            DOCK, UNDOCK, or nothing.
        """
        if self._told == UNDOCK and not self.is_passive:
            self._told = ''
        wanted = self._wanted(velocity)
        has_effect = self.is_passive is (wanted == DOCK)
        if not wanted or wanted == self._told and (has_effect or now - self._told_at < AGAIN[wanted]):
            return ''
        self._told, self._told_at = wanted, now
        return wanted

    def _wanted(self, velocity: Optional[Velocity]) -> str:
        if velocity is not None and velocity.seeks_dock:
            return '' if self._is_charging or self.is_passive and self.is_docked else DOCK
        if velocity is not None and velocity != STOP:
            return UNDOCK if self.is_passive or self._told == DOCK else ''
        is_under_way = self._told == DOCK or self._told == UNDOCK and self.is_passive
        return UNDOCK if is_under_way and not self._is_charging else ''
