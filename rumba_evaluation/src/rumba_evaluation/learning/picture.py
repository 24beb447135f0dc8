"""A picture of a world as an array of pixels: the floor, what is swept of it, the dock and the robot."""

import math

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World

PIXEL = 0.02  # [m] side of a pixel, about
# The colours are those of `trials.plots`, in red, green and blue.
WALL, UNKNOWN, FLOOR, SWEPT, CLIFF = (64, 64, 64), (216, 216, 216), (255, 255, 255), (174, 214, 236), (230, 159, 0)
BODY, FRONT, DOCK = (0, 114, 178), (255, 255, 255), (0, 158, 115)


def picture(world: World) -> Array:
    """The picture of a world with one robot: uint8 (rows, columns, 3), y upward."""
    plan = world.plan
    colours = np.empty((plan.rows, plan.columns, 3), np.uint8)
    colours[...] = UNKNOWN
    colours[plan.occupancy == OCCUPIED] = WALL
    colours[plan.free] = FLOOR
    share = np.clip(world.swept(), 0, 100)[..., np.newaxis] / 100.0
    swept = np.array(FLOOR) + share * (np.array(SWEPT) - np.array(FLOOR))
    colours = np.where(plan.free[..., np.newaxis], swept, colours).astype(np.uint8)
    if plan.cliff is not None:
        colours[plan.cliff & plan.free] = CLIFF
    parts = max(round(plan.resolution / PIXEL), 1)
    colours = colours.repeat(parts, 0).repeat(parts, 1)
    pitch, radius = plan.resolution / parts, world.config.drive.radius
    x = plan.origin[0] + (np.arange(colours.shape[1]) + 0.5) * pitch
    y = plan.origin[1] + (np.arange(colours.shape[0])[:, np.newaxis] + 0.5) * pitch
    for dock in plan.docks:
        front = _ahead(dock, radius)
        colours[np.hypot(x - front.x, y - front.y) < 0.4 * radius] = DOCK
    pose = world.robots[FIRST].pose
    colours[np.hypot(x - pose.x, y - pose.y) < radius] = BODY
    nose = _ahead(pose, 0.6 * radius)
    colours[np.hypot(x - nose.x, y - nose.y) < 0.25 * radius] = FRONT
    return np.ascontiguousarray(colours[::-1])


def _ahead(pose: Pose, distance: float) -> Pose:
    return Pose(pose.x + distance * math.cos(pose.theta), pose.y + distance * math.sin(pose.theta), pose.theta)
