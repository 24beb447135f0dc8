"""A world of one robot that something else moves: a turtle of turtlesim, say, is its body."""

from typing import Optional

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.compiled import fast
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot import Robot, Twist, put
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.model.world import World

WISHES = ('command_v', 'command_w', 'command_tick', 'charge', 'fallen')  # what wheels go by


class GuidedWorld(World):
    """A world that is told where its robot is, and says how that would drive.

    What follows from the motion, energy, coverage, odometry, sensors, is the same as in any world. Time passes by
    `follow` and `jump`, not by `step`.

    Attributes:
        robot: the only one.
    """

    def __init__(self, plan: FloorPlan, config: Optional[RobotConfig] = None, step_rate: float = 50, seed: int = 0,
                 name: str = 'rumba', state_of_charge: float = 1.0, brushes_up: bool = False) -> None:
        """A world with one robot, at the start of the plan until it is told where.

        Raises:
            RumbaError: as of `World`, and of `spawn`.
        """
        super().__init__(plan, config, step_rate, seed)
        self._name = name
        self._wheels_wished: kernel.Array = np.zeros(1, kernel.ROBOT)
        self.spawn(name, None, state_of_charge, brushes_up)

    @property
    def robot(self) -> Robot:
        """The only one; another after a reset."""
        return self.robots[self._name]

    def follow(self, pose: Pose) -> None:
        """Let one tick pass in which the robot drove to a pose [m, rad], map frame."""
        self._pass(pose, is_driven=True)

    def jump(self, pose: Pose) -> None:
        """Let one tick pass in which the robot was carried to a pose: it stands there, its odometry did not notice.

        Where to is not checked: whoever moves it may put it into a wall.
        """
        put(self._states[0], pose)
        self._wheels_wished.fill(0)
        self._pass(pose, is_driven=False)

    def _pass(self, pose: Pose, is_driven: bool) -> None:
        self._advance(1, np.array([[*pose, is_driven]], np.float64))

    def wish(self) -> Twist:
        """How the robot would drive in the next tick: as commanded, within the limits of drive and battery.

        It stops before it runs into a wall.
        """
        wheels, constants = self._wheels_wished[0], self._constants[0]
        for name in WISHES:
            wheels[name] = self.robot.state[name]
        fast.drive(wheels, constants, self.tick)
        left, right = float(wheels['left_speed']), float(wheels['right_speed'])
        forward = fast.halted(self.robot.state, constants, self.plan.clearance, 0.5 * (left + right))
        return Twist(forward, (right - left) / self._config.drive.wheel_base)

    def check(self, pose: Pose) -> Pose:
        """A pose [m, rad] at which the robot can stand, its heading wrapped.

        Raises:
            WorldError: it cannot.
        """
        return self._checked(pose, 0)
