"""Random poses at which robots start."""

import math
from typing import List

import numpy as np

from rumba_sim.model.errors import WorldError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.reachability import reach
from rumba_sim.model.robot_config import RobotConfig


def anywhere(plan: FloorPlan, config: RobotConfig, origin: Pose, count: int,
             generator: np.random.Generator) -> List[Pose]:
    """Random poses for robots that do not overlap, anywhere a robot fits and can drive to from an origin.

    A robot may also fit at a position that it cannot reach, for example between the legs of a table, but there is
    nothing to clean there.

    Raises:
        MapError: no robot fits at the origin.
        WorldError: there is no space for so many robots.
    """
    terrain, radius = plan.refined(), config.drive.radius
    free = reach(terrain, config, origin.x, origin.y).stands.copy()
    spacing = 0.5 * terrain.resolution
    poses: List[Pose] = []
    while len(poses) < count:
        positions = np.argwhere(free)
        if len(positions) == 0:
            raise WorldError(f'{plan.name}: no room for another robot beside {len(poses)}')
        row, column = positions[generator.integers(len(positions))].tolist()
        poses.append(Pose(terrain.origin[0] + column * spacing, terrain.origin[1] + row * spacing,
                          generator.uniform(-math.pi, math.pi)))
        rows, columns = np.ogrid[:free.shape[0], :free.shape[1]]
        free &= np.hypot(rows - row, columns - column) * spacing > 2.0 * radius
    return poses
