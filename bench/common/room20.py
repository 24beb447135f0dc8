"""ROOM20: a room of 20 x 20 m with round and square pillars, on which simulators were compared, and larger kin."""

import math

import numpy as np

from rumba_sim.model.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.world import World

SIDE = 20.0  # [m]
DISCS = ((4, 4), (4, 14), (10, 8), (14, 4), (16, 16))  # [m] centres, of radius
DISC_RADIUS = 0.3  # [m]
SQUARES = ((6, 10), (8, 16), (12, 12), (16, 8), (10, 2))  # [m] centres, of side
SQUARE_SIDE = 0.6  # [m]
FIRST = (9.0, 9.0)  # [m] the first robot; the others stand on odd coordinates too
SPEED, TURN_RATE = 0.2, 1.0  # [m/s, rad/s] every robot drives a circle of radius 0.2 m and never meets anything
COMMAND_PERIOD = 0.2  # [s] well below the timeout of a command


def room20(resolution, rooms=(1, 1), side=0.0):
    """The floor plan.

    Args:
        resolution: side of a cell [m].
        rooms: so many along x and y, the walls between them left out.
        side: of the map [m], in whose corner the room lies; no smaller than the room.
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
    """A world with so many robots on a grid of 2 m, all looking along x."""
    along_x, along_y = (np.arange(1.0, SIDE * number, 2.0) for number in rooms)
    places = [(x, y) for x in along_x for y in along_y if (x, y) != FIRST]
    np.random.default_rng(seed).shuffle(places)
    world = World(plan, step_rate=step_rate, seed=seed)
    for number, (x, y) in enumerate([FIRST, *places][:robots]):
        world.spawn(f'rumba{number}', Pose(x, y, 0.0))
    return world


def drive(world, ticks, laser_period=0.0):
    """Let ticks pass one by one, every robot on its circle; with a laser, scan every so many seconds."""
    command_every = round(COMMAND_PERIOD * world.step_rate)
    scan_every = round(laser_period * world.step_rate)
    for _ in range(ticks):
        if world.tick % command_every == 0:
            for robot in world.robots.values():
                robot.command(SPEED, TURN_RATE, world.tick)
        world.step()
        if scan_every and world.tick % scan_every == 0:
            scan(world)


def scan(world):
    """One scan of every robot."""
    for name in world.robots:
        world.scan(name)


def check(world):
    """Refuse a world in which anything touched anything: it would have measured something else."""
    for robot in world.robots.values():
        start, place = robot.start.pose, robot.pose
        assert robot.bumps == 0 and math.hypot(place.x - start.x, place.y - start.y) < 0.5, robot.name
        assert robot.distance > 0.0, robot.name
