"""One trial in process: a world, its robots, and a mission for each, advanced at the control rate.

    trial = Trial(map_file.load('studio.yaml'), 'boustrophedon', seed=3)
    while not trial.is_over:
        trial.step()
    print(trial.result())
"""

from concurrent.futures import Executor
from typing import Callable, Dict, List, Optional, Sequence

import numpy as np

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context, Seed, own_seed
from rumba_cleaning.belief.mates import Mates
from rumba_cleaning.cleaning_config import CleaningConfig, attainable
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, STEP_RATE, act
from rumba_cleaning.executors import BeforeNextStep
from rumba_cleaning.mission.duration import longest
from rumba_cleaning.mission.mapless import MaplessMission
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import StagedMission, State
from rumba_cleaning.mission.team import tell_mates
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.pose_source import DeadReckoning, Localised, Mapped, PoseSource, reckoned, seeing, truth
from rumba_evaluation.scoring.meter import Meter
from rumba_evaluation.trials import starts
from rumba_evaluation.trials.cases import ANYWHERE, LOCALISED, MAPLESS, ODOMETRY, SLAM, Conditions, Result, severity
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import TURN, Pose
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.laser_config import IDEAL
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.robot import nth_name
from rumba_sim.model.simulation.world import World


OWN_FRAME = (SLAM, MAPLESS)  # of each robot, where it says it is


class Trial:
    """Missions of one or more robots on a dirty floor; each robot cleans all of it.

    Attributes:
        world: the robots and the true state of the floor.
        contexts: what each robot knows, in the order of the world's robots.
        missions: the mission of each robot, in the same order.
        sources: by what each robot knows where it is, by its name.
        ideal_time: T [s], for one brush to sweep the reachable floor without any overlap, at the cleaning speed or, if
            it cannot drive at that, at its highest.
        curve: working time [s] until 1 %, 2 %, ... of the reachable floor were swept.
        advance: lets a number of ticks pass; replaced by those who look at each tick.
    """

    def __init__(self, plan: FloorPlan, strategy: str, conditions: Conditions = Conditions(), seed: int = 0,
                 robots: int = 1, obstacles: Sequence[Obstacle] = (), robot: RobotConfig = RobotConfig()) -> None:
        """Put charged robots on a floor plan.

        Args:
            plan: the floor plan, which the robots know.
            strategy: name of the cleaning strategy.
            conditions: of the trial; the obstacles are not read from the file that they name.
            seed: of everything that is random.
            robots: number of robots.
            obstacles: that are there from the start, and that the robots do not know.
            robot: what a robot is like, but for what the conditions say.

        Raises:
            RumbaError: the strategy is unknown, there is no space for so many robots, or an obstacle is wrong.
        """
        config = _config(robot, conditions)
        cleaning = attainable(CleaningConfig(laser=conditions.laser, margin=conditions.margin), config)
        self._conditions = conditions
        self.world = World(plan, config, STEP_RATE, seed, obstacles)
        poses: Sequence[Optional[Pose]] = [None] * robots
        if conditions.start == ANYWHERE:
            poses = starts.anywhere(
                self.world.reachable_plan, config, self.world.start, robots, np.random.default_rng(seed),
                lambda x, y: bool(self.world.obstacles.near(x, y, config.drive.radius)))
        for number, pose in enumerate(poses, 1):
            self.world.spawn(nth_name(number), pose, brushes_up=True)
        self.sources = {name: _source(plan, self.world, name, conditions, seed) for name in self.world.robots}
        self._planners = BeforeNextStep()
        self.contexts = [_context(plan, source, config, cleaning, own_seed(seed, name), self._planners,
                                  _mates(name, list(self.sources), conditions.pose))
                         for name, source in self.sources.items()]
        shown = Context(plan, config, cleaning) if conditions.pose in OWN_FRAME else self.contexts[0]
        self._time_limit = longest(shown)
        self.missions = [_mission(context, strategy, conditions.target) for context in self.contexts]
        self.ideal_time = self.world.floor.reachable_area / (config.brush.width * cleaning.speed)
        self.curve: List[float] = []
        self.advance: Callable[[int], None] = self.world.step
        self._meters = [Meter(self.world, robot) for robot in self.world.robots.values()]
        self._dt = 0.0  # [s] since the last observations
        self._steps = 0
        self._charging_steps = 0
        self.world.step()  # the contacts of the dock close in the first tick

    @property
    def working_time(self) -> float:
        """Time since the start [s] without the time in which all robots that still have a mission charge."""
        return (self._steps - self._charging_steps) * CONTROL_DT

    @property
    def is_over(self) -> bool:
        """Whether all missions have ended, or the bound or the time limit is reached."""
        bound = np.inf if self._conditions.pose == MAPLESS else self._conditions.bound
        return not self._running or self.working_time >= bound * self.ideal_time or self.world.time >= self._time_limit

    @property
    def _running(self) -> Dict[str, StagedMission]:
        """The missions that have not ended, by the name of the robot; a fall ends a mission."""
        return {name: mission for (name, robot), mission in zip(self.world.robots.items(), self.missions)
                if mission.status is Status.RUNNING and not robot.has_fallen}

    def step(self) -> None:
        """Each robot observes and gets a command; then time passes until the next observation."""
        self._planners.work()
        for name, mission in self._running.items():
            act(mission, self.world, name, self._dt, self.sources[name])
        tell_mates(dict(zip(self.world.robots, self.missions)))
        self._dt = CONTROL_DT
        if any(mission.state is State.CHARGING for mission in self.missions) and all(
                mission.state is State.CHARGING for mission in self._running.values()):
            self._charging_steps += 1
        self.advance(CONTROL_TICKS)
        self._steps += 1
        for meter in self._meters:
            meter.update()
        coverage = self.world.floor.coverage
        while len(self.curve) < 100 and coverage >= (len(self.curve) + 1) / 100:
            self.curve.append(self.working_time)

    def result(self) -> Result:
        """The result so far."""
        floor, meters = self.world.floor, self._meters
        robots = list(self.world.robots.values())
        start = robots[0].start.pose
        energy = sum(meter.energy for meter in meters)
        return Result(
            outcome=self._outcome(), message=self._message(),
            area=floor.reachable_area, ideal_time=self.ideal_time, coverage=floor.coverage, dirt_left=floor.dirt_left,
            time=self._steps * CONTROL_DT, charging_time=self._charging_steps * CONTROL_DT,
            charges=sum(mission.charges for mission in self.missions),
            distance=sum(robot.distance for robot in robots), turns=sum(meter.turned for meter in meters) / TURN,
            collisions=sum(robot.bumps for robot in robots), charge_used=sum(meter.charge for meter in meters),
            energy=energy, energy_per_area=energy / floor.cleaned_area if floor.cleaned_area > 0.0 else np.nan,
            docked=sum(robot.is_docked for robot in robots), penetrated=any(meter.penetrated for meter in meters),
            x=start.x, y=start.y, theta=start.theta, ticks=self.world.tick, digest=self.world.digest(),
            curve=tuple(self.curve))

    def _outcome(self) -> Outcome:
        running = self._running
        worst = max((Outcome.FALLEN if robot.has_fallen else Outcome.TIMED_OUT if name in running else mission.outcome
                     for (name, robot), mission in zip(self.world.robots.items(), self.missions)), key=severity)
        if worst is Outcome.SUCCEEDED and self._conditions.pose == MAPLESS and (
                self.world.floor.coverage < self._conditions.target):
            return Outcome.INCOMPLETE  # which the robot cannot know
        return worst

    def _message(self) -> str:
        messages = {name: f'fell over a cliff; {mission.message}' if robot.has_fallen else mission.message
                    for (name, robot), mission in zip(self.world.robots.items(), self.missions)}
        if len(messages) == 1:
            return next(iter(messages.values()))
        return '; '.join(f'{name}: {message}' for name, message in messages.items())


def _config(robot: RobotConfig, conditions: Conditions) -> RobotConfig:
    """What a robot is like under conditions; the ideal laser, their default, leaves the robot its own."""
    laser = {'model': conditions.laser_model} if conditions.laser_model != IDEAL else {}
    return updated(robot, {'battery': {'drain': conditions.drain}, 'laser': laser}, 'conditions')


def _mission(context: Context, strategy: str, target: float) -> StagedMission:
    """The mission of a robot: until a target is met, or for a time if it cannot know that."""
    return Mission(context, strategy, target) if context.has_map else MaplessMission(context, strategy)


def _mates(name: str, names: List[str], pose: str) -> Mates:
    """The mates of a robot; if each has a frame of its own, there are none."""
    return Mates() if pose in OWN_FRAME else Mates(name, names)


def _context(plan: FloorPlan, source: PoseSource, config: RobotConfig, cleaning: CleaningConfig, seed: Seed,
             executor: Executor, mates: Mates) -> Context:
    """What a robot knows at first: the floor plan, or only what it has mapped itself so far, or nothing."""
    if source is reckoned:
        return Context.without_map(config, cleaning, seed)
    if isinstance(source, Mapped):
        return Context(source.plan(), config, cleaning, seed, executor, source, mates)
    return Context(plan, config, cleaning, seed, executor, mates=mates)


def _source(plan: FloorPlan, world: World, name: str, conditions: Conditions, seed: int) -> PoseSource:
    """What tells a robot where it is, and what its laser sees, if it goes by that."""
    if conditions.pose == LOCALISED:
        return Localised(plan, world, name, own_seed(seed, name))
    if conditions.pose == SLAM:
        return Mapped(world, name, plan.dock)
    if conditions.pose == MAPLESS:
        return reckoned
    source: PoseSource = truth
    if conditions.pose == ODOMETRY:
        source = DeadReckoning()
    return seeing(source) if conditions.laser else source
