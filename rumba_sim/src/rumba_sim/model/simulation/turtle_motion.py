"""How a turtle moved between two poses that turtlesim published.

Turtlesim publishes a pose every 16 ms, with the velocity of the last frame but without a time. A turtle can be put
elsewhere at any moment, and a pose can get lost if the machine is busy; the distance between two poses shows which of
them happened.
"""

import math
from typing import List

from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle

FRAME_RATE = 62.5  # [Hz] rate of poses (turtlesim: a timer of 16 ms)
FRAME = 1.0 / FRAME_RATE  # [s]
PIXELS_PER_METRE = 45.0  # turtlesim: the height of the image of a turtle is one metre
MOST_LOST = 25  # poses in a row that may get lost, 0.4 s
FASTEST = 2.0  # [m/s] as turtle_teleop_key drives ...
FASTEST_TURN = 10.0  # [rad/s]; ... what a pose tells beyond these is not believed
ROUNDING = 1e-4  # [m], [rad] errors of float32 on a field of 11 m


class TurtleMotion:
    """Follows the poses of one turtle."""

    def __init__(self) -> None:
        """Start without a known pose."""
        self._pose = Pose(math.nan, math.nan, math.nan)
        self._speed = self._turn_rate = 0.0

    def driven(self, pose: Pose, speed: float, turn_rate: float) -> List[Pose]:
        """Poses of the turtle in each frame since the previous pose.

        Args:
            pose: pose now [m, rad].
            speed: speed in the last frame, in any direction [m/s].
            turn_rate: angular velocity in the last frame [rad/s].

        Returns:
            Poses that end with `pose`; empty if the turtle cannot have driven there, but was put there.
        """
        speed, turn_rate = min(abs(speed), FASTEST), min(max(turn_rate, -FASTEST_TURN), FASTEST_TURN)
        before, self._pose = self._pose, pose
        fastest, self._speed = max(speed, self._speed), speed
        turning, self._turn_rate = max(abs(turn_rate), self._turn_rate), abs(turn_rate)
        dx, dy, turn = pose.x - before.x, pose.y - before.y, wrap_angle(pose.theta - before.theta)
        distance = hypot(dx, dy)
        if distance <= speed * FRAME + ROUNDING and abs(wrap_angle(turn - turn_rate * FRAME)) <= ROUNDING:
            return [pose]  # the usual case: no pose got lost
        for frames in range(1, MOST_LOST + 2):
            if distance <= frames * fastest * FRAME + ROUNDING and abs(turn) <= frames * turning * FRAME + ROUNDING:
                return [Pose(before.x + share * dx, before.y + share * dy, wrap_angle(before.theta + share * turn))
                        for share in (frame / frames for frame in range(1, frames))] + [pose]
        return []
