"""The areas in which the beams of a dock are received: sectors that walls cut off."""

import math
from typing import Tuple

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_viewer.scene.snapshot import Array, Dock

BEAMS = 90  # of a sector
CLEAR = 0.5  # [cells] from the dock, within which a wall is ignored: the dock itself stands at one


def docks(plan: FloorPlan, config: RobotConfig) -> Tuple[Dock, ...]:
    """The docks of a floor plan, each with its force field around it and its buoys in front of it."""
    return tuple(_dock(plan, config, pose) for pose in plan.docks)


def _dock(plan: FloorPlan, config: RobotConfig, pose: Pose) -> Dock:
    sender = Pose(pose.x + config.drive.radius * math.cos(pose.theta),
                  pose.y + config.drive.radius * math.sin(pose.theta), pose.theta + math.pi)
    return Dock(pose, _sector(plan, sender, 0.5 * math.pi, config.dock.halo),
                _sector(plan, sender, 0.5 * config.dock.buoy_field, config.dock.buoy_range))


def _sector(plan: FloorPlan, sender: Pose, half: float, reach: float) -> Array:
    """Corners (n, 2) [m] of a sector around the direction of a sender, up to the first wall."""
    angles = sender.theta + np.linspace(-half, half, BEAMS)
    steps = np.arange(CLEAR * plan.resolution, reach, 0.5 * plan.resolution)
    x = sender.x + np.outer(np.cos(angles), steps)
    y = sender.y + np.outer(np.sin(angles), steps)
    column = np.floor((x - plan.origin[0]) / plan.resolution).astype(int)
    row = np.floor((y - plan.origin[1]) / plan.resolution).astype(int)
    inside = (row >= 0) & (row < plan.rows) & (column >= 0) & (column < plan.columns)
    is_open = np.zeros(x.shape, bool)
    is_open[inside] = plan.free[row[inside], column[inside]]
    far = np.where(is_open.all(axis=1), reach, steps[np.argmin(is_open, axis=1)])
    return np.concatenate([[(sender.x, sender.y)], np.stack(
        [sender.x + far * np.cos(angles), sender.y + far * np.sin(angles)], axis=1)])
