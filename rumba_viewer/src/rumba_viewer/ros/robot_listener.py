"""Listens to one robot. Callbacks run in threads of rospy and only store; the window asks when it paints."""

import math
import time
from typing import Any, Callable, Dict, Iterable, Optional, Tuple

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid, Odometry
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import BatteryState, LaserScan

from rumba_msg.msg import BatteryStatus, Bumper, CleanActionResult, CleaningStatus, Cliff, MissionStatus, Outcome
from rumba_sim.model.geometry import Pose
from rumba_sim.ros.common.conversions import plane_pose
from rumba_viewer.scene.snapshot import YIELDING, Array, Battery, Cleaning, Mission, Robot, Size
from rumba_viewer.scene.track import Glide, Trail

ALWAYS = {'battery_status': BatteryStatus, 'battery_state': BatteryState, 'bumper': Bumper, 'cliff': Cliff,
          'cleaning_status': CleaningStatus, 'mission_status': MissionStatus}
LARGE = {'coverage': numpy_msg(OccupancyGrid), 'scan': numpy_msg(LaserScan)}  # only while they are shown
STATES = {**{getattr(MissionStatus, name): name.lower().replace('_', ' ') for name in (
    'IDLE', 'UNDOCKING', 'CLEANING', 'RETURNING', 'DOCKING', 'CHARGING', 'GOING_TO', 'STRANDED')},
    MissionStatus.YIELDING: YIELDING}
SUPPLIES = {BatteryState.POWER_SUPPLY_STATUS_CHARGING: 'charging', BatteryState.POWER_SUPPLY_STATUS_FULL: 'full',
            BatteryState.POWER_SUPPLY_STATUS_DISCHARGING: 'on battery'}
WITHOUT_GOAL = (MissionStatus.IDLE, MissionStatus.STRANDED)
RECENT = 32  # poses that are kept, to find that of a scan
INTERRUPTED = (Outcome.CANCELLED, Outcome.PREEMPTED)


class RobotListener:
    """Listens to one robot.

    Attributes:
        stamp: of the newest ground_truth [s]; None before the first.
        came: when that came, on the wall clock [s].
    """

    def __init__(self, name: str, on_news: Callable[[], None]) -> None:
        """Listen to a robot by its name; `on_news` is called when there is something new to show."""
        self._name = name
        self._on_news = on_news
        self._newest: Dict[str, Any] = {}  # message by topic; threads set, get and pop, none iterates
        self._can_resume: Optional[bool] = None
        self._trail, self._glide = Trail(), Glide()
        self._recent: Tuple[Tuple[float, Pose], ...] = ()  # the last poses with their stamps [s]; replaced as a whole
        self.stamp: Optional[float] = None
        self.came = -math.inf
        self._subscribers: Dict[str, rospy.Subscriber] = {}
        for topic, kind in ALWAYS.items():
            self._subscribe(topic, kind)
        self._truth = rospy.Subscriber(f'{name}/ground_truth', Odometry, self._on_truth, queue_size=10)
        self._results = rospy.Subscriber(f'{name}/clean/result', CleanActionResult, self._on_result, queue_size=10)

    def close(self) -> None:
        """Stop listening."""
        for subscriber in (self._truth, self._results, *self._subscribers.values()):
            subscriber.unregister()

    def subscribe_large(self, topics: Iterable[str]) -> None:
        """Listen to these of the LARGE topics, and not to the others."""
        for topic, kind in LARGE.items():
            if topic in topics and topic not in self._subscribers:
                self._subscribe(topic, kind)
            elif topic not in topics and topic in self._subscribers:
                self._subscribers.pop(topic).unregister()
                self._newest.pop(topic, None)
                self._on_news()

    def _subscribe(self, topic: str, kind: Any) -> None:
        self._subscribers[topic] = rospy.Subscriber(
            f'{self._name}/{topic}', kind, lambda message: self._store(topic, message), queue_size=1)

    # --- callbacks ----------------------------------------------------------------------------------------------------

    def _store(self, topic: str, message: Any) -> None:
        before = self._newest.get(topic)
        self._newest[topic] = message
        if topic == 'cleaning_status' and before is not None and message.distance < before.distance:
            self._trail.clear()  # the simulator was reset
        self._on_news()

    def _on_truth(self, message: Odometry) -> None:
        stamp = message.header.stamp.to_sec()
        if self.stamp is not None and stamp < self.stamp:  # another simulation has started
            self.forget()
        pose = plane_pose(message.pose.pose)
        self.stamp, self.came = stamp, time.monotonic()
        self._recent = (*self._recent[1 - RECENT:], (stamp, pose))
        self._trail.add(pose)
        self._glide.add(pose, self.came)
        self._on_news()

    def _on_result(self, message: CleanActionResult) -> None:
        """A cleaning ended; one that was refused never began, and leaves the last one as it is."""
        code = message.result.outcome.code
        if code != Outcome.REFUSED:
            self._can_resume = code in INTERRUPTED
            self._on_news()

    def forget(self) -> None:
        """Forget what belongs to another simulation or map."""
        self._trail.clear()
        self._glide, self._recent = Glide(), ()
        self._newest.pop('coverage', None)

    # --- what the window asks -----------------------------------------------------------------------------------------

    @property
    def is_connected(self) -> bool:
        """Whether a node publishes its ground_truth."""
        return _is_connected(self._truth)

    @property
    def coverage(self) -> Any:
        """The newest OccupancyGrid of the swept floor; None if there is none."""
        return self._newest.get('coverage')

    def is_moving(self, now: float) -> bool:
        """Whether it will be painted elsewhere a moment later, even without a new reading."""
        return self._glide.is_under_way(now)

    def robot(self, now: float, size: Size) -> Optional[Robot]:
        """What is known of it at a time of the wall clock [s]; None before the first reading."""
        pose = self._glide.at(now)
        if pose is None:
            return None
        newest = self._newest.get
        status, bumper, cliff = newest('battery_status'), newest('bumper'), newest('cliff')
        has_cleaner = _is_connected(self._subscribers['mission_status'])
        if not has_cleaner:
            self._can_resume = None
        return Robot(
            self._name, pose, size,
            bumper=(bumper.is_left_pressed, bumper.is_right_pressed) if bumper else (False, False),
            has_fallen=cliff is not None and cliff.is_wheel_dropped,
            brushes_up=status.brushes_up if status else None, message=status.debug_message if status else '',
            battery=_battery(newest('battery_state')), cleaning=_cleaning(newest('cleaning_status')),
            mission=_mission(newest('mission_status')) if has_cleaner else None, path=self._trail.path,
            beams=self._beams(), has_cleaner=has_cleaner, can_resume=self._can_resume)

    def _beams(self) -> Optional[Array]:
        """Ends of the laser's beams (n, 2) [m], seen from where the robot was when it measured them."""
        scan, recent = self._newest.get('scan'), self._recent
        if scan is None or not recent:
            return None
        stamp: float = scan.header.stamp.to_sec()
        _, pose = min(recent, key=lambda one: abs(one[0] - stamp))
        return _ends(scan, pose)


def _is_connected(subscriber: rospy.Subscriber) -> bool:
    """Whether a node publishes to it; it has no `impl` any more if another thread has unregistered it."""
    impl = subscriber.impl
    return impl is not None and impl.get_num_connections() > 0


def _battery(state: Optional[BatteryState]) -> Optional[Battery]:
    if state is None:
        return None
    return Battery(state.percentage, state.voltage, state.current, SUPPLIES.get(state.power_supply_status, ''))


def _cleaning(status: Optional[CleaningStatus]) -> Optional[Cleaning]:
    if status is None:
        return None
    return Cleaning(status.coverage, status.cleaned_area, status.reachable_area, status.dirt, status.distance)


def _mission(status: Optional[MissionStatus]) -> Optional[Mission]:
    if status is None:
        return None
    return Mission(STATES.get(status.state, '?'), status.state not in WITHOUT_GOAL, status.strategy, status.message)


def _ends(scan: Any, pose: Pose) -> Array:
    """Ends of the beams (n, 2) [m] from a pose: at range_max if nothing was hit, at the pose if it was too near."""
    ranges = np.clip(np.nan_to_num(scan.ranges.astype(float), nan=0.0), 0.0, scan.range_max)
    angles = pose.theta + scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
    return np.stack([pose.x + ranges * np.cos(angles), pose.y + ranges * np.sin(angles)], axis=1)
