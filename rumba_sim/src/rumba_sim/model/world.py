"""The world: a floor plan, its floor, and the robots on it, advanced tick by tick."""

import hashlib
import math
from typing import Dict, List, Optional

import numpy as np

from rumba_sim.model import kernel, robot
from rumba_sim.model.compiled import fast
from rumba_sim.model.constants import constants
from rumba_sim.model.errors import ConfigError, MapError, WorldError
from rumba_sim.model.floor import Floor
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot import Infrared, Robot, Start
from rumba_sim.model.robot_config import RobotConfig

NOISE_TICKS = 256  # so many ticks of wheel noise are drawn at once
ON_THEIR_OWN: Array = np.zeros((0, 4))  # what leads robots that drive themselves
FLOOR, WHEELS, LASER = 0, 1, 2  # what a random generator is for


class World:
    """Robots on a floor. The same plan, configuration, seed and calls give the same world, bit for bit.

    Each robot draws from generators of its own, so what one does changes nothing for another.

    Attributes:
        plan: the floor plan.
        step_rate: ticks in a second [Hz].
        seed: of all that is random.
        floor: what is clean.
        robots: by name, in the order in which they came.
        tick: how many ticks have passed since the beginning or the last reset.
    """

    def __init__(self, plan: FloorPlan, config: Optional[RobotConfig] = None, step_rate: float = 50,
                 seed: int = 0) -> None:
        """A world without robots.

        Raises:
            MapError: a robot does not fit at the dock or at the start of the plan, or the cells are too large for it.
        """
        self.plan = plan
        self.step_rate = step_rate
        self.seed = seed
        self._config = config or RobotConfig()
        self._constants = constants(self._config, plan, step_rate)
        self.start = self._checked_start()
        self.robots: Dict[str, Robot] = {}
        self._states: Array = np.zeros(0, kernel.ROBOT)
        self._noise: Array = np.zeros((0, NOISE_TICKS, 2))
        self._wheels: List[np.random.Generator] = []
        self._lasers: List[np.random.Generator] = []
        self._spawned = 0
        self._fan = _fan(self._config.laser.beams)
        self._begin()

    def _begin(self) -> None:
        self.tick = 0
        self.floor = Floor(self.plan, self._config, self.start, self._generator(FLOOR, 0))

    def _checked_start(self) -> Pose:
        """Where the first robot begins: the plan's start, else the dock, else where there is most room."""
        radius = float(self._constants[0]['reach'])
        for what, pose in (('dock', self.plan.dock), ('start', self.plan.start)):
            if pose is not None:
                self.plan.check_place(pose, radius, what)
        start = self.plan.start or self.plan.dock or self.plan.most_open_pose()
        self.plan.check_place(start, radius, 'start')
        return start

    def _generator(self, purpose: int, number: int) -> np.random.Generator:
        return np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(purpose, number)))

    # --- time -----------------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Seconds since the beginning or the last reset."""
        return self.tick / self.step_rate

    def step(self, ticks: int = 1) -> None:
        """Let so many ticks pass."""
        while ticks > 0:
            now = min(ticks, NOISE_TICKS - self.tick % NOISE_TICKS)
            self._advance(now, ON_THEIR_OWN)
            ticks -= now

    def _advance(self, ticks: int, led: Array) -> None:
        """Let ticks pass for which one draw of noise lasts; `led` as of `kernel.advance`."""
        if self.tick % NOISE_TICKS == 0:
            for row, generator in zip(self._noise, self._wheels):
                generator.standard_normal(out=row)
        fast.advance(self._states, self._constants, self.plan.clearance, self.floor.cells, self.floor.dirt,
                     self.floor.tally, self._noise, led, self.tick, ticks)
        self.tick += ticks

    def reset(self) -> None:
        """Begin again as at first: dirty floor, tick 0, every robot as it began."""
        before = list(self.robots.values())
        for member in before:
            self.kill(member.name)
        self._spawned = 0
        self._begin()
        for member in before:
            try:
                self.spawn(member.name, *member.start)
            except WorldError:  # it began where one that came before it had been
                self.spawn(member.name, None, *member.start[1:])

    # --- robots ---------------------------------------------------------------------------------------------------

    @property
    def config(self) -> RobotConfig:
        """What the robots are like; may be set anew while they drive, their size apart (else ConfigError)."""
        return self._config

    @config.setter
    def config(self, config: RobotConfig) -> None:
        if config.drive.radius != self._config.drive.radius:
            raise ConfigError(f'drive/radius is {config.drive.radius:g}: must stay {self._config.drive.radius:g} [m]')
        self._constants = constants(config, self.plan, self.step_rate)
        self._config = config
        self._fan = _fan(config.laser.beams)
        for member in self.robots.values():
            member.config = config

    def spawn(self, name: str, pose: Optional[Pose] = None, state_of_charge: float = 1.0,
              brushes_up: bool = False) -> Robot:
        """Add a robot.

        Args:
            name: by which it is known; not taken.
            pose: where it stands [m, rad], map frame; None: the start, or the free place nearest to it.
            state_of_charge: of its battery [0..1].
            brushes_up: whether its brushes are lifted.

        Raises:
            WorldError: the name is taken, the place is not free, or the state of charge is out of range.
        """
        if name in self.robots:
            raise WorldError(f'{name!r} is taken: robots are {", ".join(self.robots)}')
        if not 0.0 <= state_of_charge <= 1.0:
            raise WorldError(f'state of charge is {state_of_charge}: must be 0 to 1')
        start = Start(self._free_start() if pose is None else self._checked(pose, None), state_of_charge, brushes_up)
        number = self._spawned
        self._spawned += 1
        wheels, laser = self._generator(WHEELS, number), self._generator(LASER, number)
        state = np.zeros(1, kernel.ROBOT)
        scales = wheels.normal(0.0, self._config.odometry.scale_error, 2)
        robot.begin(state[0], start, self._config.battery.capacity, scales)
        self._wheels.append(wheels)
        self._lasers.append(laser)
        self._noise = np.concatenate([self._noise, wheels.standard_normal((1, NOISE_TICKS, 2))])
        self.robots[name] = Robot(name, start, self._config, state[0])
        self._take(np.concatenate([self._states, state]))
        return self.robots[name]

    def kill(self, name: str) -> None:
        """Take a robot out of the world.

        Raises:
            WorldError: there is none of that name.
        """
        index = self._index(name)
        del self.robots[name], self._wheels[index], self._lasers[index]
        self._noise = np.delete(self._noise, index, axis=0)
        self._take(np.delete(self._states, index))

    def teleport(self, name: str, pose: Pose) -> None:
        """Put a robot elsewhere [m, rad], map frame, at rest; its odometry does not notice.

        Raises:
            WorldError: there is none of that name, or the place is not free.
        """
        index = self._index(name)
        robot.put(self._states[index], self._checked(pose, index))
        self._take(self._states)

    def _take(self, states: Array) -> None:
        """Make these the states, after robots came, went or were moved: any two may be close now."""
        states['alone_until'] = 0
        self._states = states
        for member, state in zip(self.robots.values(), states):
            member.state = state

    def _index(self, name: str) -> int:
        if name not in self.robots:
            raise WorldError(f'there is no robot {name!r}: robots are {", ".join(self.robots) or "none"}')
        return list(self.robots).index(name)

    def _checked(self, pose: Pose, index: Optional[int]) -> Pose:
        """The pose with its heading wrapped, if the robot of this index (None: a new one) can stand there."""
        if not all(map(math.isfinite, pose)):
            raise WorldError(f'pose ({pose.x}, {pose.y}, {pose.theta}): must be finite numbers')
        try:
            self.plan.check_place(pose, float(self._constants[0]['reach']), 'pose')
        except MapError as error:
            raise WorldError(str(error)) from None
        for number, (name, other) in enumerate(self.robots.items()):
            gap = math.hypot(other.pose.x - pose.x, other.pose.y - pose.y) - 2.0 * self._config.drive.radius
            if number != index and gap < 0.0:
                raise WorldError(f'({pose.x:.2f}, {pose.y:.2f}) m: {name!r} stands there')
        return Pose(pose.x, pose.y, wrap_angle(pose.theta))

    def _free_start(self) -> Pose:
        """The start, or the free place nearest to it, on a grid of two robots' width."""
        step = 2.5 * self._config.drive.radius
        bounds = self.plan.bounds
        size = math.ceil(max(bounds.right - bounds.left, bounds.top - bounds.bottom) / step)
        for ring in range(size + 1):
            for row in range(-ring, ring + 1):
                for column in range(-ring, ring + 1):
                    if max(abs(row), abs(column)) == ring:
                        try:
                            return self._checked(Pose(self.start.x + column * step, self.start.y + row * step,
                                                      self.start.theta), None)
                        except WorldError:
                            continue
        raise WorldError(f'{self.plan.name}: no room for another robot')

    # --- sensors --------------------------------------------------------------------------------------------------

    def scan(self, name: str) -> Array:
        """What the laser of a robot sees: float64 (beams) [m], counter-clockwise from straight back.

        Nothing in range is +inf, something nearer than range_min -inf (REP 117).
        """
        index = self._index(name)
        ranges = np.empty(len(self._fan))
        fast.scan(self._states, index, self._constants[0], self.plan.skips, self.floor.cells, self._fan,
                  self._lasers[index].standard_normal(len(self._fan)), ranges)
        return ranges

    def infrared(self, name: str) -> Infrared:
        """What the receivers of a robot get from the dock."""
        return Infrared(*fast.infrared(self._states[self._index(name)], self._constants[0], self.plan.skips,
                                       self.floor.cells))

    def cliffs(self, name: str) -> List[bool]:
        """Whether there is no floor under the left, front left, front right and right sensor of a robot."""
        place, config = self.robots[name].pose, self._config.cliff
        angles = (config.outer_angle, config.inner_angle, -config.inner_angle, -config.outer_angle)
        return [bool(kernel.cell_bits(self._constants[0], self.floor.cells,
                                      place.x + config.distance * math.cos(place.theta + angle),
                                      place.y + config.distance * math.sin(place.theta + angle)) & kernel.CLIFF)
                for angle in angles]

    def digest(self) -> str:
        """SHA-256 of all that changes: tick, robots, floor."""
        state = hashlib.sha256(f'{self.tick} {" ".join(self.robots)}'.encode())
        fields = (self._states[name] for name in self._states.dtype.names or ())  # the bytes between them hold anything
        for array in (*fields, self._noise, self.floor.cells, self.floor.dirt, self.floor.tally):
            state.update(np.ascontiguousarray(array).tobytes())
        return state.hexdigest()


def _fan(beams: int) -> Array:
    """Directions of the laser's beams in the frame of the robot: float64 (beams, 2)."""
    angles = np.arange(beams) * (2.0 * math.pi / beams) - math.pi
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)
