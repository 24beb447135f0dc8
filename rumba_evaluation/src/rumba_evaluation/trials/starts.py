"""Random poses at which robots start."""

import math
from typing import Callable, List

import numpy as np

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.reachability import reach
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig


def anywhere(plan: FloorPlan, config: RobotConfig, origin: Pose, count: int,
             generator: np.random.Generator,
             is_taken: Callable[[float, float], bool] = lambda x, y: False) -> List[Pose]:
    """Random poses for robots that do not overlap, anywhere a robot fits and can drive to from an origin.

    A robot may also fit at a position that it cannot reach, for example between the legs of a table, but there is
    nothing to clean there.

    Args:
        plan: the floor plan.
        config: of the robots.
        origin: from which they could drive there [m, rad], map frame.
        count: number of poses.
        generator: source of the poses.
        is_taken: whether something that is not on the plan stands at a position (x, y) [m].

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
        x, y = terrain.origin[0] + column * spacing, terrain.origin[1] + row * spacing
        if is_taken(x, y):
            free[row, column] = False
            continue
        poses.append(Pose(x, y, generator.uniform(-math.pi, math.pi)))
        rows, columns = np.ogrid[:free.shape[0], :free.shape[1]]
        free &= np.hypot(rows - row, columns - column) * spacing > 2.0 * radius
    return poses
