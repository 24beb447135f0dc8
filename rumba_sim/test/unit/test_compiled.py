"""The compiled kernel gives the results of the plain one, except for rounding."""

import math
import types

import numpy as np
import pytest
from rooms import crooked

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast, functions_of, kernel_modules
from rumba_sim.model.floors.constants import constants
from rumba_sim.model.floors.reachability import stands
from rumba_sim.model.kernel.records import OBSTACLE, ROBOT
from rumba_sim.model.kernel.sweeping.samples import REACHABLE, SWEEPABLE
from rumba_sim.model.simulation.obstacle import Obstacle, walk
from rumba_sim.model.simulation.world import World

DOCK = Pose(3.8, 1.0, 0.0)
STARTS = [Pose(0.5, 0.5, 0.3), Pose(0.9, 0.5, 3.0), Pose(2.0, 1.3, -2.0), Pose(3.5, 1.0, 0.1), Pose(3.2, 2.6, 0.0)]
OBSTACLES = [
    Obstacle('post', Pose(1.1, 0.75, 0.0), height=0.3, radius=0.02),
    Obstacle('book', Pose(2.3, 0.8, 0.7), height=0.3, length=0.3, width=0.2),
    Obstacle('cat', Pose(3.0, 2.2, 0.0), height=0.3, radius=0.1, stops=walk(
        [Pose(3.0, 2.2, 0.0), Pose(3.6, 0.7, 0.0), Pose(2.0, 1.7, 0.0)], 0.3, True, 0.0, 1.0)),
    Obstacle('crate', Pose(0.5, 2.0, 0.0), height=0.3, length=0.2, width=0.1, stops=walk(
        [Pose(0.5, 2.0, 0.0), Pose(0.5, 0.4, 1.0)], 0.3, False, 0.0, 0.5))]
ROUNDING = 1e-12
FUNCTIONS = [function for module in kernel_modules() for function in functions_of(module)]
PLAIN = types.SimpleNamespace(**{function.__name__: function for function in FUNCTIONS})


class Copy:
    """All data of the kernel, separate from any world."""

    def __init__(self, charge):
        plan = crooked(dock=DOCK, cliff=(3.6, 2.4, 4.0, 3.0), carpet=(0.0, 0.0, 1.0, 1.0))
        world = World(plan, seed=4, obstacles=OBSTACLES)
        self.robots = np.concatenate([
            np.atleast_1d(world.spawn(str(number), start, charge).state) for number, start in enumerate(STARTS)
        ]).astype(ROBOT)
        self.constants = constants(world.config, world.terrain, world.step_rate)
        self.plan, self.floor = world.terrain, world.floor
        self.obstacles, self.stops = world.obstacles.records, world.obstacles.stops
        angles = np.linspace(-math.pi, math.pi, 360, endpoint=False)
        self.fans = np.stack([np.cos(angles), np.sin(angles)], axis=1)[np.newaxis]
        self.docks = np.array([DOCK, (0.6, 2.2, 2.0)])
        self.noise = np.random.default_rng(2).standard_normal((len(STARTS), 64, 2))

    @property
    def ground(self):
        """What all robots stand on and what has the same place in the arguments of the kernel."""
        return (self.robots, self.constants, self.obstacles, self.docks, self.plan.clearance, self.floor.cells,
                self.floor.sweep.samples, self.floor.dirt, self.floor.sweep.tally, self.noise)

    def advance(self, functions, tick, ticks):
        """Simulate a number of ticks."""
        for now in range(tick, tick + ticks):
            functions.go(self.obstacles, self.stops, self.robots, self.constants[0])
            functions.advance(*self.ground, now, 1)

    def run(self, functions, ticks):
        """Drive around; returns the states after each command, what infrared and cliff sensors saw, and the scans."""
        rng = np.random.default_rng(1)
        states, seen = [], []
        for tick in range(0, ticks, 10):
            for robot in self.robots:
                robot.command_v, robot.command_w = rng.uniform(-0.1, 0.5), rng.uniform(-1.9, 1.9)
                robot.command_tick = tick
            self.advance(functions, tick, 10)
            states.append(self.robots.copy())
            for me in range(len(STARTS)):
                cliffs = np.zeros(4, np.bool_)
                functions.cliffs(self.robots, me, self.constants, self.floor.cells, cliffs)
                seen.append((*functions.infrared(self.robots, me, self.constants, self.docks, self.plan.skips),
                             *cliffs))
        ranges = np.empty((len(STARTS), 360))
        for me in range(len(STARTS)):
            functions.scan(self.robots, me, self.constants, self.obstacles, self.plan.skips, self.fans,
                           self.noise.reshape(-1)[np.newaxis, :360], 0.0, ranges[me])
        return np.concatenate(states), seen, ranges


@pytest.mark.thorough(except_for=['1e-05'])
@pytest.mark.parametrize('charge', [1.0, 0.00001])
def test_compiled_and_plain_kernel_agree_except_for_rounding(charge):
    plain, compiled = Copy(charge), Copy(charge)
    states, seen, ranges = plain.run(PLAIN, 400)
    fast_states, fast_seen, fast_ranges = compiled.run(fast, 400)
    for name in ROBOT.names:
        np.testing.assert_allclose(fast_states[name], states[name], ROUNDING, ROUNDING, err_msg=name)
    assert fast_seen == seen
    np.testing.assert_allclose(fast_ranges, ranges, ROUNDING, ROUNDING)
    for name in OBSTACLE.names:
        np.testing.assert_allclose(compiled.obstacles[name], plain.obstacles[name], ROUNDING, ROUNDING, err_msg=name)
    np.testing.assert_array_equal(compiled.floor.sweep.samples, plain.floor.sweep.samples)
    np.testing.assert_allclose(compiled.floor.sweep.tally[0].tolist(), plain.floor.sweep.tally[0].tolist(), 1e-9)
    if charge == 1.0:  # every kind of event happened
        assert states['bumps'].max() > 0 and states['docked'].any() and states['fallen'].any()
        assert states['cliff_ticks'].any()
        assert any(beams != (0, 0, 0) for beams in seen) and np.isfinite(ranges).any()
        assert plain.obstacles['visits'][2:].min() > 0
        assert np.isnan(states['contact_angle']).any() and not np.isnan(states['contact_angle']).all()


def test_compiled_and_plain_kernel_move_led_robots_in_the_same_way():
    led = np.array([[x + 0.004, y - 0.002, theta + 0.01, me % 2] for me, (x, y, theta) in enumerate(STARTS)])
    copies = [Copy(1.0), Copy(1.0)]
    halted = []
    for functions, copy in zip((PLAIN, fast), copies):
        functions.follow(*copy.ground, 0, led)
        assert [(robot.x, robot.y, robot.theta) for robot in copy.robots] == [tuple(to) for to in led[:, :3]]
        halted.append([functions.halted(robot, copy.constants[0], copy.plan.clearance, copy.floor.cells, 0.3)
                       for robot in copy.robots])
    for name in ROBOT.names:
        np.testing.assert_allclose(copies[1].robots[name], copies[0].robots[name], ROUNDING, ROUNDING, err_msg=name)
    np.testing.assert_allclose(halted[1], halted[0], ROUNDING, ROUNDING)


def test_compiled_and_plain_kernel_find_the_same_floor_in_reach():
    plan = crooked(cliff=(3.6, 2.4, 4.0, 3.0))
    spare = np.where(stands(plan, 0.17, 0.5, 0.5), 0.001, -1.0)
    found = []
    for functions in (PLAIN, fast):
        samples = np.full((plan.rows * 2, plan.columns * 2), SWEEPABLE, np.uint8)
        count = functions.mark_reachable(plan.safe_clearance, plan.resolution, spare, 0.17, 0.08, samples)
        assert count == np.count_nonzero(samples & REACHABLE) > 1000
        found.append(samples)
    np.testing.assert_array_equal(found[1], found[0])


def test_every_function_of_the_kernel_is_compiled_and_has_a_name_of_its_own():
    for function in FUNCTIONS:
        assert getattr(fast, function.__name__).py_func.__code__ is function.__code__


def test_a_name_that_no_function_has_is_an_error():
    with pytest.raises(AttributeError, match="^there is no compiled function 'fly'$"):
        fast.fly


@pytest.mark.parametrize('angle', [0.0, math.pi, -math.pi, 3.5, -3.5, 100.0, math.nan])
def test_the_compiled_kernel_wraps_angles_like_the_plain_one(angle):
    np.testing.assert_equal(fast.wrap(angle), PLAIN.wrap(angle))
