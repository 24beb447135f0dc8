"""Where lasers are on a robot, by the transforms of tf."""

import math
from typing import Any, Callable, Dict, List, Optional, Tuple

import numpy as np
import rospy
from geometry_msgs.msg import Transform
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.mounting import CENTRE, Mounting

QUEUE = 100  # messages that may wait to be read
FARTHEST = 10.0  # [m] from the centre of a robot, at most
NORM = 0.01  # by which the square of the norm of a rotation may differ from 1
LEVEL = 0.985  # cosine of the angle by which a laser may be tilted, at least: 10 degrees
LONGEST = 16  # transforms from a laser to its robot, at most
Link = Tuple[str, Array, Array]  # frame, rotation (3, 3) and place (3) [m] of a child in it


class Mountings:
    """The transforms from frames to the robot's own, whether they are static or not.

    No transform of the odometry is followed, and the newest counts, whatever its stamp is: a laser does not move on a
    robot. A buffer of tf2 would keep those of everybody.
    """

    def __init__(self, base: str) -> None:
        """Know none; `base` is the frame of the robot."""
        self._base = base
        self._links: Dict[str, Link] = {}  # by child
        self._known: Dict[str, Mounting] = {}  # by frame

    def take(self, message: TFMessage) -> None:
        """Learn from a message."""
        for each in message.transforms:
            parent, child = each.header.frame_id.lstrip('/'), each.child_frame_id.lstrip('/')
            link = _link(parent, each.transform)
            if link is not None and child != self._base:
                self._links[child] = link
        self._known.clear()

    def of(self, scan: LaserScan) -> Optional[Mounting]:
        """How the laser of a scan is mounted; None if tf does not tell, or it is not level."""
        frame = scan.header.frame_id.lstrip('/')
        if frame in ('', self._base):
            return CENTRE
        known = self._known.get(frame)
        if known is None:
            placed = self._placed(frame)
            known = None if placed is None else _mounting(*placed)
            if known is not None:
                self._known[frame] = known
        return known

    def fault(self, scan: LaserScan) -> str:
        """Why `of` tells nothing."""
        frame = scan.header.frame_id.lstrip('/')
        if self._placed(frame) is None:
            return f'neither /tf_static nor /tf leads from {self._base} to {frame}'
        return f'by tf, {frame} is tilted against {self._base}: it must be level, or upside down'

    def _placed(self, frame: str) -> Optional[Tuple[Array, Array]]:
        """Rotation (3, 3) and place (3) of a frame in that of the robot; None if no transforms lead there."""
        rotation, place = np.eye(3), np.zeros(3)
        for _ in range(LONGEST):
            link = self._links.get(frame)
            if link is None:
                return None
            frame, turned, moved = link
            rotation, place = turned @ rotation, turned @ place + moved
            if frame == self._base:
                return rotation, place
        return None


class HeardMountings(Mountings):
    """Mountings by the messages of tf; listens to /tf only if /tf_static does not tell enough."""

    def __init__(self, base: str, on_change: Callable[[], None], fixed: Optional[Mounting] = None) -> None:
        """Listen; `on_change` is called in a thread of rospy; `fixed` is the mounting if tf need not tell it."""
        super().__init__(base)
        self._fixed = fixed
        self._on_change = on_change
        self._moving: Optional[rospy.Subscriber] = None
        rospy.Subscriber('/tf_static', TFMessage, self.take, queue_size=QUEUE)

    def take(self, message: TFMessage) -> None:
        """Learn from a message."""
        super().take(message)
        self._on_change()

    def of(self, scan: LaserScan) -> Optional[Mounting]:
        """How the laser of a scan is mounted; None if tf does not tell, or it is not level."""
        known = super().of(scan) if self._fixed is None else self._fixed
        if known is None and self._moving is None:
            self._moving = rospy.Subscriber('/tf', TFMessage, self.take, queue_size=QUEUE)
        return known


def _mounting(rotation: Array, place: Array) -> Optional[Mounting]:
    """How a laser is mounted; None if it is not level."""
    up = float(rotation[2, 2])
    if abs(up) < LEVEL:
        return None
    x, y = (_rounded(float(part)) for part in place[:2])
    return Mounting(x, y, _rounded(math.atan2(float(rotation[1, 0]), float(rotation[0, 0]))), up < 0.0)


def _rounded(number: float) -> float:
    """Without what the way by quaternions added: a laser in the centre is there, and not 1e-17 m beside it."""
    return round(number, 12) + 0.0


def _link(parent: str, transform: Transform) -> Optional[Link]:
    """A transform as matrices; None if its numbers make none, or lead too far away."""
    move, turn = transform.translation, transform.rotation
    place = np.array([move.x, move.y, move.z])
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    if not (np.abs(place) <= FARTHEST).all() or not abs(x * x + y * y + z * z + w * w - 1.0) <= NORM:
        return None
    rows: List[List[Any]] = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)]]
    return parent, np.array(rows), place
