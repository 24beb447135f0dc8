"""Where a robot is, by the transforms of tf."""

from typing import Callable, Dict, Optional, Tuple

import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.ros.common.conversions import transform_pose
from rumba_sim.ros.common.frames import MAP, Frames, frames
from rumba_sim.ros.common.newest_transforms import NewestTransforms

QUEUE = 100  # messages that may wait to be read
FARTHEST = 1e6  # [m] of a coordinate, at most
NORM = 0.01  # by which the square of the norm of a rotation may differ from 1
COMPLAINT_PERIOD = 10.0  # [s]

TF, STATIC = '/tf', '/tf_static'
Link = Tuple[str, str]  # frame and child
Known = Tuple[Pose, bool]  # of the child in the frame, and whether it is static


class Location:
    """The newest map -> odom and the newest odom -> base_footprint of a robot.

    A localisation publishes later and less often than the odometry, and their stamps differ; so what came last counts,
    whatever its stamp is. A buffer of tf2 would hold on to the newest stamp, even to one of the far future, and keep
    the frames of everybody; some stamps and frames make it end the process.

    Attributes:
        stamp: of the newest odom -> base_footprint; 0 before the first.
        corrected: the same of map -> odom.
    """

    def __init__(self, robot: str, on_change: Callable[[], None], is_mapless: bool = False,
                 own_frames: Optional[Frames] = None) -> None:
        """Listen to the transforms of a robot.

        Args:
            robot: its name.
            on_change: called in a thread of rospy.
            is_mapless: whether the pose is that of the odometry: its frame is taken for that of the map.
            own_frames: those of a robot that is not ours; its odometry is told by `take_odometry`.
        """
        self.stamp = self.corrected = rospy.Time()
        self._on_change = on_change
        self._frames = frames(robot) if own_frames is None else own_frames
        self._links = (MAP, self._frames.odom), (self._frames.odom, self._frames.base_footprint)
        self._newest: Dict[Link, Known] = {self._links[0]: (Pose(0.0, 0.0, 0.0), True)} if is_mapless else {}
        self._listens_to = self._links[1:] if is_mapless else self._links if own_frames is None else self._links[:1]
        for topic in (TF, STATIC):
            rospy.Subscriber(topic, NewestTransforms, self._on_transforms, topic == STATIC, queue_size=QUEUE)

    def _on_transforms(self, message: TFMessage, is_static: bool) -> None:
        before = self.stamp, self.corrected
        last = {(each.header.frame_id.lstrip('/'), each.child_frame_id.lstrip('/')): each
                for each in message.transforms}
        for link in self._listens_to:
            each = last.get(link)
            if each is None:
                continue
            if is_valid(each):
                self._newest[link] = transform_pose(each.transform), is_static
                if link == self._links[1]:
                    self.stamp = each.header.stamp
                else:
                    self.corrected = each.header.stamp
            else:
                rospy.logwarn_throttle(COMPLAINT_PERIOD, f'tf has {" -> ".join(link)} with numbers that make no '
                                                         'pose: ignored')
        if before != (self.stamp, self.corrected):
            self._on_change()

    def take_odometry(self, pose: Pose, stamp: rospy.Time) -> None:
        """Take a pose by odometry that no transform tells."""
        self._newest[self._links[1]] = pose, False
        self.stamp = stamp

    def forget(self) -> None:
        """Know nothing of what was told of a time that is over; what is static was told once and for all."""
        self._newest = {link: known for link, known in self._newest.items() if known[1]}
        self.stamp = self.corrected = rospy.Time()

    def pose(self) -> Optional[Pose]:
        """The pose of the robot in the map frame; None if tf does not have it."""
        correction, odometry = map(self._newest.get, self._links)
        return compose(correction[0], odometry[0]) if correction is not None and odometry is not None else None

    def silence(self, stamp: rospy.Time) -> float:
        """How much older the newest map -> odom is than a stamp [s]; 0 if it is newer, or was told once and for all."""
        known = self._newest.get(self._links[0])
        return 0.0 if known is None or known[1] else max(float((stamp - self.corrected).to_sec()), 0.0)

    def __str__(self) -> str:
        return f'{MAP} -> {self._frames.odom} -> {self._frames.base_footprint}'


def is_valid(transform: TransformStamped) -> bool:
    """Whether the numbers of a transform are a pose: a position that is not too far, a rotation of norm 1."""
    position, rotation = transform.transform.translation, transform.transform.rotation
    norm = sum(part * part for part in (rotation.x, rotation.y, rotation.z, rotation.w))
    return (all(abs(part) <= FARTHEST for part in (position.x, position.y, position.z))  # NaN is not
            and abs(norm - 1.0) <= NORM)
