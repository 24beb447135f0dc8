"""Sums over the time in which a robot drives."""

from rumba_cleaning.control import CONTROL_DT
from rumba_sim.model.common.geometry import wrap_angle
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.simulation.robot import Robot
from rumba_sim.model.simulation.world import World

OVERLAP = 0.001  # [m] of body and wall that can come from rounding
HOUR = 3600.0  # [s]


class Meter:
    """Sums of one robot, updated at the control rate.

    Attributes:
        turned: rotation [rad], left and right added up.
        charge: out of the battery [Ah], at a drain of 1.
        energy: the same [Wh].
        penetrated: whether the robot was inside a wall or an obstacle.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        """Begin with nothing."""
        self._world = world
        self._robot = robot
        self._theta = robot.pose.theta
        self._least_clearance = robot.config.drive.radius - OVERLAP
        self.turned = 0.0
        self.charge = 0.0
        self.energy = 0.0
        self.penetrated = False

    def update(self) -> None:
        """A control step has passed."""
        pose, battery = self._robot.pose, self._robot.battery
        self.turned += abs(wrap_angle(pose.theta - self._theta))
        self._theta = pose.theta
        if battery.current < 0.0:
            charge = -battery.current * CONTROL_DT / HOUR
            self.charge += charge
            self.energy += battery.voltage * charge
        self.penetrated |= self._is_in_wall(pose.x, pose.y) or bool(
            self._world.obstacles.near(pose.x, pose.y, self._least_clearance))

    def _is_in_wall(self, x: float, y: float) -> bool:
        """Whether a robot at a point [m] overlaps a wall: by the exact distance, if the interpolated one is small."""
        world = self._world
        return world.terrain.clearance_at(x, y) < self._least_clearance and fast.wall_distance(
            world.constants[0], world.terrain.clearance, world.floor.cells, x, y) < self._least_clearance
