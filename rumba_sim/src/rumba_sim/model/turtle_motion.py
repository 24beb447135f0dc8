"""What turtlesim's poses tell of the way between them.

Turtlesim tells a pose every 16 ms, with the velocity that led there, and no time. A turtle can be put elsewhere at
any moment, and a pose can get lost where the machine is busy: the way between two poses tells which it was.
"""

import math
from typing import List

from rumba_sim.model.geometry import Pose, wrap_angle

FRAME_RATE = 62.5  # [Hz] of poses (turtlesim: a timer of 16 ms)
FRAME = 1.0 / FRAME_RATE  # [s]
PIXELS_PER_METRE = 45.0  # turtlesim: the height of a turtle's picture is a metre of its field
MOST_LOST = 25  # poses in a row that may get lost: 0.4 s
ROUNDING = 1e-4  # [m], [rad] between poses in float32 of a field of 11 m


class TurtleMotion:
    """Follows the poses of one turtle."""

    def __init__(self) -> None:
        """Nothing is known."""
        self._pose = Pose(math.nan, math.nan, math.nan)
        self._speed = self._turn_rate = 0.0

    def driven(self, pose: Pose, speed: float, turn_rate: float) -> List[Pose]:
        """Where the turtle was in each frame since the pose before, `pose` last; empty where it cannot have driven.

        Args:
            pose: where it is [m, rad].
            speed: how fast it went in the frame that ended there, in whatever direction [m/s].
            turn_rate: and how fast it turned [rad/s].
        """
        before, self._pose = self._pose, pose
        fastest, self._speed = max(abs(speed), self._speed), abs(speed)
        turning, self._turn_rate = max(abs(turn_rate), self._turn_rate), abs(turn_rate)
        dx, dy, turn = pose.x - before.x, pose.y - before.y, wrap_angle(pose.theta - before.theta)
        way = math.hypot(dx, dy)
        if way <= abs(speed) * FRAME + ROUNDING and abs(wrap_angle(turn - turn_rate * FRAME)) <= ROUNDING:
            return [pose]  # as nearly all
        for frames in range(1, MOST_LOST + 2):
            if way <= frames * fastest * FRAME + ROUNDING and abs(turn) <= frames * turning * FRAME + ROUNDING:
                return [Pose(before.x + share * dx, before.y + share * dy, wrap_angle(before.theta + share * turn))
                        for share in (frame / frames for frame in range(1, frames))] + [pose]
        return []
