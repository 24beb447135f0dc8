"""ROOM20: a room of 20 x 20 m with round and square pillars, used to compare simulators, and larger versions of it."""

import math

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.simulation.world import World

SIDE = 20.0  # [m]
DISCS = ((4, 4), (4, 14), (10, 8), (14, 4), (16, 16))  # [m] centres of discs
DISC_RADIUS = 0.3  # [m]
SQUARES = ((6, 10), (8, 16), (12, 12), (16, 8), (10, 2))  # [m] centres of squares
SQUARE_SIDE = 0.6  # [m]
FIRST = (9.0, 9.0)  # [m] position of the first robot; all robots stand at odd coordinates
SPEED, TURN_RATE = 0.2, 1.0  # [m/s, rad/s] every robot drives in a circle of radius 0.2 m and touches nothing
COMMAND_PERIOD = 0.2  # [s] less than the timeout of a command
SETTLED = 100  # ticks after which the robots have their speed, and know which others are far away


def room20(resolution, rooms=(1, 1), side=0.0):
    """The floor plan.

    Args:
        resolution: side of a cell [m].
        rooms: number of rooms along x and y, without walls between them.
        side: side of the map [m] if it is larger than the room, which then lies in its corner.
    """
    columns, rows = (round(max(SIDE * number, side) / resolution) for number in rooms)
    occupancy = np.full((rows, columns), FREE, np.int8)
    for edge in (occupancy, occupancy.T):
        edge[0] = edge[-1] = OCCUPIED
    x, y = np.meshgrid(*((np.arange(round(SIDE * number / resolution)) + 0.5) * resolution % SIDE for number in rooms))
    pillars = np.zeros(x.shape, bool)
    for disc in DISCS:
        pillars |= np.hypot(x - disc[0], y - disc[1]) <= DISC_RADIUS
    for square in SQUARES:
        pillars |= np.maximum(abs(x - square[0]), abs(y - square[1])) <= 0.5 * SQUARE_SIDE
    occupancy[:len(y), :len(x[0])][pillars] = OCCUPIED
    return FloorPlan('ROOM20', occupancy, resolution, (0.0, 0.0), start=Pose(*FIRST, 0.0))


def populated(plan, robots, step_rate, rooms=(1, 1), seed=1):
    """A world with a number of robots on a grid of 2 m, all of which face along x."""
    along_x, along_y = (np.arange(1.0, SIDE * number, 2.0) for number in rooms)
    positions = [(x, y) for x in along_x for y in along_y if (x, y) != FIRST]
    np.random.default_rng(seed).shuffle(positions)
    world = World(plan, step_rate=step_rate, seed=seed)
    for number, (x, y) in enumerate([FIRST, *positions][:robots]):
        world.spawn(f'rumba{number}', Pose(x, y, 0.0))
    return world


def drive(world, ticks, laser_period=0.0):
    """Simulate ticks one by one, with every robot on its circle; scan every `laser_period` seconds if it is not 0."""
    command_every = round(COMMAND_PERIOD * world.step_rate)
    scan_every = round(laser_period * world.step_rate)
    for _ in range(ticks):
        if world.tick % command_every == 0:
            for robot in world.robots.values():
                robot.command(SPEED, TURN_RATE, world.tick)
        world.step()
        if scan_every and world.tick % scan_every == 0:
            scan(world)


def drive_at_once(world, commands):
    """Simulate until so many commands were given, with all ticks from one to the next in one call."""
    command_every = round(COMMAND_PERIOD * world.step_rate)
    for _ in range(commands):
        for robot in world.robots.values():
            robot.command(SPEED, TURN_RATE, world.tick)
        world.step(command_every)


def scan(world):
    """Let every robot scan once."""
    for name in world.robots:
        world.scan(name)


def begin(world):
    """Put all robots back to the start with full batteries, and drive until they have their speed."""
    world.reset()
    drive(world, SETTLED)


def check(world):
    """Refuse a world in which a robot touched something, which takes more time, or has no charge left and stands."""
    for robot in world.robots.values():
        start, pose = robot.start.pose, robot.pose
        assert robot.bumps == 0 and math.hypot(pose.x - start.x, pose.y - start.y) < 0.5, robot.name
        assert robot.distance > 0.0 and robot.battery.state_of_charge > 0.0, robot.name
