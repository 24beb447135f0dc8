"""Scans and drives for the tests of the localisation."""

import math

import numpy as np
from rooms import crooked

from rumba_localisation.localiser import Localiser
from rumba_localisation.scan import Scan, scan_of
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

BLIND = Scan(np.empty((0, 2)), np.empty((0, 2)))
RADIUS, RANGE = RobotConfig().drive.radius, RobotConfig().laser.range_max


def world_of(plan=None, pose=Pose(2.0, 1.3, 0.7), seed=1):
    """A world with one robot of the usual errors."""
    world = World(plan or crooked(), RobotConfig(), 50, seed)
    world.spawn('rumba', pose)
    return world


def scanned(world):
    """What the laser of the robot tells."""
    ranges = world.scan('rumba')
    return scan_of(ranges, -math.pi, 2.0 * math.pi / len(ranges), RANGE)


def localiser_of(plan, **options):
    """A localiser that knows a map, and nothing else."""
    return Localiser(plan, RADIUS, RANGE, **options)


def error(believed, true):
    """Distance [m] and angle [rad] between two poses."""
    turn = (believed.theta - true.theta + math.pi) % (2.0 * math.pi) - math.pi
    return math.hypot(believed.x - true.x, believed.y - true.y), abs(turn)


def drive(world, localiser, v, w, seconds, is_blind=False):
    """Command a robot for some time, with a scan ten times a second; yields the errors of its pose after each."""
    robot = world.robots['rumba']
    for _ in range(round(10 * seconds)):
        robot.command(v, w, world.tick)
        world.step(5)
        localiser.observe(robot.odometry, BLIND if is_blind else scanned(world))
        yield error(localiser.pose(robot.odometry), robot.pose)
