"""How a robot slides along what it touches, while its wheels tell it that it drives straight on."""

import math
from typing import List, NamedTuple, Optional

from rumba_cleaning.behaviour import Observation
from rumba_sim.model.common.geometry import Pose, wrap_angle

# Our choice.
LEAST = 0.02  # [m/s] sideways, for it to count: more than the noise of a pose
ASKEW, ALIGNED = 0.15, 0.05  # [rad] from a wall: it is to turn along that, and it is along it


class Slip(NamedTuple):
    """How a robot slides."""

    aside: float  # to its left [m/s]
    share: float  # of the way of its wheels that it makes


NO_SLIP = Slip(0.0, 1.0)


def heading_between(last: Pose, pose: Pose) -> float:
    """The heading halfway from a pose to another [rad]."""
    return last.theta + 0.5 * wrap_angle(pose.theta - last.theta)


def slipped(last: Optional[Pose], observation: Observation, driven: float) -> Slip:
    """How a robot slid since it was at its last pose; its wheels drove forward at a speed [m/s]. None: not known."""
    pose, dt = observation.pose, observation.dt
    if last is None or dt <= 0.0:
        return NO_SLIP
    along = heading_between(last, pose)
    x, y = (pose.x - last.x) / dt, (pose.y - last.y) / dt
    aside = y * math.cos(along) - x * math.sin(along)
    if abs(aside) <= LEAST:
        return NO_SLIP
    ahead = x * math.cos(along) + y * math.sin(along)
    return Slip(aside, min(max(ahead / driven, 0.0), 1.0) if driven > LEAST else 1.0)


class Alignment:
    """The wall along which a robot is to turn that slides by it askew."""

    def __init__(self) -> None:
        """Know of no wall."""
        self.forget()

    def forget(self) -> None:
        """Turn along no wall any more."""
        self._heading: Optional[float] = None  # [rad]
        self._askew = 0.0  # how the robot slid aside in the last reading, if that was askew [m/s]

    def turn(self, pose: Pose, slip: Slip, driven: float) -> float:
        """How far it is to turn [rad], from a pose, as it slides while its wheels drive at a speed [m/s]; 0: not.

        It turns if two readings in a row show that it slides to the same side: a pose that jumps does so once.
        """
        askew = slip.aside if abs(slip.aside) > ASKEW * max(driven, LEAST) else 0.0
        if askew * self._askew > 0.0:
            self._heading = pose.theta + math.atan2(askew, slip.share * driven)
        self._askew = askew
        if self._heading is None:
            return 0.0
        turn = wrap_angle(self._heading - pose.theta)
        if abs(turn) < ALIGNED:
            self.forget()
            return 0.0
        return turn


def along_contacts(observation: Observation, speed: float) -> List[Slip]:
    """How a robot may slide that pushes forward with its wheels at a speed [m/s]; nothing if it touches nothing.

    At an angle a from its front, what it touches turns a speed v into v * sin(a) * cos(a) sideways, away from it, and
    v * sin(a) ** 2 is left ahead; sideways most at 45 degrees.
    """
    left, right = observation.bumper
    return [*([Slip(-0.5 * speed, 0.5)] if left else []), *([Slip(0.5 * speed, 0.5)] if right else [])]
