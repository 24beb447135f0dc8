"""What a robot senses that is not ours: its odometry and its scan, and of bumper, cliffs and charge what it has."""

import math
import threading
import time
from typing import Callable, Optional

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.ros.cleaner.robots.certainty import Certainty
from rumba_cleaning.ros.cleaner.robots.location import QUEUE, Location
from rumba_cleaning.ros.cleaner.robots.optional_inputs import OptionalInputs
from rumba_cleaning.ros.cleaner.robots.senses import PAUSE, SECOND, Senses
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.own_robot import OwnRobot
from rumba_sim.model.simulation.robot import Infrared
from rumba_sim.ros.common.conversions import plane_pose
from rumba_sim.ros.common.mountings import HeardMountings
from rumba_sim.ros.common.own_robots import frames_of
from rumba_sim.ros.participants.maps import FARTHEST

LEAST_GAP = SECOND // 20  # [ns] between two readings: behaviours need no more, and some odometries come at 1 kHz
SILENT = 1.0  # [s] of the robot's time without odometry


class OwnSenses(Senses):
    """The odometry is the clock: each is a reading, with the newest of all else.

    It has no figures of the floor, which only a simulator tells.
    """

    def __init__(self, robot: str, on_reading: Callable[[], None], own: OwnRobot, has_laser: bool) -> None:
        """Listen to a robot.

        Args:
            robot: its name, below which the topics are that are not remapped.
            on_reading: called after each reading, in a thread of rospy.
            own: what it is like.
            has_laser: whether observations have scans.
        """
        self._robot, self._on_reading, self._has_laser = robot, on_reading, has_laser
        self._lock = threading.Lock()
        self._scan: Optional[LaserScan] = None
        self._observed_scan: Optional[LaserScan] = None
        self._observed: Optional[int] = None
        self.passed = 0
        self.stamp = None
        self.heard = -math.inf
        self.cleaning = None
        self._heard_at = rospy.Time()  # by the robot's time
        self._is_stuck = False  # the newest odometry has the stamp of one before
        frames = frames_of(robot, own)
        self._location = Location(robot, lambda: None, own_frames=frames)
        self._certainty = Certainty(robot, lambda: None)
        self._inputs = OptionalInputs(robot).state
        if has_laser:
            self._mountings = HeardMountings(frames.base_link, lambda: None, own.mounting)
            rospy.Subscriber(f'{robot}/scan', LaserScan, self._on_scan, queue_size=QUEUE)
        self._odometry = rospy.Subscriber(f'{robot}/odom', Odometry, self._on_odometry, queue_size=QUEUE)

    def _on_scan(self, scan: LaserScan) -> None:
        self._scan = scan

    def _on_odometry(self, message: Odometry) -> None:
        pose, stamp = plane_pose(message.pose.pose), message.header.stamp
        if not all(math.isfinite(number) and abs(number) <= FARTHEST for number in pose):
            return
        with self._lock:
            gap = (stamp - self.stamp).to_nsec() if self.stamp is not None else LEAST_GAP
            self._is_stuck = gap == 0
            if self._is_stuck:
                return
            self.heard, self._heard_at = time.monotonic(), rospy.Time.now()
            self._location.take_odometry(pose, stamp)
            if 0 < gap < LEAST_GAP:
                return
            if self.stamp is not None and 0 < gap <= PAUSE:
                self.passed += gap
            self.stamp = stamp
            self._inputs.now = stamp.to_sec()
        self._on_reading()

    def check(self) -> None:
        """A reading is complete when it comes."""

    def forget(self, since: rospy.Time, is_new_run: bool) -> None:
        """Do nothing: there is no simulator that could start again."""

    def look(self) -> Optional[Observation]:
        """What the robot knows now, with dt 0; None if something is missing."""
        pose, stamp = self.pose(), self.stamp
        if pose is None or stamp is None:
            return None
        inputs = self._inputs
        return Observation(
            dt=0.0, pose=pose, bumper=inputs.bumper, cliffs=inputs.cliffs, state_of_charge=inputs.charge,
            is_docked=inputs.is_docked, infrared=Infrared(*inputs.infrared),
            covariance=self._certainty.covariance(stamp),
            silence=self._location.silence(self._certainty.stamp))

    def pose(self) -> Optional[Pose]:
        """The pose of the robot in the map frame; None if it is not known."""
        return self._location.pose()

    def missing(self) -> str:
        """What is missing for an observation, for a person."""
        if self.stamp is None or self._is_silent:
            return self.absence
        return f'no pose: tf has no {self._location}: no localiser or mapper publishes it'

    @property
    def absence(self) -> str:
        """What is wrong if `is_alone` is true."""
        if not self._odometry.get_num_connections():
            return f'no odometry: no node publishes {self._odometry.resolved_name}'
        if self._is_stuck:
            return f'no odometry: the stamps of {self._odometry.resolved_name} stay the same'
        return f'no odometry: nothing came on {self._odometry.resolved_name}, although a node publishes it'

    @property
    def unread(self) -> int:
        """None: a reading is complete when it comes."""
        return 0

    @property
    def has_fallen(self) -> bool:
        """Whether a wheel hangs in the air."""
        return self._inputs.has_fallen

    @property
    def is_alone(self) -> bool:
        """Whether no odometry comes."""
        return not self._odometry.get_num_connections() or self._is_silent

    @property
    def _is_silent(self) -> bool:
        return float((rospy.Time.now() - self._heard_at).to_sec()) > SILENT
