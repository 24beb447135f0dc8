"""Random poses at which robots start."""

import math
from typing import List

import numpy as np

from rumba_sim.model.constants import constants
from rumba_sim.model.errors import WorldError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot_config import RobotConfig

ANY_RATE = 50  # [Hz] a robot's least clearance does not depend on the step rate


def anywhere(plan: FloorPlan, config: RobotConfig, origin: Pose, count: int,
             generator: np.random.Generator) -> List[Pose]:
    """Random poses for robots that do not overlap, anywhere a robot fits and can drive to from an origin.

    A robot may also fit at a position that it cannot reach, for example between the legs of a table, but there is
    nothing to clean there.

    Raises:
        MapError: no robot fits at the origin.
        WorldError: there is no space for so many robots.
    """
    clearance, radius = plan.safe_clearance, config.drive.radius
    at_centres = 0.25 * (clearance[:-1, :-1] + clearance[:-1, 1:] + clearance[1:, :-1] + clearance[1:, 1:])
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
