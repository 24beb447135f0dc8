"""Drives into the dock by its infrared beams alone: no map, no position, only how far the robot turned and drove.

The dock sends a green beam to the right half of its field and a red one to the left half, as seen by a robot that
faces it; a robot that gets both is on the dock's axis. A front receiver gets a beam only from ahead and from its own
side, so both get one only while the robot faces the dock (iRobot Roomba 600 Open Interface specification, on the home
base).
"""

import enum
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.behaviours.follower import Turn
from rumba_cleaning.belief.context import Context
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.kernel.sensors.dock import FORCE_FIELD, GREEN_BUOY, RED_BUOY

BUOYS = GREEN_BUOY | RED_BUOY
# The figures below were chosen together with bench/docking.py: each of its 800 robots comes to the contacts.
SCAN_RATE = 0.7  # [rad/s] while it looks for where the receivers begin and cease to get the beams
ASIDE = 1.05  # [rad] off the dock's direction, to get onto its axis: 60 degrees
FAR_SPEED, NEAR_SPEED = 0.2, 0.1  # [m/s] outside and inside the force field
AGAIN = 0.4  # [m] after which the direction is measured again: more often costs time, less often misses the contacts
RETREAT = 0.35  # [m]: twice the robot's radius, enough to come in again from another side
PRESSING = 1.5  # [s] against something that is not the dock: the contacts close sooner
LOST = 8.0  # [s] without any beam, in which the robot turns almost once around
STEER = 2.0  # [1/s] turn rate by error of the heading: half of the error is gone in 0.35 s
RETREATS = 3  # our choice: a robot that comes in aslant needs one
PATIENCE = 120.0  # [s] from the first beam to the contacts: more than twice the longest in bench/docking.py


class _Phase(enum.Enum):
    SEEK = 'turn until both front receivers get a beam'
    EDGE = 'turn on until one of them gets none'
    FACE = 'turn back to the middle of the two'
    ASIDE = 'turn away from the dock, toward its axis'
    CROSS = 'drive until both buoys are received'
    AHEAD = 'drive into the dock'
    RETREAT = 'drive back'


class Homing(Behaviour):
    """Docks from anywhere in the field of the buoys; fails if it gets no beam."""

    def __init__(self, context: Context) -> None:
        """Use a robot's limits and the reach of its dock's beams."""
        self._context = context

    def initialise(self) -> None:
        """Begin by looking around."""
        self._side = 1.0  # turn to the left: 1
        self._lost = 0.0  # [s]
        self._pressed = 0.0  # [s]
        self._retreats = 0
        self._time = 0.0  # [s]
        self._is_near = False
        self._enter(_Phase.SEEK, None)

    def update(self, observation: Observation) -> Command:
        """Seek, face, cross, ahead."""
        if observation.is_docked:
            return self.succeed('docked')
        beams = observation.infrared.omni
        self._lost = 0.0 if beams & BUOYS else self._lost + observation.dt
        if self._lost > LOST:
            return self.fail('the beams of the dock are lost')
        self._time += observation.dt
        if self._time > PATIENCE or self._retreats > RETREATS:
            return self.fail('something keeps the robot from the contacts', Outcome.BLOCKED)
        if any(observation.cliffs) and self._phase is not _Phase.RETREAT:
            self._retreats += 1
            self._enter(_Phase.RETREAT, observation.pose)
        return {
            _Phase.SEEK: self._seek, _Phase.EDGE: self._edge, _Phase.FACE: self._face, _Phase.ASIDE: self._turn_aside,
            _Phase.CROSS: self._cross, _Phase.AHEAD: self._ahead, _Phase.RETREAT: self._retreat,
        }[self._phase](observation)

    def take_note(self, observation: Observation) -> None:
        """Look around again, wherever the robot will be."""
        self._lost = self._pressed = 0.0
        self._is_near = False
        self._enter(_Phase.SEEK, None)

    def _enter(self, phase: _Phase, pose: Optional[Pose], heading: float = 0.0) -> None:
        self._phase = phase
        self._since = pose
        self._heading = heading
        self._turn = Turn(heading, self._context.robot.drive)

    def _driven(self, pose: Pose) -> float:
        return hypot(pose.x - self._since.x, pose.y - self._since.y) if self._since is not None else 0.0

    # --- turning --------------------------------------------------------------------------------------------------

    def _seek(self, observation: Observation) -> Command:
        """Turn until both receivers get a beam; if both already do, turn away first."""
        left, right = bool(observation.infrared.left), bool(observation.infrared.right)
        if self._since is None:
            self._since = observation.pose
            self._had_both = left and right
            self._side = -1.0 if self._had_both or right and not left else 1.0
        if self._had_both and not (left and right):
            self._had_both = False
            self._side = 1.0
        elif not self._had_both and left and right:
            self._enter(_Phase.EDGE, observation.pose, observation.pose.theta)
        return Command(0.0, self._side * SCAN_RATE, brushes_up=True)

    def _edge(self, observation: Observation) -> Command:
        """Take the middle of the angles at which both receive; both ends are noticed half an update late."""
        if not (observation.infrared.left and observation.infrared.right):
            half = 0.5 * wrap_angle(observation.pose.theta - self._heading)
            late = 0.5 * self._side * SCAN_RATE * observation.dt
            self._enter(_Phase.FACE, observation.pose, wrap_angle(self._heading + half - late))
        return Command(0.0, self._side * SCAN_RATE, brushes_up=True)

    def _face(self, observation: Observation) -> Command:
        rate = self._turn.rate(observation.pose, observation.dt)
        if not self._turn.is_done:
            return Command(0.0, rate, brushes_up=True)
        beams = observation.infrared.omni
        if beams & BUOYS == BUOYS:
            self._enter(_Phase.AHEAD, observation.pose, self._heading)
        elif beams & BUOYS:
            aside = ASIDE if beams & GREEN_BUOY else -ASIDE
            self._enter(_Phase.ASIDE, observation.pose, wrap_angle(self._heading + aside))
        else:
            self._enter(_Phase.SEEK, None)
        return Command(0.0, 0.0, brushes_up=True)

    def _turn_aside(self, observation: Observation) -> Command:
        rate = self._turn.rate(observation.pose, observation.dt)
        if self._turn.is_done:
            self._enter(_Phase.CROSS, observation.pose, self._heading)
        return Command(0.0, rate, brushes_up=True)

    # --- driving --------------------------------------------------------------------------------------------------

    def _cross(self, observation: Observation) -> Command:
        """Drive toward the axis, from either side of it."""
        if observation.infrared.omni & BUOYS == BUOYS or self._driven(observation.pose) > (
                self._context.robot.dock.buoy_range):
            self._enter(_Phase.SEEK, None)
        return self._straight(observation, NEAR_SPEED)

    def _ahead(self, observation: Observation) -> Command:
        """Keep to the direction of the dock; measure it again now and then, and when the dock is near."""
        is_near = bool(observation.infrared.omni & FORCE_FIELD)
        comes_near = is_near and not self._is_near
        self._is_near = is_near
        if observation.infrared.omni & BUOYS != BUOYS or comes_near or not is_near and (
                self._driven(observation.pose) > AGAIN):
            self._enter(_Phase.SEEK, None)
        return self._straight(observation, NEAR_SPEED if is_near else FAR_SPEED)

    def _straight(self, observation: Observation, speed: float) -> Command:
        self._pressed = self._pressed + observation.dt if any(observation.bumper) else 0.0
        if self._pressed > PRESSING:
            self._pressed = 0.0
            self._retreats += 1
            self._enter(_Phase.RETREAT, observation.pose)
        return Command(speed, STEER * wrap_angle(self._heading - observation.pose.theta), brushes_up=True)

    def _retreat(self, observation: Observation) -> Command:
        self._pressed += observation.dt
        if self._driven(observation.pose) > RETREAT or self._pressed > 2.0 * RETREAT / NEAR_SPEED:
            self._pressed = 0.0
            self._enter(_Phase.SEEK, None)
        return Command(-NEAR_SPEED, 0.0, brushes_up=True)
