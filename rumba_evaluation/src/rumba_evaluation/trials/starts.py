"""Places to begin at."""

import math
from typing import List

import numpy as np

from rumba_sim.model.constants import constants
from rumba_sim.model.errors import WorldError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot_config import RobotConfig

ANY_RATE = 50  # [Hz] how near a robot can come to a wall does not depend on it


def anywhere(plan: FloorPlan, config: RobotConfig, origin: Pose, count: int,
             generator: np.random.Generator) -> List[Pose]:
    """Poses at random for robots that do not overlap, wherever they fit and can drive to from an origin.

    Elsewhere, as between four legs of a table, a robot may fit too, but has nothing to clean.

    Raises:
        MapError: no robot fits at the origin.
        WorldError: there is no room for so many.
    """
    room, radius = plan.safe_clearance, config.drive.radius
    at_centres = 0.25 * (room[:-1, :-1] + room[:-1, 1:] + room[1:, :-1] + room[1:, 1:])
    stands = plan.reachable(origin.x, origin.y, radius, 0.0) & (
        at_centres >= constants(config, plan, ANY_RATE)[0]['reach'])
    poses: List[Pose] = []
    while len(poses) < count:
        cells = np.argwhere(stands)
        if len(cells) == 0:
            raise WorldError(f'{plan.name}: no room for another robot beside {len(poses)}')
        row, column = cells[generator.integers(len(cells))].tolist()
        poses.append(Pose(*plan.centre(row, column), generator.uniform(-math.pi, math.pi)))
        rows, columns = np.ogrid[:plan.rows, :plan.columns]
        stands &= np.hypot(rows - row, columns - column) * plan.resolution > 2.0 * radius
    return poses
