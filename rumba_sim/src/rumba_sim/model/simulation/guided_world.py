"""A world whose only robot is moved by something else, for example by a turtle of turtlesim."""

from typing import Optional

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.records import ROBOT
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import Robot, Twist, put
from rumba_sim.model.simulation.world import World

INPUTS = ('command_v', 'command_w', 'command_tick', 'charge', 'fallen')  # fields of a robot that its wheels depend on


class GuidedWorld:
    """Tells a world where its robot is, and says how that robot would drive.

    Everything that follows from the motion (energy, coverage, odometry, sensors) is the same as in any world. Time
    passes by `follow` and `jump`.

    Attributes:
        world: the world, to be read.
    """

    def __init__(self, plan: FloorPlan, config: Optional[RobotConfig] = None, step_rate: float = 50, seed: int = 0,
                 name: str = 'rumba', state_of_charge: float = 1.0, brushes_up: bool = False) -> None:
        """Create a world with one robot, which stands at the start of the plan until its pose is told.

        Args:
            plan: the floor plan.
            config: of the robot.
            step_rate: ticks per second [Hz].
            seed: seed of everything that is random.
            name: of the robot.
            state_of_charge: of its battery [0..1].
            brushes_up: whether its brushes are lifted.

        Raises:
            RumbaError: as `World` and `World.spawn`.
        """
        self.world = World(plan, config, step_rate, seed)
        self._name = name
        self._wheels: Array = np.zeros(1, ROBOT)  # of a robot that drives as `wish` says ...
        self._driving = self.world.spawn(name, None, state_of_charge, brushes_up)  # ... which is this one

    @property
    def robot(self) -> Robot:
        """The robot; another object after a reset."""
        return self.world.robots[self._name]

    def follow(self, pose: Pose) -> None:
        """Simulate one tick in which the robot drives to a pose [m, rad], map frame."""
        self._lead(pose, is_driven=True)

    def jump(self, pose: Pose) -> None:
        """Simulate one tick in which the robot is carried to a pose, where it rests; its odometry does not notice.

        The pose is not checked: whatever moves the robot may put it into a wall.
        """
        put(self.robot.state, pose)
        self._wheels.fill(0)
        self._lead(pose, is_driven=False)

    def reset(self) -> None:
        """Start again: dirty floor, tick 0, the robot at rest as it began."""
        self.world.reset()

    def _lead(self, pose: Pose, is_driven: bool) -> None:
        self.world.lead(np.array([[*pose, is_driven]], np.float64))

    def wish(self) -> Twist:
        """How the robot would drive in the next tick: as commanded, within the limits of drive and battery.

        It stops before it drives into a wall. To be called once in each tick, since its wheels accelerate.
        """
        if self._driving is not self.robot:  # the world was reset
            self._driving = self.robot
            self._wheels.fill(0)
        wheels, state, constants = self._wheels[0], self.robot.state, self.world.constants[0]
        for name in INPUTS:
            wheels[name] = state[name]
        fast.drive(wheels, constants, self.world.tick)
        left, right = float(wheels['left_speed']), float(wheels['right_speed'])
        forward = fast.halted(state, constants, self.world.terrain.clearance, self.world.floor.cells,
                              0.5 * (left + right))
        return Twist(forward, (right - left) / self.world.config.drive.wheel_base)

    def check(self, pose: Pose) -> Pose:
        """Check that the robot can stand at a pose [m, rad], map frame; returns it with its heading in (-pi, pi].

        Raises:
            WorldError: it cannot stand there.
        """
        return self.world.check(pose, self._name)
