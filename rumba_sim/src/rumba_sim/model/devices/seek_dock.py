"""Finds the dock by its infrared beams as a Roomba does on its own: no map, no position, only what its wheels count.

`rumba_cleaning.behaviours.homing` docks in the same way, but from where its caller has brought the robot.
"""

import math
from typing import Iterator, NamedTuple, Sequence

from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.kernel.sensors.dock import FORCE_FIELD, GREEN_BUOY, RED_BUOY
from rumba_sim.model.simulation.robot import Infrared, Twist

BUOYS = GREEN_BUOY | RED_BUOY
RATE = 10  # [Hz] of steps
TURN_RATE = 0.7  # [rad/s]
FAR_SPEED, NEAR_SPEED = 0.2, 0.1  # [m/s] outside and inside the force field
SLOWEST = 0.15  # [rad/s] of a turn: below, the wheels stand still
EXACT = 0.02  # [rad] to which it turns
STEER = 2.0  # [1/s] turn rate by error of the heading
ASIDE = 1.05  # [rad] off the direction of the dock, to get onto its axis
AGAIN = 0.4  # [m] after which it measures the direction of the dock again
FAR = 1.5  # [m] that it drives at most to get onto the axis
RETREAT = 0.35  # [m]
PRESSING = 15  # [steps] against something that is not the dock: the contacts close sooner
LEAST, MOST = 1.2, 3.1  # [rad] by which it turns off what it met while it looks for the dock
GOLDEN = 0.618034  # share of the way from the least to the most by which turns differ: none is like the one before
STILL = Twist(0.0, 0.0)


class Reading(NamedTuple):
    """What the robot knows."""

    odometry: Pose
    infrared: Infrared
    is_docked: bool
    bumper: Sequence[bool]
    cliffs: Sequence[bool]


class SeekDock:
    """Drives until the contacts of the dock close; while it gets no beam, from wall to wall."""

    def __init__(self) -> None:
        """Begin."""
        self._plan = self._go()
        self._bounces = 0
        self._reading: Reading

    def step(self, reading: Reading) -> Twist:
        """The velocity after a reading; `RATE` readings a second."""
        self._reading = reading
        return STILL if reading.is_docked else next(self._plan)

    def _go(self) -> Iterator[Twist]:
        while True:
            if not self._beams & BUOYS:
                yield from self._wander()
            yield from self._face()
            if self._beams & BUOYS == BUOYS:
                yield from self._ahead()
            elif self._beams & BUOYS:
                yield from self._turn_by(ASIDE if self._beams & GREEN_BUOY else -ASIDE)
                yield from self._cross()

    @property
    def _beams(self) -> int:
        return self._reading.infrared.omni

    @property
    def _faces(self) -> bool:
        """Whether both front receivers get a beam: only from ahead."""
        return bool(self._reading.infrared.left and self._reading.infrared.right)

    @property
    def _is_stopped(self) -> bool:
        return any(self._reading.bumper) or any(self._reading.cliffs)

    @property
    def _heading(self) -> float:
        return self._reading.odometry.theta

    def _driven(self, since: Pose) -> float:
        return hypot(self._reading.odometry.x - since.x, self._reading.odometry.y - since.y)

    # --- its parts ------------------------------------------------------------------------------------------------

    def _wander(self) -> Iterator[Twist]:
        """Drive straight until it gets a buoy; turn off what is in the way."""
        while not self._beams & BUOYS:
            if self._is_stopped:
                yield from self._back(0.5 * RETREAT)
                self._bounces += 1
                yield from self._turn_by(LEAST + (MOST - LEAST) * (self._bounces * GOLDEN % 1.0))
            yield Twist(FAR_SPEED, 0.0)

    def _face(self) -> Iterator[Twist]:
        """Turn to the middle of the headings at which both front receivers get a beam."""
        while self._faces and self._beams & BUOYS:
            yield Twist(0.0, -TURN_RATE)
        while not self._faces and self._beams & BUOYS:
            yield Twist(0.0, TURN_RATE)
        begin = self._heading
        while self._faces:
            yield Twist(0.0, TURN_RATE)
        yield from self._turn_by(-0.5 * wrap_angle(self._heading - begin))

    def _turn_by(self, angle: float) -> Iterator[Twist]:
        goal = wrap_angle(self._heading + angle)
        while abs(wrap_angle(goal - self._heading)) > EXACT:
            error = wrap_angle(goal - self._heading)
            yield Twist(0.0, math.copysign(max(SLOWEST, min(TURN_RATE, STEER * abs(error))), error))

    def _toward(self, heading: float, speed: float) -> Twist:
        return Twist(speed, STEER * wrap_angle(heading - self._heading))

    def _cross(self) -> Iterator[Twist]:
        """Drive until it gets both buoys."""
        since, heading = self._reading.odometry, self._heading
        while self._beams & BUOYS != BUOYS and self._driven(since) < FAR:
            if self._is_stopped:
                yield from self._back(RETREAT)
                return
            yield self._toward(heading, NEAR_SPEED)

    def _ahead(self) -> Iterator[Twist]:
        """Drive into the dock; return to measure its direction again."""
        since, heading, pressed = self._reading.odometry, self._heading, 0
        was_near = bool(self._beams & FORCE_FIELD)
        while self._beams & BUOYS == BUOYS:
            is_near = bool(self._beams & FORCE_FIELD)
            if is_near and not was_near or not is_near and self._driven(since) > AGAIN:
                return
            pressed = pressed + 1 if self._is_stopped else 0
            if pressed > PRESSING:
                yield from self._back(RETREAT)
                return
            yield self._toward(heading, NEAR_SPEED if is_near else FAR_SPEED)

    def _back(self, distance: float) -> Iterator[Twist]:
        since, steps = self._reading.odometry, int(2.0 * RATE * distance / NEAR_SPEED)
        while self._driven(since) < distance and steps:
            steps -= 1
            yield Twist(-NEAR_SPEED, 0.0)
