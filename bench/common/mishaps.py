"""What may befall a robot on a mission: its laser is silent for a while, or its wheels slip."""

import math

from rumba_cleaning.pose_source import due_scan
from rumba_sim.model.simulation.world import World

TRUE, COUNTED = ('x', 'y', 'theta'), ('odom_x', 'odom_y', 'odom_theta')  # fields of the record of a robot
MOVING = 0.1  # [m/s] of a wheel: slip begins when the robot moves


class SilentLaser:
    """The laser of the robot of a trial tells nothing for a while.

    Attributes:
        begun, ended: when [s].
    """

    def __init__(self, trial, due, seconds):
        """Silence the laser from a time on [s], for so many seconds."""
        self.begun, self.ended = due, due + seconds
        trial.sources['rumba'].scans = self._scan

    def _scan(self, world, name):
        return None if self.begun <= world.time < self.ended else due_scan(world, name)


class Slip:
    """Wheels slip while the robot moves: they turn and it does not move, or it slides and they do not turn.

    Attributes:
        begun, ended: when [s]; inf before.
    """

    def __init__(self, trial, due, seconds, slides):
        """Have the wheels slip from a time on [s], as soon as the robot moves, for so many seconds.

        Args:
            trial: whose robot it befalls.
            slides: whether the robot moves and its wheels do not; else the other way round.
        """
        self.begun = self.ended = math.inf
        self._world, self._due, self._seconds = trial.world, due, seconds
        self._held = COUNTED if slides else TRUE
        trial.advance = self._advance

    def _advance(self, ticks):
        world: World = self._world
        robot = world.robots['rumba']
        for _ in range(ticks):
            if self.begun == math.inf and world.time >= self._due and not robot.is_docked and (
                    abs(robot.twist.v) + abs(robot.twist.w) * 0.5 * robot.config.drive.wheel_base > MOVING):
                self.begun, self.ended = world.time, world.time + self._seconds
            is_slipping = self.begun <= world.time < self.ended
            held = [float(robot.state[name]) for name in self._held]
            world.step()
            if is_slipping:
                for name, value in zip(self._held, held):
                    robot.state[name] = value
