"""What a behaviour knows of its place of work, and what it remembers of it."""

import numpy as np

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.robot_config import RobotConfig


class Context:
    """One robot's knowledge, shared by all its behaviours.

    Attributes:
        plan: the floor plan.
        robot: what the robot is like.
        config: how it shall work.
        generator: what random choices are drawn from.
        ground: where the robot can go, with the obstacles that it met.
        swept: what its brush passed over.
    """

    def __init__(self, plan: FloorPlan, robot: RobotConfig, config: CleaningConfig, seed: int = 0) -> None:
        """Know a floor plan, and remember nothing yet."""
        self.plan = plan
        self.robot = robot
        self.config = config
        self.generator = np.random.default_rng(seed)
        self.ground = Ground(plan, robot)
        self.swept = Swept(plan, robot)
