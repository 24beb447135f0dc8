"""The task of the environment without Gymnasium: many robots, each on a floor of its own, that are to clean it.

    task = CoverageTask(rooms(0, 100), 1024)
    task.reset(range(1024))
    seen, outcome = task.step(np.ones((1024, 3)))

Each robot has a random generator of its own: what it meets depends on its seed alone, and not on the others.
"""

from typing import Any, Dict, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, STEP_RATE
from rumba_evaluation.learning.rooms import room
from rumba_evaluation.learning.task_config import DISCRETE, TaskConfig
from rumba_evaluation.trials import starts
from rumba_evaluation.trials.cases import ANYWHERE
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import CommandError, ConfigError, WorldError, quoted
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.sweeping.brush import BEND, STRIDE
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.worlds import Worlds

# The discrete actions: ahead, ahead to the left, ahead to the right, turn left, turn right, back.
MOVES = np.array([(1.0, 0.0), (1.0, 0.5), (1.0, -0.5), (0.0, 0.7), (0.0, -0.7), (-0.5, 0.0)])
DOCK_BITS = np.array([1, 4, 8], np.uint8)  # force field, green buoy, red buoy of rumba_msg/DockStatus
MOST_BUMPS = (CONTROL_TICKS + 1) // 2  # in a step: the bumper opens in between
LARGEST_SEED = 2 ** 31

Seen = Dict[str, Array]


class Outcome(NamedTuple):
    """What a step led to, robot by robot; each is an array of (robots)."""

    reward: Array  # float64
    terminated: Array  # bool, the target is reached, the robot has fallen, or its battery is empty
    truncated: Array  # bool, the time is up
    coverage: Array  # float64 [0..1]
    succeeded: Array  # bool, the target is reached
    parts: Dict[str, Array]  # float64 each, what the reward is the sum of, by the names of `Reward`


class CoverageTask:
    """Robots that are to sweep floors.

    Attributes:
        config: settings of the task.
        ended: bool (robots), whose episodes have ended, so that they act only after a reset.
    """

    def __init__(self, floors: Sequence[Union[FloorPlan, int]], robots: int = 1, config: TaskConfig = TaskConfig(),
                 robot: RobotConfig = RobotConfig(), threads: int = 1) -> None:
        """Prepare; `reset` makes the worlds.

        Args:
            floors: each episode takes place on one of them. A number is that of a room, which is made at the first
                episode there.
            robots: how many, each in a world of its own.
            config: settings of the task.
            robot: what a robot is like; the task says how many beams its field of view has, and varies it.
            threads: how many cores to use.

        Raises:
            ConfigError: there is no floor or no robot.
        """
        if not floors:
            raise ConfigError('there is no floor to clean: give at least one')
        if robots < 1:
            raise ConfigError(f'robots is {robots}: must be at least 1')
        self.config = config
        self.ended: Array = np.zeros(robots, np.bool_)
        self._worlds: Optional[Worlds] = None
        self._floors = list(floors)
        self._robot = updated(robot, {'laser': _laser(robot.laser, config.beams)}, 'the task')
        self._threads = threads
        self._generators = [np.random.default_rng() for _ in range(robots)]
        self._steps = np.zeros(robots, np.int64)
        self._full_step = robot.brush.width * config.speed * CONTROL_DT  # [m^2]

    @property
    def worlds(self) -> Worlds:
        """The worlds in which the robots are.

        Raises:
            WorldError: there was no reset of all robots yet.
        """
        if self._worlds is None:
            raise WorldError('no episode has begun: call reset first')
        return self._worlds

    @property
    def highest_reward(self) -> float:
        """More than this is no step worth: what the brush can sweep in it at most, and the target is reached."""
        brush, drive, seconds = self._robot.brush, self._robot.drive, CONTROL_DT * self.config.hold
        # It sweeps in strides: one may have begun before.
        straight = brush.width * (drive.max_speed * seconds + STRIDE)
        turned = brush.width ** 2 / 4.0 * (drive.max_turn_rate * seconds + BEND)
        return self.config.reward.swept * (straight + turned) / self._full_step + self.config.reward.finish

    @property
    def lowest_reward(self) -> float:
        """Less than this is no step worth."""
        reward = self.config.reward
        return -(reward.time * self.config.hold + reward.bump * MOST_BUMPS * self.config.hold + reward.fall)

    # --- episodes -------------------------------------------------------------------------------------------------

    def reset(self, seeds: Sequence[Optional[int]], which: Optional[Array] = None) -> Seen:
        """Begin an episode with each robot, or with some of them.

        Args:
            seeds: of all that is random from now on, one for each of the robots; None goes on with what was seeded.
            which: int64 (any), the numbers of the robots; None for all.

        Returns:
            What these robots see, as for `look`.
        """
        order = np.arange(len(self._steps)) if which is None else np.asarray(which, np.int64)
        for index, seed in zip(order.tolist(), seeds):
            if seed is not None:
                self._generators[index] = np.random.default_rng(seed)
        begun = [self._world(self._generators[index]) for index in order.tolist()]
        if which is None:
            self._worlds = Worlds(begun, self._threads)
        else:
            for index, world in zip(order.tolist(), begun):
                self.worlds[index] = world
        self._steps[order], self.ended[order] = 0, False
        return self.look(order)

    def _world(self, generator: np.random.Generator) -> World:
        """The world of an episode."""
        floor = self._floors[generator.integers(len(self._floors))]
        plan = floor if isinstance(floor, FloorPlan) else room(int(floor))
        config, charge = self._varied(generator)
        world = World(plan, config, STEP_RATE, int(generator.integers(LARGEST_SEED)))
        pose = None
        if self.config.start == ANYWHERE:
            pose = starts.anywhere(world.reachable_plan, config, world.start, 1, generator)[0]
        world.spawn(FIRST, pose, charge)
        return world

    def _varied(self, generator: np.random.Generator) -> Tuple[RobotConfig, float]:
        """What the robot of an episode is like, and its state of charge."""
        variation, robot = self.config.variation, self._robot

        def around(value: float, share: float) -> float:
            return value * (1.0 + share * float(generator.uniform(-1.0, 1.0)))

        def below(value: float, share: float) -> float:
            return value * (1.0 - share * float(generator.random()))
        error = around(1.0, variation.odometry)
        return updated(robot, {
            'drive': {'acceleration': around(robot.drive.acceleration, variation.acceleration)},
            'odometry': {'floor_traction': below(robot.odometry.floor_traction, variation.traction),
                         'scale_error': error * robot.odometry.scale_error, 'noise': error * robot.odometry.noise},
            'laser': {'noise': around(robot.laser.noise, variation.laser)},
            'battery': {'capacity': below(robot.battery.capacity, variation.capacity)},
        }, 'a varied robot'), below(1.0, variation.charge)

    # --- steps ----------------------------------------------------------------------------------------------------

    def step(self, actions: Array, which: Optional[Array] = None) -> Outcome:
        """Let each robot, or some of them, act for a step.

        Args:
            actions: of all robots: int64 (robots), numbers of MOVES, or float64 (robots, 3) [-1..1] with the forward
                velocity [`speed`], the angular velocity [`turn_rate`], and the brush, which is down from 0 on.
            which: bool (robots), which of them act; None for all. The time of the others stands still.

        Raises:
            CommandError: an action has another shape, is no number of MOVES or no finite number.
            WorldError: no episode has begun, or that of a robot which acts has ended.
        """
        worlds, reward = self.worlds, self.config.reward
        acts = np.ones(len(worlds), np.bool_) if which is None else which
        self._check(actions, acts)
        swept, bumps = worlds.cleaned_area, worlds.robots['bumps'].copy()
        if self.config.actions == DISCRETE:
            moves, up = MOVES[actions], np.zeros(len(worlds), np.bool_)
        else:
            moves, up = np.clip(actions[:, :2], -1.0, 1.0), actions[:, 2] < 0.0
        for _ in range(self.config.hold):  # a command lapses after half a second
            worlds.command(moves[:, 0] * self.config.speed, moves[:, 1] * self.config.turn_rate, up)
            worlds.step(CONTROL_TICKS * acts)
        self._steps += acts
        coverage, robots = worlds.coverage, worlds.robots
        fallen, finished = robots['fallen'] > 0, coverage >= self.config.target
        parts = {'swept': reward.swept / self._full_step * (worlds.cleaned_area - swept),
                 'time': np.full(len(worlds), -reward.time * self.config.hold),
                 'bump': -reward.bump * (robots['bumps'] - bumps),
                 'fall': -reward.fall * fallen, 'finish': reward.finish * finished}
        parts = {name: np.where(acts, part, 0.0) for name, part in parts.items()}
        terminated = fallen | finished | (robots['charge'] <= 0.0)
        truncated = self._steps >= self.config.most_steps
        self.ended |= terminated | truncated
        return Outcome(sum(parts.values()), terminated, truncated, coverage, finished, parts)

    def _check(self, actions: Array, acts: Array) -> None:
        """Refuse actions that robots cannot take."""
        is_discrete = self.config.actions == DISCRETE
        shape = (len(acts),) if is_discrete else (len(acts), 3)
        if np.shape(actions) != shape:
            raise CommandError(f'the shape of actions is {np.shape(actions)}: must be {shape}, for {len(acts)} robots')
        if is_discrete and not np.issubdtype(actions.dtype, np.integer):
            raise CommandError(f'actions are of type {actions.dtype}: must be whole numbers')
        if is_discrete:
            wrong = actions[(actions < 0) | (actions >= len(MOVES))]
            if len(wrong):
                raise CommandError(f'action {wrong[0]}: must be 0 to {len(MOVES) - 1}')
        elif not np.issubdtype(actions.dtype, np.number):
            raise CommandError(f'actions are of type {actions.dtype}: must be numbers')
        elif not np.isfinite(actions).all():
            raise CommandError(f'action {quoted(actions[~np.isfinite(actions)][0])}: is not a finite number')
        ended = np.flatnonzero(self.ended & acts)
        if len(ended):
            raise WorldError(f'the episode of robot {ended[0]} has ended: call reset before it acts again')

    # --- observations ---------------------------------------------------------------------------------------------

    def look(self, which: Optional[Array] = None) -> Seen:
        """What the robots see, or some of them, by name: see `spaces.observations`.

        The noise of the ranges is another one each time.
        """
        worlds, laser = self.worlds, self._robot.laser
        robots = worlds.robots if which is None else worlds.robots[which]
        seen: Dict[str, Array] = {}
        ranges = worlds.scan(which)
        ranges /= laser.range_max
        seen['ranges'] = np.clip(ranges, 0.0, 1.0, out=ranges).astype(np.float32)
        seen['bumper'] = (robots['bumper'][:, np.newaxis] & np.array([1, 2], np.uint8) > 0).astype(np.float32)
        seen['cliff'] = worlds.cliffs(which).astype(np.float32)
        constants = worlds.constants if which is None else worlds.constants[which]
        seen['battery'] = (robots['charge'] / constants['capacity'])[:, np.newaxis].astype(np.float32)
        beams = worlds.infrared(which)[:, :, np.newaxis] & DOCK_BITS > 0
        seen['dock'] = beams.reshape(len(robots), beams.shape[1] * beams.shape[2]).astype(np.float32)
        theta = robots['odom_theta']
        seen['odometry'] = np.stack([robots['odom_x'], robots['odom_y'], np.cos(theta), np.sin(theta),
                                     robots['odom_v'], robots['odom_w']], axis=1).astype(np.float32)
        if self.config.maps:
            maps = worlds.surroundings(self.config.map_size, self.config.pitches, which)
            seen['maps'] = maps.reshape(len(robots), 2 * self.config.maps, *maps.shape[-2:])
        return seen


def _laser(laser: LaserConfig, beams: int) -> Dict[str, Any]:
    """Settings of a laser that has so many beams in its field of view, and tells too near from nothing there."""
    per_turn = round(laser.per_turn * beams / laser.beams)
    return {'beams': beams, 'per_turn': max(per_turn, beams) if per_turn else 0, 'nothing': 'rep117'}
