"""What check_robot hears of each topic."""

import math
from typing import TYPE_CHECKING, Any, List, Optional, Set, Tuple

import numpy as np
import roslib.message
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from rumba_cleaning.own_robot.agreement import STANDS, Agreement
from rumba_cleaning.own_robot.heard import OdometryHeard, ScanHeard, Topic, View
from rumba_localisation.scan import thinned, told
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.settings.own_robot import OwnRobot
from rumba_sim.ros.common.conversions import plane_pose
from rumba_sim.ros.common.frames import MAP
from rumba_sim.ros.common.mountings import Mountings

if TYPE_CHECKING:
    from rumba_cleaning.ros.own_robot.check_robot import Seen

QUEUE = 100  # messages that may wait to be read
NORM = 0.01  # by which the square of the norm of a quaternion may differ from 1
FAR_WAY, FAR_TURN, MOST, BEAMS = 0.04, 0.1, 20, 120  # [m], [rad] from view to view; views; points of each
GAP = 0.3  # [s] from one odometry to the next, at most, between which a pose is known


class TopicListener:
    """When messages of any type come on a topic."""

    def __init__(self, name: str) -> None:
        """Listen."""
        self.name = rospy.resolve_name(name)
        self._times: List[float] = []  # [s]
        rospy.Subscriber(self.name, rospy.AnyMsg, self._on_message, queue_size=QUEUE)

    def topic(self, seen: 'Seen') -> Topic:
        """What was heard."""
        times = self._times
        passed = times[-1] - times[0] if times else 0.0
        return seen.topic(self.name, (len(times) - 1) / passed if passed > 0.0 else float(bool(times)))

    def _on_message(self, message: Any) -> None:
        self._times.append(rospy.get_time())
        self._read(message)

    def _read(self, message: Any) -> None:
        """Look into a message."""

    @staticmethod
    def _as(kind: Any, message: Any) -> Any:
        """A message of a class; None if it is of another type."""
        if message._connection_header['type'] != kind._type:
            return None
        found = kind()
        found.deserialize(message._buff)
        return found


class ModeListener(TopicListener):
    """The mode of a Create."""

    def __init__(self, name: str) -> None:
        """Listen."""
        self.mode: Optional[int] = None  # the newest
        super().__init__(name)

    def _read(self, message: Any) -> None:
        kind = roslib.message.get_message_class(message._connection_header['type'])
        told = None if kind is None else self._as(kind, message)
        self.mode = getattr(told, 'mode', None)


class OdometryListener(TopicListener):
    """The odometry, and what tf tells of its frames."""

    def __init__(self, name: str, own: OwnRobot) -> None:
        """Listen."""
        self._own = own
        self._base = own.frames.base.lstrip('/')
        self._message: Optional[Odometry] = None
        self._ages: List[float] = []
        self._is_valid = True
        self._faults: Set[str] = set()
        self._stands = 0  # messages
        self._links: Set[Tuple[str, str]] = set()
        self._map_odom: Set[str] = set()
        self._poses: List[Tuple[float, Pose]] = []
        self.agreement = Agreement()
        super().__init__(name)
        for topic in ('/tf', '/tf_static'):
            rospy.Subscriber(topic, TFMessage, self._take_tf, queue_size=QUEUE)

    def _take_tf(self, message: Any) -> None:
        for each in message.transforms:
            link = each.header.frame_id.lstrip('/'), each.child_frame_id.lstrip('/')
            self._links.add(link)
            if link == (MAP, self._own.frames.odom.lstrip('/')):
                self._map_odom.add(message._connection_header['callerid'])

    def _read(self, message: Any) -> None:
        odometry = self._as(Odometry, message)
        if odometry is None:
            return
        self._message, stamp = odometry, odometry.header.stamp.to_sec()
        self._ages.append(rospy.get_time() - stamp)
        pose, turn = plane_pose(odometry.pose.pose), odometry.pose.pose.orientation
        norm = turn.x ** 2 + turn.y ** 2 + turn.z ** 2 + turn.w ** 2
        if not all(map(math.isfinite, pose)) or abs(norm - 1.0) > NORM:
            self._is_valid = False
            return
        self._poses.append((stamp, pose))
        fault = self.agreement.observe(pose, stamp)
        if fault:
            self._faults.add(fault)

    def heard(self) -> Optional[OdometryHeard]:
        """What it said; None if none came."""
        message = self._message
        if message is None:
            return None
        child = message.child_frame_id.lstrip('/')
        fault = next((each for each in sorted(self._faults) if each != STANDS), STANDS if self._faults else '')
        return OdometryHeard(message.header.frame_id.lstrip('/'), child, tuple(self._ages), self._is_valid, fault,
                             self.agreement.is_tested, child in ('', self._base) or self._are_linked(child))

    def _are_linked(self, child: str) -> bool:
        """Whether transforms lead from a frame to the base, in whatever direction."""
        known, odom = {child}, self._own.frames.odom.lstrip('/')
        for _ in self._links:
            known |= {frame for link in self._links if odom not in link and known & set(link) for frame in link}
        return self._base in known

    def map_odom(self) -> Tuple[str, ...]:
        """Nodes that tell map -> odom."""
        return tuple(sorted(self._map_odom))

    def at(self, stamp: float) -> Optional[Pose]:
        """The pose at a time [s]; None if it is not known."""
        times = np.array([when for when, _ in self._poses])
        index = int(np.searchsorted(times, stamp))
        if index == len(times) or index == 0 and times[0] != stamp or times[index] - times[max(index - 1, 0)] > GAP:
            return None
        (x, y, theta), (to_x, to_y, to_theta) = self._poses[max(index - 1, 0)][1], self._poses[index][1]
        before = times[max(index - 1, 0)]
        share = 1.0 if times[index] == before else (stamp - before) / (times[index] - before)
        return Pose(x + share * (to_x - x), y + share * (to_y - y), theta + share * wrap_angle(to_theta - theta))


class ScanListener(TopicListener):
    """The scan, and where tf says that its laser is."""

    def __init__(self, name: str, own: OwnRobot, odometry: OdometryListener) -> None:
        """Listen."""
        self._own, self._odometry = own, odometry
        self._scans: List[LaserScan] = []
        self._ages: List[float] = []
        self._mountings = Mountings(own.frames.base.lstrip('/'))
        super().__init__(name)
        for topic in ('/tf', '/tf_static'):
            rospy.Subscriber(topic, TFMessage, self._mountings.take, queue_size=QUEUE)

    def _read(self, message: Any) -> None:
        scan = self._as(LaserScan, message)
        if scan is not None:
            self._scans.append(scan)
            self._ages.append(rospy.get_time() - scan.header.stamp.to_sec())

    def heard(self) -> Optional[ScanHeard]:
        """What it said; None if none came."""
        if not self._scans:
            return None
        scan = self._scans[-1]
        by_tf = self._mountings.of(scan)
        return ScanHeard(scan.header.frame_id.lstrip('/'), tuple(self._ages), np.array(scan.ranges, np.float64),
                         by_tf if self._own.mounting is None else self._own.mounting, by_tf,
                         '' if by_tf is not None else self._mountings.fault(scan))

    def views(self) -> List[View]:
        """Some of them, with the poses of their odometry: those between which the robot moved, and the last."""
        found: List[View] = []
        for scan in self._scans:
            pose = self._odometry.at(scan.header.stamp.to_sec())
            if pose is None or found and scan is not self._scans[-1] and not _is_far(pose, found[-1].pose):
                continue
            seen = told(scan)
            if seen is not None and len(seen.points):
                found.append(View(pose, thinned(seen.points, BEAMS)))
        return [found[index] for index in np.unique(np.linspace(0, len(found) - 1, MOST).astype(int))] if found else []


def _is_far(pose: Pose, last: Pose) -> bool:
    return (hypot(pose.x - last.x, pose.y - last.y) > FAR_WAY or abs(wrap_angle(pose.theta - last.theta)) > FAR_TURN)


class CommandListener(TopicListener):
    """What the robot is commanded, by whomever."""

    def __init__(self, name: str, odometry: OdometryListener) -> None:
        """Listen."""
        self._agreement = odometry.agreement
        super().__init__(name)

    def _read(self, message: Any) -> None:
        command = self._as(Twist, message)
        if command is not None:
            self._agreement.command(command.linear.x, command.angular.z)
