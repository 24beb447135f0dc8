"""What one robot says. Callbacks run in threads of rospy and only store; the window asks when it paints."""

import math
import time
from typing import Any, Callable, Dict, Iterable, Optional

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid, Odometry
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import BatteryState, LaserScan

from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, MissionStatus
from rumba_sim.ros.common.conversions import place
from rumba_viewer.scene.snapshot import Array, Battery, Cleaning, Mission, Robot, Size
from rumba_viewer.scene.track import Glide, Trail

ALWAYS = {'battery_status': BatteryStatus, 'battery_state': BatteryState, 'bumper': Bumper,
          'cleaning_status': CleaningStatus, 'mission_status': MissionStatus}
AT_TIMES = {'coverage': numpy_msg(OccupancyGrid), 'scan': numpy_msg(LaserScan)}  # large: only while they are shown
STATES = {getattr(MissionStatus, name): name.lower().replace('_', ' ') for name in (
    'IDLE', 'UNDOCKING', 'CLEANING', 'RETURNING', 'DOCKING', 'CHARGING', 'GOING_TO', 'STRANDED')}
SUPPLIES = {BatteryState.POWER_SUPPLY_STATUS_CHARGING: 'charging', BatteryState.POWER_SUPPLY_STATUS_FULL: 'full',
            BatteryState.POWER_SUPPLY_STATUS_DISCHARGING: 'on battery'}
AT_REST = (MissionStatus.IDLE, MissionStatus.STRANDED)


class RobotEar:
    """Listens to one robot.

    Attributes:
        stamp: of the newest ground_truth [s]; None before the first.
        came: when that came, on the wall clock [s].
    """

    def __init__(self, name: str, on_news: Callable[[], None]) -> None:
        """Listen to a robot by its name; `on_news` is called whenever there is something new to show."""
        self._name = name
        self._on_news = on_news
        self._said: Dict[str, Any] = {}
        self._trail, self._glide = Trail(), Glide()
        self.stamp: Optional[float] = None
        self.came = -math.inf
        self._truth = rospy.Subscriber(f'{name}/ground_truth', Odometry, self._on_truth, queue_size=10)
        self._subscribers: Dict[str, rospy.Subscriber] = {}
        for topic, kind in ALWAYS.items():
            self._listen(topic, kind)

    def close(self) -> None:
        """Listen no longer."""
        for subscriber in (self._truth, *self._subscribers.values()):
            subscriber.unregister()

    def attend(self, topics: Iterable[str]) -> None:
        """Listen to these of AT_TIMES, and to no others of them."""
        for topic, kind in AT_TIMES.items():
            if topic in topics and topic not in self._subscribers:
                self._listen(topic, kind)
            elif topic not in topics and topic in self._subscribers:
                self._subscribers.pop(topic).unregister()
                self._said.pop(topic, None)
                self._on_news()

    def _listen(self, topic: str, kind: Any) -> None:
        self._subscribers[topic] = rospy.Subscriber(
            f'{self._name}/{topic}', kind, lambda message: self._store(topic, message), queue_size=1)

    # --- callbacks ----------------------------------------------------------------------------------------------------

    def _store(self, topic: str, message: Any) -> None:
        before = self._said.get(topic)
        self._said[topic] = message
        if topic == 'cleaning_status' and before is not None and message.distance < before.distance:
            self._trail.clear()  # the world was reset
        self._on_news()

    def _on_truth(self, message: Odometry) -> None:
        stamp = message.header.stamp.to_sec()
        if self.stamp is not None and stamp < self.stamp:  # another world has begun
            self.forget()
        pose = place(message.pose.pose)
        self.stamp, self.came = stamp, time.monotonic()
        self._trail.add(pose)
        self._glide.add(pose, self.came)
        self._on_news()

    def forget(self) -> None:
        """Another world has begun: what was said of the old one is not true any more."""
        self._trail.clear()
        self._glide = Glide()
        self._said.pop('coverage', None)

    # --- what the window asks -----------------------------------------------------------------------------------------

    @property
    def is_connected(self) -> bool:
        """Whether somebody publishes where it is."""
        return bool(self._truth.get_num_connections())

    @property
    def coverage(self) -> Any:
        """The newest OccupancyGrid of what was swept; None where there is none."""
        return self._said.get('coverage')

    def is_moving(self, now: float) -> bool:
        """Whether it is painted elsewhere a moment later, though nothing new comes."""
        return self._glide.is_under_way(now)

    def robot(self, now: float, size: Size) -> Optional[Robot]:
        """What is known of it at a time of the wall clock [s]; None before it said where it is."""
        pose = self._glide.at(now)
        if pose is None:
            return None
        status, bumper = self._said.get('battery_status'), self._said.get('bumper')
        has_cleaner = bool(self._subscribers['mission_status'].get_num_connections())
        return Robot(
            self._name, pose, size, (bumper.is_left_pressed, bumper.is_right_pressed) if bumper else (False, False),
            status.brushes_up if status else None, status.debug_message if status else '',
            _battery(self._said.get('battery_state')), _cleaning(self._said.get('cleaning_status')),
            _mission(self._said.get('mission_status')) if has_cleaner else None, self._trail.path,
            _beams(self._said.get('scan')), has_cleaner)


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
    return Mission(STATES.get(status.state, '?'), status.state not in AT_REST, status.strategy, status.message)


def _beams(scan: Any) -> Optional[Array]:
    """Ends of the beams in the robot's frame (n, 2) [m]: range_max where nothing was met, 0 where it is too near."""
    if scan is None:
        return None
    ranges = np.clip(np.nan_to_num(scan.ranges.astype(float), nan=0.0), 0.0, scan.range_max)
    angles = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
    return np.stack([ranges * np.cos(angles), ranges * np.sin(angles)], axis=1)
