"""The world: a floor plan, the state of its floor, the robots and obstacles on it, advanced tick by tick."""

import dataclasses
import hashlib
import math
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

from rumba_sim.model.common.errors import ConfigError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.floors.constants import check_speed, constants
from rumba_sim.model.floors.floor import Floor
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.records import ROBOT
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation import robot, world_state
from rumba_sim.model.simulation.free_space import FreeSpace
from rumba_sim.model.simulation.noise import FLOOR, NOISE_TICKS, Noise, generator
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.obstacles import Obstacles, check_inside, kept_clear
from rumba_sim.model.simulation.robot import Infrared, Robot, Start
from rumba_sim.model.simulation.world_arrays import WorldArrays
from rumba_sim.model.simulation.world_state import Member, WorldState


class World:
    """Robots on a floor. The same plan, configuration, seed and calls give the same world, bit for bit.

    Each robot has random generators of its own, so that what one robot does changes nothing for another.

    Attributes:
        plan: the floor plan.
        terrain: the refined plan, on which robots drive.
        reachable_plan: the same, its safe clearance also that to obstacles which stood there from the start.
        step_rate: ticks per second [Hz].
        seed: seed of everything that is random.
        constants: array of the one record that the kernel reads (`constants.Constants`).
        start: pose of the first robot if none is given.
        floor: which cells are swept, and the dirt on them.
        noise: of the wheels and lasers of the robots.
        robots: robots by name, in the order in which they were added.
        obstacles: what else stands or moves there; `add_obstacle` and `remove_obstacle` change it.
        tick: number of ticks since the beginning or the last reset.
        fans: directions of the laser's beams in the frame of a robot, as for the kernel.
        version: grows whenever arrays of the world are replaced, or one of its constants changes.
    """

    def __init__(self, plan: FloorPlan, config: Optional[RobotConfig] = None, step_rate: float = 50,
                 seed: int = 0, obstacles: Sequence[Obstacle] = ()) -> None:
        """A world without robots.

        Args:
            plan: the floor plan.
            config: of all robots.
            step_rate: ticks per second [Hz].
            seed: of everything that is random.
            obstacles: that are there from the start; the floor beneath those that do not move is out of reach.

        Raises:
            ConfigError: a robot could move by more than its radius in one tick.
            MapError: a robot does not fit at the dock or at the start of the plan, or the cells are too large for it.
            WorldError: an obstacle cannot be added, or stands at the dock or at the start.
        """
        self.plan = plan
        self.step_rate = step_rate
        self.seed = seed
        self._config = config or RobotConfig()
        check_speed(self._config, step_rate)
        self.terrain = plan.refined()
        self.constants = constants(self._config, self.terrain, step_rate)
        self.robots: Dict[str, Robot] = {}
        self._states: Array = np.zeros(0, ROBOT)
        self.version = 0
        self.obstacles = Obstacles(step_rate, seed, self._config.drive.radius)
        for obstacle in obstacles:
            self.add_obstacle(obstacle)
        self._at_start = tuple(obstacles)
        self.reachable_plan = kept_clear(self.terrain, self.constants[0], self.obstacles)
        self._space = FreeSpace(self.terrain, self.reachable_plan, self.obstacles, self._config.drive.radius,
                                float(self.constants[0]['reach']))
        self.start = self._space.start
        self.noise = Noise(seed)
        self._take_laser(self._config.laser)
        self._docks: Array = np.reshape(np.array(plan.docks, np.float64), (-1, 3))
        self._begin()

    def _begin(self) -> None:
        self.tick = 0
        self.obstacles.begin()
        self.floor = Floor(self.reachable_plan, self._config, self.start, generator(self.seed, FLOOR, 0))
        self._renew()

    def _renew(self) -> None:
        """Have the next tick collect its arrays again: some were replaced, or a constant has changed."""
        self.version += 1
        self._inputs: Tuple[Array, ...] = ()

    def _found_inputs(self) -> Tuple[Array, ...]:
        """The arrays that a tick needs; kept together, since finding them takes as long as a tenth of a tick."""
        floor = self.floor
        self._inputs = (self._states, self.constants, self.obstacles.records, self._docks, self.terrain.clearance,
                        floor.cells, floor.sweep.samples, floor.dirt, floor.sweep.tally, self.noise.wheels)
        return self._inputs

    # --- time -----------------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Simulated time since the beginning or the last reset [s]."""
        return self.tick / self.step_rate

    def step(self, ticks: int = 1) -> None:
        """Simulate a number of ticks."""
        obstacles = self.obstacles
        while ticks > 0:
            row = self.tick % NOISE_TICKS
            if row == 0:
                self.noise.draw(self.tick)
            now = ticks if ticks < NOISE_TICKS - row else NOISE_TICKS - row
            if obstacles.has_movers:
                now = 1
                obstacles.step(self._states, self.constants[0])
            fast.advance(*(self._inputs or self._found_inputs()), self.tick, now)
            self.tick += now
            ticks -= now

    def lead(self, led: Array) -> None:
        """Simulate one tick in which something else moves the robots.

        Args:
            led: poses of the robots after the tick, in the order of `robots`, as for `kernel.tick.follow`.
        """
        self.noise.draw(self.tick)
        if self.obstacles.has_movers:
            self.obstacles.step(self._states, self.constants[0])
        fast.follow(*(self._inputs or self._found_inputs()), self.tick, led)
        self.tick += 1

    def reset(self) -> None:
        """Start again: dirty floor, tick 0, every robot and every mover as it began."""
        before = list(self.robots.values())
        for member in before:
            self.kill(member.name)
        self.noise.spawned = 0
        self._begin()
        for member in before:
            try:
                self.spawn(member.name, *member.start)
            except WorldError:  # another robot, which has moved away since, began at the same position
                self.spawn(member.name, None, *member.start[1:])

    # --- robots ---------------------------------------------------------------------------------------------------

    @property
    def config(self) -> RobotConfig:
        """Configuration of all robots; it may be replaced while they drive.

        Raises:
            ConfigError: the new one has another radius, or a robot could move by more than its radius in one tick.
        """
        return self._config

    @config.setter
    def config(self, config: RobotConfig) -> None:
        if config.drive.radius != self._config.drive.radius:
            raise ConfigError(f'drive/radius is {config.drive.radius:g}: must stay {self._config.drive.radius:g} [m]')
        check_speed(config, self.step_rate)
        self.constants = constants(config, self.terrain, self.step_rate)
        self._config = config
        self._states['charge'] = np.minimum(self._states['charge'], config.battery.capacity)
        self._take(self._states)  # robots that were far apart may meet sooner now
        self._take_laser(config.laser)
        for member in self.robots.values():
            member.config = config

    def _take_laser(self, laser: LaserConfig) -> None:
        self.fans = _fans(laser)
        self._draws = laser.draws, laser.beams  # random numbers for a scan

    def spawn(self, name: str, pose: Optional[Pose] = None, state_of_charge: float = 1.0,
              brushes_up: bool = False) -> Robot:
        """Add a robot.

        Args:
            name: name that no other robot has.
            pose: where it stands [m, rad], map frame; None for the start, or the next dock if robots start docked, or
                the free position nearest to the start.
            state_of_charge: of its battery [0..1].
            brushes_up: whether its brushes are lifted.

        Raises:
            WorldError: the name is taken, the position is not free, or the state of charge is out of range.
        """
        if name in self.robots:
            raise WorldError(f'{name!r} is taken: robots are {", ".join(self.robots)}')
        if not 0.0 <= state_of_charge <= 1.0:
            raise WorldError(f'state of charge is {state_of_charge}: must be 0 to 1')
        where = self._space.nearest(self._poses()) if pose is None else self.check(pose)
        start = Start(where, state_of_charge, brushes_up)
        state = np.zeros(1, ROBOT)
        scales = self.noise.add(self._config.odometry.scale_error)
        robot.begin(state[0], start, self._config.battery.capacity, scales)
        self.robots[name] = Robot(name, start, self._config, state)
        self._take(np.concatenate([self._states, state]))
        return self.robots[name]

    def kill(self, name: str) -> None:
        """Remove a robot from the world.

        Raises:
            WorldError: there is no robot of that name.
        """
        index = self._index(name)
        del self.robots[name]
        self.noise.remove(index)
        self._take(np.delete(self._states, index))

    def teleport(self, name: str, pose: Pose) -> None:
        """Put a robot at a pose [m, rad], map frame, at rest; its odometry does not notice.

        Raises:
            WorldError: there is no robot of that name, or the position is not free.
        """
        index = self._index(name)
        robot.put(self._states[index], self.check(pose, name))
        self._take(self._states)

    def check(self, pose: Pose, name: Optional[str] = None) -> Pose:
        """Check that a robot can stand at a pose.

        Args:
            pose: [m, rad], map frame.
            name: the robot that would stand there; None for a new one.

        Returns:
            The pose with its heading in (-pi, pi].

        Raises:
            WorldError: a number is not finite, or the robot does not fit beside walls, cliffs, obstacles and robots.
        """
        return self._space.check(pose, {other: where for other, where in self._poses().items() if other != name})

    def _poses(self) -> Dict[str, Pose]:
        return {name: member.pose for name, member in self.robots.items()}

    def _take(self, states: Array) -> None:
        """Use these states from now on, after robots were added, removed or moved: any two of them may be close now."""
        states['alone_until'] = 0
        self._states = states
        self._renew()
        for index, member in enumerate(self.robots.values()):
            member.hold(states[index:index + 1])

    def _index(self, name: str) -> int:
        if name not in self.robots:
            raise WorldError(f'there is no robot {name!r}: robots are {", ".join(self.robots) or "none"}')
        return list(self.robots).index(name)

    # --- obstacles ------------------------------------------------------------------------------------------------

    def add_obstacle(self, obstacle: Obstacle) -> None:
        """Add an obstacle, which begins to move if it is a mover; the reachable floor stays what it is.

        Raises:
            WorldError: its name is taken, it lies outside the map or on a robot, or it cannot be an obstacle.
        """
        check_inside(obstacle, self.terrain)
        self.obstacles.add(obstacle)
        for member in self.robots.values():
            if self.obstacles.near(*member.pose[:2], self._config.drive.radius):
                self.remove_obstacle(obstacle.name)
                raise WorldError(f'{obstacle.name} at ({obstacle.pose.x:.2f}, {obstacle.pose.y:.2f}) m: '
                                 f'{member.name!r} stands there')
        self._renew()

    def remove_obstacle(self, name: str) -> None:
        """Take an obstacle away.

        Raises:
            WorldError: there is no obstacle of that name.
        """
        self.obstacles.remove(name)
        self._renew()

    def swept(self) -> Array:
        """How much of each cell of the plan is swept: int8 (rows, columns), as `Floor.swept`."""
        return self.floor.swept(len(self.floor.sweep.samples) // self.plan.rows)

    # --- sensors --------------------------------------------------------------------------------------------------

    def scan(self, name: str) -> Array:
        """Ranges that the laser of a robot tells: float64 (beams) [m], from its first beam on.

        By default, they go counter-clockwise from straight back, and a range is +inf if nothing is within range_max,
        and -inf if something is nearer than range_min (REP 117); see `LaserConfig`.

        Raises:
            WorldError: there is no robot of that name.
        """
        return self.prepared_scan(name)()

    def prepared_scan(self, name: str) -> Callable[[], Array]:
        """As `scan`, but gives a function that measures, for those who may not need the ranges.

        It measures the world as it is when it is called, with the errors of this scan.

        Raises:
            WorldError: there is no robot of that name; that function raises it too.
        """
        noise = np.empty(self._draws)
        self.noise.draw_laser(self._index(name), noise)

        def measure() -> Array:
            index, ranges = self._index(name), np.empty(len(noise[0]))
            fast.scan(self._states, index, self.constants, self.obstacles.records, self.terrain.skips, self.fans,
                      noise, self.noise.biases[index], ranges)
            return ranges
        return measure

    @property
    def is_scan_due(self) -> bool:
        """Whether lasers, which turn only so fast, tell a scan at this tick; they do at the first."""
        step_rate = int(self.step_rate)
        return (self.tick - 1) % (step_rate // self._config.laser.rate_at(step_rate)) == 0

    def infrared(self, name: str) -> Infrared:
        """What the receivers of a robot get from the docks.

        Raises:
            WorldError: there is no robot of that name.
        """
        return Infrared(*fast.infrared(self._states, self._index(name), self.constants, self._docks,
                                       self.terrain.skips))

    def cliffs(self, name: str) -> List[bool]:
        """Whether the left, front left, front right and right sensor of a robot see no floor, or did just now.

        Raises:
            WorldError: there is no robot of that name.
        """
        seen = np.zeros(4, np.bool_)
        fast.cliffs(self._states, self._index(name), self.constants, self.floor.cells, seen)
        found: List[bool] = seen.tolist()
        return found

    # --- state ----------------------------------------------------------------------------------------------------

    @property
    def arrays(self) -> WorldArrays:
        """The arrays in which the world is, and not copies."""
        obstacles, floor = self.obstacles, self.floor
        return WorldArrays(self._states, self.constants, obstacles.records, obstacles.stops, self.noise.wheels,
                           floor.cells, floor.sweep.samples, floor.dirt, floor.sweep.tally)

    def keep_in(self, arrays: WorldArrays) -> None:
        """Be in these arrays from now on, whose contents are the same already."""
        floor, sweep = self.floor, self.floor.sweep
        self.constants, self.noise.wheels = arrays.constants, arrays.noise
        self.obstacles.records, self.obstacles.stops = arrays.obstacles, arrays.stops
        floor.cells, sweep.samples, floor.dirt, sweep.tally = (
            arrays.cells, arrays.samples, arrays.dirt, arrays.tally)
        self._take(arrays.robots)

    def digest(self) -> str:
        """SHA-256 of everything that changes: tick, robots, noise, floor, obstacles."""
        state = hashlib.sha256(' '.join([str(self.tick), *self.robots, *self.obstacles.items]).encode())
        for array in self.arrays.changing().values():
            state.update(np.ascontiguousarray(array).tobytes())
        return state.hexdigest()

    def _origin(self) -> Dict[str, Any]:
        return world_state.origin(self.plan, dataclasses.asdict(self._config), self.step_rate, self.seed,
                                  self._at_start)

    def state(self) -> WorldState:
        """A copy of everything that changes, from which `restored` goes on."""
        members = [Member(member.name, member.start, *generators)
                   for member, generators in zip(self.robots.values(), self.noise.states())]
        arrays = {name: array.copy() for name, array in self.arrays.changing().items()}
        obstacles = list(self.obstacles.items.values())
        return WorldState(self._origin(), self.tick, self.noise.spawned, members, obstacles, arrays, self.digest())

    @classmethod
    def restored(cls, state: WorldState, plan: FloorPlan, config: Optional[RobotConfig] = None,
                 step_rate: float = 50, seed: int = 0, obstacles: Sequence[Obstacle] = ()) -> 'World':
        """A world that goes on from a state as the world would have from which the state was taken, bit for bit.

        The arguments are those of the world that was saved, as for the constructor.

        Raises:
            WorldError: the state was taken from a world with other arguments.
            RumbaError: as for the constructor.
        """
        world = cls(plan, config, step_rate, seed, obstacles)
        world_state.check_origin(state.origin, world._origin())
        world.tick = state.tick
        world.noise.restore(state.spawned, state.members)
        world.obstacles.restore(state.obstacles)
        world._states = np.zeros(len(state.members), ROBOT)
        for index, member in enumerate(state.members):
            world.robots[member.name] = Robot(member.name, member.start, world._config, world._states[index:index + 1])
        world_state.fill(world.arrays.changing(), state.arrays)
        if world.digest() != state.digest:
            raise WorldError('is damaged: its digest is another one')
        return world

    def __reduce__(self) -> Tuple[Callable[..., 'World'], Tuple[Any, ...]]:
        """Copies and pickles go on from here, bit for bit, as the world itself does."""
        return World.restored, (self.state(), self.plan, self._config, self.step_rate, self.seed, self._at_start)


def _fans(laser: LaserConfig) -> Array:
    """Directions of the laser's beams in the frame of the robot: float64 (1 or 3, beams, 2).

    Sines of NumPy depend on its version and on the processor.
    """
    angles = [[beam * laser.step_in_robot + (laser.first_in_robot + off) for beam in range(laser.beams)]
              for off in laser.offsets]
    return np.array([[(math.cos(angle), math.sin(angle)) for angle in fan] for fan in angles])
