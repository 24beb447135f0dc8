"""Listens to one robot. Callbacks run in threads of rospy and only store; the window asks when it paints."""

import dataclasses
import math
import threading
import time
from typing import Any, Callable, Dict, FrozenSet, Iterable, List, NamedTuple, Optional, Tuple

from actionlib_msgs.msg import GoalStatusArray
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import BatteryState, LaserScan
from tf2_msgs.msg import TFMessage

from rumba_msg.msg import (BatteryStatus, Bumper, CleanActionResult, CleaningStatus, Cliff, GoToActionGoal,
                           MissionStatus, Outcome)
from rumba_sim.model.common.errors import one_line
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.frames import frames
from rumba_viewer.ros import readings
from rumba_viewer.ros.readings import Mounting, Reading, Scan
from rumba_viewer.ros.subscription import Subscription
from rumba_viewer.scene.mission_watch import MissionWatch
from rumba_viewer.scene.snapshot import GOING_TO, Array, Battery, Cleaning, Grid, Mission, Point, Robot, Size
from rumba_viewer.scene.track import Glide, Trail

RECENT = 32  # poses that are kept, to find that of a scan
INTERRUPTED = (Outcome.CANCELLED, Outcome.PREEMPTED)


class Topic(NamedTuple):
    """A topic whose messages replace some of what is known."""

    kind: Any
    read: Callable[[Any], Dict[str, Any]]  # the parts of `Known` that a message replaces


ALWAYS = {
    'battery_status': Topic(BatteryStatus, lambda message: {
        'brushes_up': message.brushes_up, 'message': one_line(message.debug_message)}),
    'battery_state': Topic(BatteryState, lambda message: {'battery': readings.battery(message)}),
    'bumper': Topic(Bumper, lambda message: {'bumper': (message.is_left_pressed, message.is_right_pressed)}),
    'cliff': Topic(Cliff, lambda message: {'has_fallen': message.is_wheel_dropped}),
    'cleaning_status': Topic(CleaningStatus, lambda message: {'cleaning': readings.cleaning(message)}),
    'amcl_pose': Topic(PoseWithCovarianceStamped, lambda message: {'believed': readings.believed(message)}),
    'particlecloud': Topic(PoseArray, lambda message: {'particles': readings.particles(message)}),
    'mission_status': Topic(MissionStatus, lambda message: {'mission': readings.mission(message)}),
    'plan': Topic(Path, lambda message: {'planned': readings.planned(message)})}
LARGE = {  # only while they are shown
    'coverage': Topic(numpy_msg(OccupancyGrid), lambda message: {'coverage': readings.grid(message)}),
    'scan': Topic(numpy_msg(LaserScan), lambda message: {'scan': readings.scan(message)})}


@dataclasses.dataclass(frozen=True)
class Known:
    """What is known of a robot; see `Robot`. It is replaced as a whole, so that each thread sees a consistent value.

    Attributes:
        stamp: of the newest ground_truth [s]; None before the first.
        came: when that came, on the wall clock [s].
        recent: the last poses with their stamps.
        destination: where it was sent last by go_to.
        coverage: the newest picture of the swept floor.
    """

    stamp: Optional[float] = None
    came: float = -math.inf
    recent: Tuple[Reading, ...] = ()
    brushes_up: Optional[bool] = None
    message: str = ''
    battery: Optional[Battery] = None
    bumper: Tuple[bool, bool] = (False, False)
    has_fallen: bool = False
    cleaning: Optional[Cleaning] = None
    mission: Optional[Mission] = None
    can_resume: Optional[bool] = None
    destination: Optional[Point] = None
    coverage: Optional[Grid] = None
    scan: Optional[Scan] = None
    mounting: Mounting = Mounting(Pose(0.0, 0.0, 0.0), False)
    believed: Optional[Pose] = None
    particles: Optional[Array] = None
    planned: Optional[Array] = None

    def beams(self) -> Optional[Array]:
        """The outline (any, 2) [m] of what the laser sees, from where the robot was when it measured that."""
        scan = self.scan
        if scan is None or not self.recent:
            return None
        stamp = scan.stamp
        return scan.outline(min(self.recent, key=lambda one: abs(one.stamp - stamp)).pose, self.mounting)


class RobotListener:
    """Listens to one robot."""

    def __init__(self, name: str, on_news: Callable[[], None]) -> None:
        """Listen to a robot by its name; `on_news` is called when there is something new to show."""
        self._name = name
        self._on_news = on_news
        self._lock = threading.Lock()  # held while something of the next five changes
        self._known = Known()
        self._watch = MissionWatch(name)
        self._wanted: FrozenSet[str] = frozenset(ALWAYS)  # topics whose messages count
        self._trail, self._glide = Trail(), Glide()
        self._subscriptions: Dict[str, Subscription[Any]] = {}
        for topic, how in ALWAYS.items():
            self._subscribe(topic, how)
        self._truth = Subscription(f'{name}/ground_truth', Odometry, readings.reading, self._on_truth, queue_size=10)
        self._results = Subscription(f'{name}/clean/result', CleanActionResult,
                                     lambda message: int(message.result.outcome.code), self._on_result, queue_size=10)
        self._goals = Subscription(f'{name}/go_to/goal', GoToActionGoal, readings.destination,
                                   lambda point: self._learn(destination=point), queue_size=10)
        laser = frames(name).laser
        self._status = Subscription(f'{name}/clean/status', GoalStatusArray, readings.goal_time, self._on_goal_time)
        self._parts = Subscription('/tf_static', TFMessage, lambda message: readings.mounting(message, laser),
                                   self._on_mounting, queue_size=10)

    def close(self) -> None:
        """Stop listening."""
        subscriptions: List[Subscription[Any]] = [self._truth, self._results, self._goals, self._status, self._parts,
                                                  *self._subscriptions.values()]
        for subscription in subscriptions:
            subscription.close()

    def subscribe_large(self, topics: Iterable[str]) -> None:
        """Listen to these of the LARGE topics, and not to the others."""
        unwanted = set(LARGE) - set(topics)
        with self._lock:
            self._wanted = frozenset(ALWAYS).union(topics)
            self._known = dataclasses.replace(self._known, **{topic: None for topic in unwanted})
        for topic in unwanted & set(self._subscriptions):
            self._subscriptions.pop(topic).close()
            self._on_news()
        for topic in set(topics) - set(self._subscriptions):
            self._subscribe(topic, LARGE[topic])

    def _subscribe(self, topic: str, how: Topic) -> None:
        self._subscriptions[topic] = Subscription(
            f'{self._name}/{topic}', how.kind, how.read, lambda changes: self._on_changes(topic, changes))

    # --- callbacks ----------------------------------------------------------------------------------------------------

    def _on_changes(self, topic: str, changes: Dict[str, Any]) -> None:
        with self._lock:
            if topic not in self._wanted:
                return
            before, self._known = self._known, dataclasses.replace(self._known, **changes)
            self._follow(changes)
            if _was_reset(before.cleaning, self._known.cleaning):
                self._trail.clear()
        self._on_news()

    def _follow(self, changes: Dict[str, Any]) -> None:
        """Have the watch of the mission know what it needs."""
        if 'battery' in changes:
            self._watch.take_battery(changes['battery'])
        if 'mission' in changes:
            self._watch.take_mission(changes['mission'])
        if 'cleaning' in changes:
            self._watch.take_cleaning(changes['cleaning'])

    def _on_truth(self, new: Reading) -> None:
        with self._lock:
            if self._known.stamp is not None and new.stamp < self._known.stamp:  # another simulation has started
                self._forget()
            now = time.monotonic()
            recent = (*self._known.recent[1 - RECENT:], new)
            self._known = dataclasses.replace(self._known, stamp=new.stamp, came=now, recent=recent)
            self._trail.add(new.pose)
            self._glide.add(new.pose, now)
        self._on_news()

    def _on_result(self, code: int) -> None:
        """A cleaning ended; one that was refused never began, and leaves the last one as it is.

        One whose robot was gone can be resumed, unless the simulator was started again.
        """
        if code != Outcome.REFUSED:
            self._learn(can_resume=None if code == Outcome.NO_READINGS else code in INTERRUPTED)
            self._on_news()

    def _on_goal_time(self, came: Optional[float]) -> None:
        with self._lock:
            self._watch.take_goal(came)

    def _on_mounting(self, mounting: Optional[Mounting]) -> None:
        if mounting is not None:  # many nodes publish on this topic
            self._learn(mounting=mounting)
            self._on_news()

    def _learn(self, **changes: Any) -> None:
        with self._lock:
            self._known = dataclasses.replace(self._known, **changes)

    def forget(self) -> None:
        """Forget what belongs to another simulation or map."""
        with self._lock:
            self._forget()

    def _forget(self) -> None:
        self._trail.clear()
        self._glide = Glide()
        self._known = dataclasses.replace(self._known, recent=(), coverage=None, believed=None, particles=None)

    # --- what the window asks -----------------------------------------------------------------------------------------

    @property
    def is_connected(self) -> bool:
        """Whether a node publishes its ground_truth."""
        return self._truth.is_connected

    @property
    def known(self) -> Known:
        """What is known of it now."""
        return self._known

    def is_moving(self, now: float) -> bool:
        """Whether it will be painted elsewhere a moment later, even without a new reading."""
        return self._glide.is_under_way(now)

    def robot(self, now: float, size: Size) -> Optional[Robot]:
        """What is known of it at a time of the wall clock [s]; None before the first reading."""
        has_cleaner, is_localised = (self._subscriptions[topic].is_connected
                                     for topic in ('mission_status', 'amcl_pose'))
        if not has_cleaner:
            self._learn(can_resume=None)
        with self._lock:
            known, glide, path = self._known, self._glide, self._trail.path
            elapsed, left, report = self._watch.elapsed, self._watch.left, self._watch.report
        pose = glide.at(now)
        if pose is None:
            return None
        return Robot(
            self._name, pose, size, bumper=known.bumper, has_fallen=known.has_fallen, brushes_up=known.brushes_up,
            message=known.message, battery=known.battery, cleaning=known.cleaning,
            mission=known.mission if has_cleaner else None, path=path, beams=known.beams(),
            planned=known.planned if has_cleaner else None,
            believed=known.believed if is_localised else None, particles=known.particles if is_localised else None,
            going_to=known.destination if has_cleaner and known.mission and known.mission.state == GOING_TO else None,
            elapsed=elapsed if has_cleaner else None, left=left if has_cleaner else None, report=report,
            has_cleaner=has_cleaner, can_resume=known.can_resume)


def _was_reset(before: Optional[Cleaning], after: Optional[Cleaning]) -> bool:
    """Whether the distance of a robot began anew."""
    return before is not None and after is not None and after.distance < before.distance
