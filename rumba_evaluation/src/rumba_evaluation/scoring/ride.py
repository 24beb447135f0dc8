"""A robot drives along a path that somebody planned: with the limits of a real one, or exactly as it was drawn."""

import abc
import math
from typing import List, Sequence

import numpy as np

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.cleaning_config import CleaningConfig, attainable
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, STEP_RATE, act
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Route
from rumba_evaluation.scoring.drawn_path import DrawnPath, PathError, check_on_map
from rumba_evaluation.scoring.measures import Observer
from rumba_evaluation.scoring.meter import Meter
from rumba_evaluation.scoring.timetable import beyond_robots, timetable
from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.robot import FIRST, Robot, put
from rumba_sim.model.simulation.world import World

PATIENCE = 10.0  # [s] without progress along the path: something is in the way; our choice, longer than any turn
PROGRESS = 0.01  # [m]: more than a robot at rest seems to move
AT_END = 'the end of the path is reached'
SEED = 1  # of the dirt, and of wheels whose errors matter to nobody, since the pose is known


class Ride(abc.ABC):
    """A drive along a path, from its first pose on, with the brushes down and a full battery.

    Attributes:
        world: the robot and the true state of the floor.
        robot: the robot.
        observer: what was measured so far.
        meter: energy and charge so far.
        ideal_time: T [s], for one brush to sweep the reachable floor at the cleaning speed, without any overlap.
        curve: time [s] until 1 %, 2 %, ... of the reachable floor were swept.
        outcome: how it ended; UNKNOWN until then.
        message: one line for a person.
    """

    outcome = Outcome.UNKNOWN
    message = ''

    def __init__(self, plan: FloorPlan, path: DrawnPath, config: RobotConfig = RobotConfig(),
                 speed: float = CleaningConfig().speed, obstacles: Sequence[Obstacle] = ()) -> None:
        """Put a robot at the first pose.

        Args:
            plan: the floor plan.
            path: the path.
            config: of the robot.
            speed: at which it drives, if nothing else says [m/s].
            obstacles: that the map does not show.

        Raises:
            PathError: a pose lies outside the map or in a wall.
            RumbaError: no robot fits there, or an obstacle is wrong.
        """
        check_on_map(path, plan)
        self.path = path
        self.speed = speed
        self.world = World(plan, config, STEP_RATE, SEED, obstacles)
        self.robot = self._spawned()
        self.ideal_time = self.world.floor.reachable_area / (
            config.brush.width * attainable(CleaningConfig(), config).speed)
        self.curve: List[float] = []
        self.observer = Observer(self.world, self.robot)
        self.meter = Meter(self.world, self.robot)

    @abc.abstractmethod
    def _spawned(self) -> Robot:
        """The robot, put where it begins."""

    @abc.abstractmethod
    def _advance(self) -> None:
        """Drive for one control step; sets the outcome at the end."""

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self.world.time

    def run(self, bound: float = 12.0) -> None:
        """Drive to the end, or until the time is `bound` times T."""
        while self.outcome is Outcome.UNKNOWN:
            if self.time >= bound * self.ideal_time:
                self._end(Outcome.TIMED_OUT, f'stopped after {bound:g} T')
                break
            self._advance()
            self.meter.update()
            coverage = self.world.floor.coverage
            while len(self.curve) < 100 and coverage >= (len(self.curve) + 1) / 100:
                self.curve.append(self.time)
            if self.outcome is Outcome.UNKNOWN and self.robot.has_fallen:
                self._end(Outcome.FALLEN, 'fell over a cliff')
            if self.outcome is Outcome.UNKNOWN and float(self.robot.state['charge']) <= 0.0:
                self._end(Outcome.BATTERY_EMPTY, 'the battery is empty (--drain 0 drives on)')

    def _end(self, outcome: Outcome, what: str) -> None:
        pose = self.robot.pose
        self.outcome, self.message = outcome, f'{what} at ({pose.x:.2f}, {pose.y:.2f}) m'
        if self.world.floor.cleaned_area == 0.0:
            self.message += '; it swept nothing that a robot can reach from the start of the map'


class Driven(Ride):
    """Drives as a real robot would: with its limits, along walls, and into them, where it gives up; by a known pose."""

    def _spawned(self) -> Robot:
        try:
            robot = self.world.spawn(FIRST, self.path.start)
        except WorldError as error:
            raise PathError(f'{self.path.at(0)}: no robot can begin there: {error}; --as-drawn asks for no room'
                            ) from None
        self._behaviour = self._follow(robot)
        self._dt = 0.0  # [s] since the last observation
        return robot

    def _follow(self, robot: Robot) -> Behaviour:
        """What leads the robot along the path."""
        return FollowPath(self.path, robot, self.speed)

    def _advance(self) -> None:
        act(self._behaviour, self.world, FIRST, self._dt)
        self._dt = CONTROL_DT
        self.observer.advance(CONTROL_TICKS)
        if self._behaviour.status is not Status.RUNNING:
            self._end(self._behaviour.outcome, self._behaviour.message)


class AsDrawn(Ride):
    """Is wherever the path says, through walls if need be."""

    def _spawned(self) -> Robot:
        drive = self.world.config.drive
        self._poses = timetable(self.path, self.speed, drive.max_turn_rate, STEP_RATE)
        robot = self.world.spawn(FIRST)
        put(robot.state, Pose(*self._poses[0].tolist()))
        self._next = 1
        return robot

    def _advance(self) -> None:
        for pose in self._poses[self._next:self._next + CONTROL_TICKS]:
            self._lead(pose)
        self._next += CONTROL_TICKS
        if self._next >= len(self._poses):
            self.robot.brushes_up = True  # what is left of the last stride is swept
            self._lead(self._poses[-1])
            beyond = beyond_robots(self._poses, STEP_RATE, self.world.config.drive.max_speed)
            self._end(Outcome.SUCCEEDED, AT_END + beyond)

    def _lead(self, pose: Array) -> None:
        self.world.lead(np.array([[pose[0], pose[1], wrap_angle(pose[2]), 1.0]]))
        self.observer.look()


class FollowPath(Behaviour):
    """Follows a path with the brushes down, and gives up if something is in the way."""

    def __init__(self, path: DrawnPath, robot: Robot, speed: float) -> None:
        """Have a robot follow a path at a speed [m/s]."""
        self._route = Route(path.points, np.full(len(path.points) - 1, speed))
        self._drive = robot.config.drive

    def initialise(self) -> None:
        """Begin at the beginning."""
        self._follower = Follower(self._route, self._drive)
        self._left = math.inf  # [m] least distance that was left
        self._waited = 0.0  # [s] since then

    def update(self, observation: Observation) -> Command:
        """Go on along the path."""
        v, w = self._follower.velocity(observation.pose, observation.dt)
        if self._follower.is_done:
            return self.succeed(AT_END)
        if self._follower.remaining < self._left - PROGRESS:
            self._left, self._waited = self._follower.remaining, 0.0
        else:
            self._waited += observation.dt
        if self._waited > PATIENCE or self._follower.is_lost:
            return self.fail('something kept the robot from the path', Outcome.BLOCKED)
        return Command(v, w)
