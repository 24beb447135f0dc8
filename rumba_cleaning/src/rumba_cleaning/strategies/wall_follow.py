"""wall_follow: along the walls, by the bumper alone: steer toward the wall, touch it, turn away a little."""

import enum
import math
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.behaviours import recoil
from rumba_cleaning.behaviours.follower import turn_rate
from rumba_cleaning.belief.context import Context
from rumba_cleaning.strategies import strategy
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle

# The figures below are our choice, tried on the maps of rumba_sim: the robot gets once around each of them.
LEAN = 1.5  # [1/m] curvature of the path back to the wall
CLOSE = 0.25  # [m] radius of the path around a corner if the wall is lost ...
CAREFUL = 0.15  # [m/s] there: a wheel must not swing over a cliff before the robot can stop
LOST = 0.6  # [m] ... after this distance without a touch: at LEAN it would have met a straight wall
GONE = 2.0  # [m] without a touch: it looks for another wall; once around a circle of CLOSE is 1.6 m
OFF_SIDE, OFF_FRONT = 0.35, 0.9  # [rad] to turn away from a wall at the side, and ahead
SOON = 0.15  # [m] after a touch: if the next one comes so soon, the robot must turn farther
HEADING = 0.05  # [rad] so near its heading a turn is done
ROUND = 0.3  # [m] from the first touch, less than twice the robot's radius, after ...
LEAST_ROUND = 3.0  # [m] ... at least this distance: the round is done


class _Phase(enum.Enum):
    AHEAD = 'drive straight ahead until something is in the way'
    LEAN = 'drive along the wall, and toward it'
    BACK = 'back off from it'
    TURN = 'turn away from it'


@strategy('wall_follow')
class WallFollow(Behaviour):
    """Drives once around, with the wall to the right."""

    def __init__(self, context: Context) -> None:
        """Take the speed of a context."""
        self._drive = context.robot.drive
        self._speed = context.config.speed

    def initialise(self) -> None:
        """Begin by looking for a wall."""
        self._phase = _Phase.AHEAD
        self._first: Optional[Pose] = None  # touch
        self._last: Optional[Pose] = None  # observation
        self._driven = 0.0  # [m] since the first touch
        self._leaning = math.inf  # [m] since the last
        self._off = 0.0  # [rad] that it turned then
        self._heading = 0.0  # [rad] to turn to
        self._back = 0.0  # [s] to drive back

    def update(self, observation: Observation) -> Command:
        """Drive ahead, or along the wall, until a touch; then back off and turn."""
        pose, last = observation.pose, self._last or observation.pose
        self._last = pose
        step = hypot(pose.x - last.x, pose.y - last.y)
        self._driven += step
        if self._phase in (_Phase.AHEAD, _Phase.LEAN) and any(observation.contact):
            return self._touch(observation)
        if self._phase is _Phase.BACK:
            self._back -= observation.dt
            if self._back > 0.0:
                return Command(-recoil.SPEED, 0.0)
            self._phase = _Phase.TURN
        if self._phase is _Phase.TURN:
            angle = wrap_angle(self._heading - pose.theta)
            if abs(angle) > HEADING:
                return Command(0.0, turn_rate(angle, observation.dt, self._drive))
            if any(observation.cliffs):
                self._heading = wrap_angle(self._heading + OFF_SIDE)
                return Command(0.0, 0.0)
            self._phase, self._leaning = _Phase.LEAN, 0.0
        if self._phase is _Phase.AHEAD:
            return Command(self._speed, 0.0)
        return self._lean(step)

    def _touch(self, observation: Observation) -> Command:
        pose = observation.pose
        if self._first is None:
            self._first, self._driven = pose, 0.0
        elif self._driven > LEAST_ROUND and hypot(pose.x - self._first.x, pose.y - self._first.y) < ROUND:
            return self.succeed(f'once around, {self._driven:.1f} m')
        left, _ = observation.contact
        self._off = (self._off if self._leaning < SOON else 0.0) + (OFF_FRONT if left else OFF_SIDE)
        self._phase, self._back = _Phase.BACK, recoil.time_back(observation)
        self._heading = wrap_angle(pose.theta + min(self._off, math.pi))
        return Command(-recoil.SPEED, 0.0)

    def _lean(self, step: float) -> Command:
        """Steer to the right; sharply if the wall ends."""
        self._leaning += step
        if self._leaning > GONE:
            self._phase = _Phase.AHEAD
        is_lost = self._leaning > LOST
        curvature = 1.0 / CLOSE if is_lost else LEAN
        outer = 1.0 + 0.5 * self._drive.wheel_base * curvature  # times faster than the middle the outer wheel is
        v = min(self._speed / outer, CAREFUL if is_lost else math.inf, self._drive.max_turn_rate / curvature)
        return Command(v, -v * curvature)
