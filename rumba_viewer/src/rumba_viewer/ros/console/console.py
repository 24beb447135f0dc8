"""console: one live line about a mission in the terminal, and a small report at its end.

The line stays in the last row of the terminal, and is as long as fits there. What others print scrolls above it. Into a
pipe or a file it prints a line from time to time.

Subscribes, below the name of each robot:
  cleaning_status  rumba_msg/CleaningStatus   battery_state    sensor_msgs/BatteryState
  mission_status   rumba_msg/MissionStatus    clean/status     actionlib_msgs/GoalStatusArray

Parameters, as in `rosrun rumba_viewer console _robot:=rumba2`:
"""

import dataclasses
import os
import sys
import threading
from typing import Any, Callable, Dict, List, Sequence, Tuple, Type

import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatusArray
from sensor_msgs.msg import BatteryState

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_msg.msg import CleaningStatus, MissionStatus
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.running import node
from rumba_viewer.ros import readings
from rumba_viewer.ros.console.bottom_line import BottomLine
from rumba_viewer.ros.subscription import Subscription
from rumba_viewer.scene import wording
from rumba_viewer.scene.mission_watch import UNKNOWN, MissionWatch

PERIOD = 0.2  # [s] of the wall clock from one live line to the next
PIPE_PERIOD = 2.0  # [s] of the wall clock from one line into a pipe to the next
NEXT = ['next, in a second terminal of ./rumba shell:',
        '  rosrun rumba_viewer viewer    a window',
        '  rosrun rumba_viewer page      a page for browsers',
        '  docs/mission_report.md        to record a mission, and make a report of it']


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    robot: str = setting('rumba', 'name of the robot')
    target_coverage: float = setting(CleaningConfig().target_coverage, 'share of the floor that missions sweep, by '
                                     'which the time left is estimated', '0..1', 0.0, 1.0)

    others: str = setting('', 'names of other robots whose reports are printed too, with spaces between')

    def __post_init__(self) -> None:
        """Check the names of the robots, of which names of topics are made."""
        check_names(self, 'robot')
        if not all(map(rosgraph.names.is_legal_base_name, self.others.split())):
            raise ConfigError(f'others is {self.others!r}: must be names of robots, with spaces between')


def main() -> None:
    """Run the node."""
    node.run('console', Settings, show)


def show(settings: Settings) -> None:
    """Show the mission of a robot, until ROS shuts down."""
    console = Console([settings.robot, *settings.others.split()], settings.target_coverage)
    is_terminal = sys.stdout.isatty() and os.environ.get('TERM', 'dumb') != 'dumb'
    bottom = BottomLine(sys.stdout.fileno()) if is_terminal else None
    ended = threading.Event()
    rospy.on_shutdown(ended.set)
    try:
        while not ended.wait(PERIOD if bottom is not None else PIPE_PERIOD):
            report, lines = console.report(), console.lines()
            if bottom is not None:
                if report:
                    bottom.say(report)
                bottom.show(lines)
            else:
                print(*report, lines[0], sep='\n', flush=True)
    finally:
        if bottom is not None:
            bottom.close()


class Console:
    """Listens to robots, and puts their missions into words."""

    def __init__(self, robots: Sequence[str], target: float) -> None:
        """Listen to robots whose missions have a target [0..1]; the live line is about the first of them."""
        self._lock = threading.Lock()  # held while a watch is used
        self._watches = {robot: MissionWatch(robot, target) for robot in robots}
        self._told: Dict[str, Tuple[str, ...]] = dict.fromkeys(robots, ())
        self._topics = [topic for robot, watch in self._watches.items() for topic in (
            self._topic(robot, 'battery_state', BatteryState, readings.battery, watch.take_battery),
            self._topic(robot, 'mission_status', MissionStatus, readings.mission, watch.take_mission),
            self._topic(robot, 'clean/status', GoalStatusArray, readings.goal_time, watch.take_goal),
            self._topic(robot, 'cleaning_status', CleaningStatus, readings.cleaning, watch.take_cleaning))]

    def _topic(self, robot: str, name: str, kind: Type[Any], read: Callable[[Any], Any],
               take: Callable[[Any], None]) -> 'Subscription[Any]':
        def take_alone(value: Any) -> None:
            with self._lock:
                take(value)
        return Subscription(f'{robot}/{name}', kind, read, take_alone, queue_size=10)

    def report(self) -> List[str]:
        """The reports of missions that have just ended, once, and after the last what to do next; else no lines."""
        with self._lock:
            told, self._told = self._told, {robot: watch.report for robot, watch in self._watches.items()}
            lines = [line for robot, report in self._told.items() if report != told[robot] for line in report]
            is_over = not any(watch.mission is not None and watch.mission.is_active for watch in self._watches.values())
        return [*lines, *NEXT] if lines and is_over else lines

    def lines(self) -> List[str]:
        """The live line, and shorter ones for narrow terminals."""
        with self._lock:
            robot, watch = next(iter(self._watches.items()))
            if watch.cleaning is None:
                return [f'waiting for {rospy.resolve_name(robot)}/cleaning_status']
            return wording.live_lines(watch.mission, watch.cleaning, watch.battery or UNKNOWN, watch.elapsed,
                                      watch.left)
