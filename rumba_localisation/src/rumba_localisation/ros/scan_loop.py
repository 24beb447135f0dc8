"""What the nodes that look at scans share: each scan meets the odometry of its moment; lockstep is answered."""

import abc
import math
import time
from typing import Any, Optional

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from rumba_localisation.ros.odometries import Odometries
from rumba_localisation.scan import FARTHEST as FARTHEST_ECHO
from rumba_localisation.scan import SILENT, Reading, Scan, fault, told
from rumba_msg.msg import Lockstep
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.settings.own_robot import OwnRobot
from rumba_sim.ros.common.conversions import plane_pose, transform
from rumba_sim.ros.common.frames import MAP
from rumba_sim.ros.common.mountings import HeardMountings
from rumba_sim.ros.common.own_robots import frames_of
from rumba_sim.ros.participants.lockstep import Participant, Resent, Work
from rumba_sim.ros.participants.maps import FARTHEST
from rumba_sim.ros.participants.requests import Requests

PERIOD = 0.1  # [s] of the wall clock between two looks whether ROS shuts down
QUEUE = 100  # messages that may wait to be read
COMPLAINT_PERIOD = 10.0  # [s]
SKEWED = 0.05  # [rad] that a robot turns while a scan is taken, from which on walls are bent ...
LONGEST = 1.0  # [s] ... that a scan takes at most
SILENT_WALL = 0.2  # [s] of the wall clock, too, for which a silent laser tells nothing: scans may wait in a queue


class ScanLoop(abc.ABC):
    """A loop that owns all state; callbacks only queue what it is to do."""

    def __init__(self, robot: str, reading: Reading, own: Optional[OwnRobot] = None) -> None:
        """Listen to scans and odometry of a robot.

        Args:
            robot: its name.
            reading: how ranges are taken.
            own: what the robot is like if it is not ours.
        """
        self._name, self._reading = robot, reading
        self._frames = frames_of(robot, own)
        self._requests = Requests()
        self._work = Work()
        self._odometries = Odometries()
        self._waiting: Optional[LaserScan] = None  # for its odometry
        self._tick: Optional[Lockstep] = None  # that was not answered yet
        self._scanned = rospy.Time()  # stamp of the newest scan that was dealt with
        self._heard = time.monotonic()  # when the newest scan came
        self._range_max = FARTHEST_ECHO  # [m] of the newest scan
        self._begun = self._heard  # when the node began to wait
        self._has_odometry = self._has_scan = False  # whether any came
        self._newest = Resent()
        self._tf = rospy.Publisher('/tf', TFMessage, self._newest, queue_size=QUEUE)
        self._participant = Participant(lambda tick: self._post(tick, self._take_tick), lambda: self._work.goes_on)
        self._mountings = HeardMountings(self._frames.base_link, lambda: self._post(None, lambda _: self._look()),
                                         None if own is None else own.mounting)
        self._subscribe(f'{robot}/odom', Odometry, self._take_odom)
        self._subscribe(f'{robot}/scan', LaserScan, self._take_scan)

    def _subscribe(self, topic: str, kind: Any, take: Any) -> None:
        """Have the loop call `take` with each message of a topic."""
        rospy.Subscriber(topic, kind, self._post, take, queue_size=QUEUE)

    def _post(self, message: Any, take: Any) -> None:
        def work() -> None:
            with self._work:
                take(message)
        self._requests.post(work)

    def run(self) -> None:
        """Work until ROS shuts down."""
        self._work.rest()
        while not rospy.is_shutdown():
            self._requests.serve(time.monotonic() + PERIOD)
            self._complain()
        self._participant.leave()

    @property
    def _is_ready(self) -> bool:
        """Whether scans can be used."""
        return True

    @property
    def _not_ready(self) -> str:
        """Why scans cannot be used."""
        return ''

    @abc.abstractmethod
    def _use(self, scan: Scan, odometry: Pose, stamp: rospy.Time) -> None:
        """Called with each scan, where the robot was then by its odometry, and when that was."""

    def _reckon(self, odometry: Pose, stamp: rospy.Time) -> None:
        """Called with each odometry while the laser is silent."""

    def _take_odom(self, message: Odometry) -> None:
        pose = plane_pose(message.pose.pose)
        self._has_odometry = True
        if all(math.isfinite(number) and abs(number) <= FARTHEST for number in pose):
            self._odometries.add(message.header.stamp, pose)
            self._look()
            if self._silence(message.header.stamp) > SILENT and time.monotonic() - self._heard > SILENT_WALL:
                self._reckon(pose, message.header.stamp)

    def _take_scan(self, message: LaserScan) -> None:
        self._waiting, self._has_scan = message, True
        self._heard = time.monotonic()
        self._look()

    def _take_tick(self, tick: Lockstep) -> None:
        self._tick = tick
        self._answer()

    def _look(self) -> None:
        """Use the newest scan as soon as it is known where the robot was by odometry when it was taken."""
        scan = self._waiting
        if scan is None or not self._is_ready:
            return
        stamp, mounting = scan.header.stamp, self._mountings.of(scan)
        odometry = self._odometries.at(stamp)
        if mounting is None or odometry is None and not self._odometries.is_before(stamp):
            return
        self._waiting = None
        seen = told(scan, mounting, self._reading)
        if seen is None:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f'{self._name}/scan: {fault(scan)}; ignored')
        elif odometry is not None:
            self._range_max = min(scan.range_max, FARTHEST_ECHO)
            self._use(seen, odometry, stamp)
            self._name_skew(scan, odometry)
        self._scanned, self._begun = stamp, time.monotonic()
        self._answer()

    def _name_skew(self, scan: LaserScan, odometry: Pose) -> None:
        """Say once that walls are bent, if a robot turned as much as it did just now while a scan was taken."""
        duration, now = abs(scan.time_increment) * len(scan.ranges), scan.header.stamp.to_sec()
        if not 0.0 < duration <= min(LONGEST, now):
            return
        before = self._odometries.at(rospy.Time.from_sec(now - duration))
        turn = 0.0 if before is None else abs(wrap_angle(odometry.theta - before.theta))
        if turn > SKEWED:
            rospy.logwarn_once(f'{self._name}/scan: the robot turns by {turn:.2f} rad in the {duration:.2f} s that a '
                               'scan takes, which bends walls: turn slower, or correct the scans before')

    def _complain(self) -> None:
        """Say what is missing, if no scan could be used for some time since the node began."""
        if self._scanned.is_zero() and time.monotonic() - self._begun > COMPLAINT_PERIOD:
            self._begun = time.monotonic()
            rospy.logwarn(f'{rospy.get_name()} waits: {self._missing()}')

    def _missing(self) -> str:
        """What is missing for a scan that can be used."""
        if not self._is_ready:
            return self._not_ready
        silent = [topic for topic, is_heard in (('scan', self._has_scan), ('odom', self._has_odometry)) if not is_heard]
        if silent:
            return 'nothing came on ' + ' and '.join(rospy.resolve_name(f'{self._name}/{topic}') for topic in silent)
        scan = self._waiting
        if scan is not None and self._mountings.of(scan) is None:
            return self._mountings.fault(scan)
        return (f'no odometry is as new as the scan, which has stamp {scan.header.stamp.to_sec():.3f} s'
                if scan is not None else 'no scan is as new as the odometry')

    def _silence(self, stamp: rospy.Time) -> float:
        """Time from the newest scan to a stamp [s]; 0 before the first scan."""
        return 0.0 if self._scanned.is_zero() else float((stamp - self._scanned).to_sec())

    def _correct(self, correction: Pose, stamp: rospy.Time) -> None:
        """Publish map -> odom."""
        self._newest.message = TFMessage([transform(MAP, self._frames.odom, correction, stamp)])
        self._tf.publish(self._newest.message)

    def _answer(self) -> None:
        """In lockstep, tell that everything is done for the newest tick."""
        tick = self._tick
        if tick is not None and self._scanned >= tick.scan and not tick.scan.is_zero():
            self._tick = None
            self._participant.answer(tick.header.stamp)
