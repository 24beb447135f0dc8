"""Where a laser is on a robot."""

from typing import NamedTuple


class Mounting(NamedTuple):
    """A pose in the plane, and which side is up."""

    x: float = 0.0  # [m] ahead of the centre of the robot
    y: float = 0.0  # [m] to the left of it
    yaw: float = 0.0  # [rad] from straight ahead to the angle 0 of the laser
    upside_down: bool = False  # its angles grow clockwise


CENTRE = Mounting()
