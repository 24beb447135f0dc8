"""Tells the mates of a robot what it does, and hears what they tell."""

import queue
import threading
import time
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np
import rospy
from std_msgs.msg import Header

from rumba_cleaning.belief.mates import Mates, Report, Task
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_cleaning.route import Ahead, Relief, Route
from rumba_msg.msg import TeamPlan, TeamReport
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.ros.common.frames import MAP

REPORT, PLAN = 'team_report', 'team_plan'  # topics below the name of a robot
SILENT = 5.0  # [s] by the stamps of the robot without a report of a mate: it takes no part any more; our choice
PATIENCE = 5.0  # [s] of the wall clock that a world in lockstep waits for a mate that tells nothing; our choice
MOST = 100  # reports that may wait to be heard: 10 s of one mate
LONGEST = 100_000  # corners of a plan
COMPLAINT_PERIOD = 10.0  # [s]
Listener = Callable[[str, Report], None]  # gets the name of a mate, and what it told


class _Heard(NamedTuple):
    """The newest report of a mate."""

    report: Report
    stamp: rospy.Time  # of the robot that heard it


class Team:
    """The topics by which a robot and its mates tell each other what they do; without mates there are none."""

    def __init__(self, robot: str, names: Sequence[str], on_news: Callable[[], None] = lambda: None) -> None:
        """Speak for a robot that shares its floor.

        Args:
            robot: its name.
            names: of all robots of the team, in the order of precedence, its own among them; without others it is
                alone.
            on_news: called after each message of a mate, in a thread of rospy.
        """
        self._on_news = on_news
        self._robot, self._names = robot, tuple(names) if len(names) > 1 else ()
        self._lock = threading.Lock()
        self._plans: Dict[str, Dict[int, TeamPlan]] = {}  # by the name of the mate and their number; 0: none
        self._news: 'queue.Queue[Tuple[str, TeamReport]]' = queue.Queue(MOST)
        self._pending: List[Tuple[str, TeamReport]] = []  # reports of plans that have not come yet
        self._newest: Dict[str, TeamReport] = {}  # report of each mate
        self._given_up: Set[str] = set()
        self._waits_since: Optional[float] = None  # a time of `time.monotonic`
        self._subscribers: Dict[str, rospy.Subscriber] = {}
        self._heard: Dict[str, _Heard] = {}
        self._shown: Optional[Array] = None  # the waypoints of the plan that was published last
        self._number = 0  # of that plan
        if self.is_alone:
            return
        self._reports = rospy.Publisher(f'{robot}/{REPORT}', TeamReport, queue_size=MOST)
        self._routes = rospy.Publisher(f'{robot}/{PLAN}', TeamPlan, queue_size=1, latch=True)
        for name in names:
            if name != robot:
                self._plans[name] = {}
                rospy.Subscriber(f'{name}/{PLAN}', TeamPlan, self._on_plan, name, queue_size=MOST)
                self._subscribers[name] = rospy.Subscriber(f'{name}/{REPORT}', TeamReport, self._on_report, name,
                                                           queue_size=MOST)

    @property
    def is_alone(self) -> bool:
        """Whether the robot has no mates."""
        return not self._names

    def mates(self) -> Mates:
        """What a robot knows of its mates at first: what they told last."""
        mates = Mates(self._robot, self._names)
        for name, heard in self._heard.items():
            mates.hear(name, heard.report)
        return mates

    # --- hearing --------------------------------------------------------------------------------------------------

    def _on_plan(self, plan: TeamPlan, name: str) -> None:
        if not _is_route(plan):
            rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{name}/{PLAN} is no plan: ignored')
            return
        with self._lock:
            self._plans[name][plan.route] = plan
        self._on_news()

    def _on_report(self, report: TeamReport, name: str) -> None:
        pose = report.pose
        if not np.isfinite([pose.x, pose.y, pose.theta, report.remaining, report.relieved_length]).all() or (
                report.task not in list(Task)):
            rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{name}/{REPORT} is no report: ignored')
            return
        with self._lock:
            if self._news.full():
                self._news.get()
            self._news.put((name, report))
            self._newest[name] = report
            self._given_up.discard(name)
        self._on_news()

    def have_told(self, stamp: Optional[rospy.Time]) -> bool:
        """Whether all mates that are there have told what they do at a stamp, or after it.

        One for which the robot has waited for PATIENCE is not waited for again until it tells something.
        """
        now = time.monotonic()
        with self._lock:
            missing = {name for name, report in self._newest.items() if stamp is not None and (
                report.header.stamp < stamp or not self._has_plan_of(name, report)
                ) and name not in self._given_up and self._subscribers[name].get_num_connections() > 0}
            self._waits_since = (self._waits_since or now) if missing else None
            if self._waits_since is None or now - self._waits_since < PATIENCE:
                return not missing
            self._given_up |= missing
            self._waits_since = None
            return True

    def listen(self, listeners: Sequence[Listener], stamp: rospy.Time, before: Optional[rospy.Time] = None) -> None:
        """Have all who listen hear what has been told, and who has fallen silent.

        Args:
            listeners: the goal that is active, and the cleaning that is interrupted.
            stamp: of the newest reading of the robot.
            before: hear only what was told before this stamp; None: all that has come.
        """
        for name, message in self._arrived(before):
            self._take(listeners, name, self._read(name, message), stamp)
        for name, heard in list(self._heard.items()):
            if heard.report.task is not Task.OFF and (stamp - heard.stamp).to_sec() > SILENT:
                rospy.logwarn(f'{self._robot}: {name} has fallen silent: it counts as stopped')
                self._take(listeners, name, heard.report._replace(task=Task.OFF, ahead=None), stamp)

    def _take(self, listeners: Sequence[Listener], name: str, report: Report, stamp: rospy.Time) -> None:
        self._heard[name] = _Heard(report, stamp)
        for listener in listeners:
            listener(name, report)

    def _arrived(self, before: Optional[rospy.Time]) -> List[Tuple[str, TeamReport]]:
        """The reports to hear, mate by mate, whose plans are known; the others wait, and what is told after them."""
        with self._lock:
            waiting, self._pending = self._pending, []
            while not self._news.empty():
                waiting.append(self._news.get())
            ready: List[Tuple[str, TeamReport]] = []
            late = set()
            for name, message in waiting[-MOST:]:
                if name in late or not self._has_plan_of(name, message) or (
                        before is not None and message.header.stamp >= before):
                    late.add(name)
                    self._pending.append((name, message))
                else:
                    ready.append((name, message))
            return sorted(ready, key=lambda news: self._names.index(news[0]))

    def _has_plan_of(self, name: str, report: TeamReport) -> bool:
        """Whether the plan has come of which a report tells."""
        return report.route == 0 or report.route in self._plans[name]

    def _read(self, name: str, message: TeamReport) -> Report:
        ahead = None
        if message.route > 0:
            with self._lock:
                plan = self._plans[name][message.route]
                self._plans[name] = {number: kept for number, kept in self._plans[name].items()
                                     if number >= message.route}
            relief = Relief(message.relieved, message.relieved_plan, message.relieved_length)
            ahead = Ahead(_route(plan), max(message.remaining, 0.0), message.plan, relief if message.relieved else None)
        pose = Pose(message.pose.x, message.pose.y, message.pose.theta)
        return Report(pose, message.brushes_up, Task(message.task), ahead)

    # --- telling --------------------------------------------------------------------------------------------------

    def tell(self, report: Optional[Report], stamp: Optional[rospy.Time]) -> None:
        """Publish a report of the robot, and its plan if that is another one."""
        if self.is_alone or report is None or stamp is None:
            return
        header = Header(stamp=stamp, frame_id=MAP)
        ahead = report.ahead
        if ahead is not None and ahead.route.waypoints is not self._shown:
            self._shown, self._number = ahead.route.waypoints, self._number + 1
            x, y = ahead.route.waypoints.T.tolist()
            self._routes.publish(TeamPlan(header, self._number, x, y, ahead.route.speeds.tolist()))
        relief = ahead.relief if ahead is not None and ahead.relief is not None else Relief('', 0, 0.0)
        self._reports.publish(TeamReport(
            header, int(report.task), conversions.pose_message(report.pose), report.brushes_up,
            self._number if ahead is not None else 0, ahead.remaining if ahead is not None else 0.0,
            ahead.plan if ahead is not None else 0, *relief))


def _is_route(plan: TeamPlan) -> bool:
    count = len(plan.x)
    return 2 <= count <= LONGEST and count == len(plan.y) == len(plan.speed) + 1 and bool(
        np.isfinite([*plan.x, *plan.y, *plan.speed]).all()) and min(plan.speed) > 0.0


def _route(plan: TeamPlan) -> Route:
    return Route(np.stack([plan.x, plan.y], axis=1).astype(np.float64), np.array(plan.speed, np.float64))
