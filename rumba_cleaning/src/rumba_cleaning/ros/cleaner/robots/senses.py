"""What one robot senses: its topics and tf, as the observations of its behaviours."""

import collections
import math
import threading
import time
from typing import Any, Callable, Deque, Dict, List, Optional, Tuple

import rospy
from sensor_msgs.msg import BatteryState, LaserScan

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_cleaning.ros.cleaner.robots.certainty import Certainty
from rumba_cleaning.ros.cleaner.robots.location import QUEUE, Location
from rumba_localisation.scan import SILENT, told
from rumba_msg.msg import Bumper, CleaningStatus, Cliff, DockStatus, Lockstep
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.frames import frames
from rumba_sim.ros.common.mountings import HeardMountings
from rumba_sim.ros.running.clock import LATEST

SECOND = 1_000_000_000  # [ns]
PAUSE = SECOND  # [ns] between two stamps; more is not counted as time: a pause in real time, or another simulator
CLOCK = 'dock_status'  # the simulator publishes it last
READING = {'bumper': Bumper, 'cliff': Cliff, 'dock_status': DockStatus}
TOPICS = *READING, 'battery_state', 'cleaning_status', 'scan', 'amcl_pose'  # what comes often, and is only noted
MOST = 100  # stamps that are kept until bumper and cliff have come, too


class Senses:
    """The newest of each topic of a robot.

    The simulator publishes bumper, cliff and dock_status with one stamp, but each topic comes in a thread of its own,
    and in any order: a reading is complete if a dock_status has come, which need not be the newest, and a bumper and a
    cliff that are not older. (If messages come in bursts, one topic is always ahead of the others.) A world in lockstep
    waits, so there a reading is complete if everything has come that was published up to its tick.

    Attributes:
        passed: [ns] of the robot's time by the stamps of readings, without pauses.
        stamp: of the newest complete reading; None before the first.
        heard: when any part of a reading came last, as a time of `time.monotonic`.
        cleaning: the newest CleaningStatus; None before the first.
    """

    def __init__(self, robot: str, on_reading: Callable[[], None],
                 lockstep: Callable[[], Optional[Tuple[str, int]]] = lambda: None, has_laser: bool = False,
                 is_mapless: bool = False) -> None:
        """Listen to a robot.

        Args:
            robot: its name.
            on_reading: called after each complete reading, in a thread of rospy.
            lockstep: run and resets of the world that is known, if it is in lockstep; else None.
            has_laser: whether observations have scans.
            is_mapless: whether the pose is that of the odometry, whatever localisation there is.
        """
        self._robot = robot
        self._on_reading = on_reading
        self._lockstep = lockstep
        self._lock = threading.Lock()
        self._newest: Dict[str, Any] = {}
        self._battery: Optional[BatteryState] = None
        self._scan: Optional[LaserScan] = None
        self._observed_scan: Optional[LaserScan] = None
        self._tick: Optional[Lockstep] = None
        self._since: Optional[rospy.Time] = None  # stamp until which messages are of a world that is gone
        self._observed: Optional[int] = None  # `passed` at the last observation [ns]
        self.passed = 0
        self.stamp: Optional[rospy.Time] = None
        self.heard = -math.inf
        self._unread: Deque[rospy.Time] = collections.deque(maxlen=MOST)  # of dock_status since then
        self.cleaning: Optional[CleaningStatus] = None
        self._location = Location(robot, self._check_in_lockstep, is_mapless)
        self._certainty = Certainty(robot, self._check_in_lockstep)
        self._has_laser = has_laser
        if has_laser:
            self._mountings = HeardMountings(frames(robot).base_link, self._check_in_lockstep)
            rospy.Subscriber(f'{robot}/scan', LaserScan, self._on_scan, queue_size=QUEUE)
        rospy.Subscriber(f'{robot}/battery_state', BatteryState, self._on_battery, queue_size=QUEUE)
        rospy.Subscriber(f'{robot}/cleaning_status', CleaningStatus, self._on_cleaning, queue_size=QUEUE)
        self._subscribers = {
            topic: rospy.Subscriber(f'{robot}/{topic}', kind, self._on_part, topic, queue_size=QUEUE)
            for topic, kind in READING.items()}

    def _on_battery(self, battery: BatteryState) -> None:
        with self._lock:
            if math.isfinite(battery.percentage) and not self._is_old(battery):
                self._battery = battery
        self._check_in_lockstep()

    def _on_scan(self, scan: LaserScan) -> None:
        with self._lock:
            if not self._is_old(scan):
                self._scan = scan
        self._check_in_lockstep()

    def _on_cleaning(self, cleaning: CleaningStatus) -> None:
        with self._lock:
            if not self._is_old(cleaning):
                self.cleaning = cleaning
        self._check_in_lockstep()

    def _on_part(self, message: Any, topic: str) -> None:
        with self._lock:
            self.heard = time.monotonic()
            if self._is_old(message):
                return
            self._newest[topic] = message
            if topic == CLOCK:
                self._unread.append(message.header.stamp)
        self.check()

    def on_tick(self, tick: Lockstep) -> None:
        """A control tick of a world in lockstep was published; may be called from any thread."""
        with self._lock:
            self._tick = tick
        self.check()

    def _check_in_lockstep(self) -> None:
        if self._lockstep() is not None:
            self.check()

    def check(self) -> None:
        """Look whether a reading has become complete; may be called from any thread."""
        with self._lock:
            stamp = self._complete()
            if stamp is None or stamp == self.stamp:
                return
            gap = (stamp - self.stamp).to_nsec() if self.stamp is not None else 0
            self.passed += gap if 0 < gap <= PAUSE else 0
            self.stamp = stamp
            while self._unread and self._unread.popleft() != stamp:
                pass
        self._on_reading()

    def _complete(self) -> Optional[rospy.Time]:
        """The stamp of the newest reading if it is complete, else None."""
        world, tick = self._lockstep(), self._tick
        if world is None:
            if len(self._newest) < len(READING):
                return None
            common = min(part.header.stamp for topic, part in self._newest.items() if topic != CLOCK)
            return next((stamp for stamp in reversed(self._unread) if stamp <= common), None)
        if tick is None or (tick.run, tick.resets) != world or not self._has_all(tick):
            return None
        return tick.header.stamp

    def _has_all(self, tick: Lockstep) -> bool:
        """Whether everything has come that was published up to a control tick; a stamp of 0: it is not published."""
        stamp = tick.header.stamp
        parts = [(self._newest.get(topic), stamp) for topic in READING]
        if self._has_laser:
            if self._scan is not None and self._mountings.of(self._scan) is None:
                return False
            parts.append((self._scan, tick.scan))
        location, certainty = self._location, self._certainty
        is_silent = location.silence(certainty.stamp) > SILENT  # then map -> odom is as old as the newest scan
        if certainty.is_told and (certainty.stamp < tick.scan or location.corrected < tick.scan and not is_silent):
            return False
        return location.stamp >= tick.odom and all(
            wanted.is_zero() or message is not None and message.header.stamp >= wanted
            for message, wanted in (*parts, (self._battery, stamp), (self.cleaning, tick.cleaning)))

    def _late(self) -> List[str]:
        """The topics that are missing for a complete reading."""
        if CLOCK not in self._newest:
            return [CLOCK]
        stamp = self._newest[CLOCK].header.stamp
        return [topic for topic in READING if topic not in self._newest or self._newest[topic].header.stamp < stamp]

    def _is_old(self, message: Any) -> bool:
        stamp = message.header.stamp
        return self._since is not None and not stamp.is_zero() and bool(stamp <= self._since)

    # --- what is known ----------------------------------------------------------------------------------------------

    def begin(self) -> None:
        """Make the next observation the first one, with dt 0."""
        self._observed = None

    def forget(self, since: rospy.Time, is_new_run: bool) -> None:
        """Know nothing of a world that is gone; `since` is the last stamp that may be of it.

        Args:
            since: stamp until which messages do not count; those without a stamp count.
            is_new_run: whether the simulator was started again. Then its time may start at 0 again, and all messages so
                far are forgotten; otherwise it was reset, its time continues, and messages after `since` count.
        """
        with self._lock:
            self._since = since
            earliest = rospy.Time(LATEST) if is_new_run else since
            self._newest = {topic: part for topic, part in self._newest.items() if part.header.stamp > earliest}
            self._battery, self.cleaning, self._scan = (
                message if message is not None and message.header.stamp > earliest else None
                for message in (self._battery, self.cleaning, self._scan))
            self._unread.clear()
            if CLOCK in self._newest:
                self._unread.append(self._newest[CLOCK].header.stamp)
            self.stamp = None
        if is_new_run:
            self._location.forget()
            self._certainty.forget()
        self.check()

    def observe(self) -> Optional[Observation]:
        """As `look`, with the time since the observation before, and the scan if there is a new one."""
        found, passed, scan = self.look(), self.passed, self._scan
        dt = passed - self._observed if self._observed is not None else 0
        self._observed = passed
        if found is None:
            return None
        is_new = scan is not None and scan is not self._observed_scan
        self._observed_scan = scan
        mounting = self._mountings.of(scan) if scan is not None and is_new else None
        return found._replace(dt=dt / SECOND, scan=None if mounting is None else told(scan, mounting))

    def look(self) -> Optional[Observation]:
        """What the robot knows now, with dt 0; None if something is missing."""
        with self._lock:
            parts, battery = dict(self._newest), self._battery
        pose = self.pose()
        if pose is None or battery is None or any(topic not in parts for topic in READING):
            return None
        covariance = self._certainty.covariance(parts[CLOCK].header.stamp)
        return conversions.observation(pose, parts['bumper'], parts['cliff'], parts['dock_status'], battery.percentage,
                                       covariance)._replace(silence=self._location.silence(self._certainty.stamp))

    def pose(self) -> Optional[Pose]:
        """The pose of the robot in the map frame; None if tf does not have it."""
        return self._location.pose()

    def missing(self) -> str:
        """What is missing for an observation, for a person."""
        if self._battery is None:
            return f'no charge: {self._robot}/battery_state has no percentage'
        if self.pose() is None:
            return f'no pose: tf has no {self._location}'
        return f'no reading: nothing new on {" and ".join(f"{self._robot}/{topic}" for topic in self._late())}'

    @property
    def unread(self) -> int:
        """How many times dock_status came since the newest complete reading, up to MOST."""
        return len(self._unread)

    @property
    def has_fallen(self) -> bool:
        """Whether a wheel hangs over a cliff."""
        cliff = self._newest.get('cliff')
        return cliff is not None and bool(cliff.is_wheel_dropped)

    @property
    def absence(self) -> str:
        """What is wrong if `is_alone` stays true, for a person."""
        return 'the robot is gone'

    @property
    def is_alone(self) -> bool:
        """Whether no node publishes what the robot senses."""
        return not any(subscriber.get_num_connections() for subscriber in self._subscribers.values())
