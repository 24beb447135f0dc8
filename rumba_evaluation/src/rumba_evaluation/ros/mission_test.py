"""mission_test: a verdict on a robot's run, for rostest, as hztest and paramtest give.

In a .test file, beside the nodes under test:
  <test test-name="cleans" pkg="rumba_evaluation" type="mission_test" time-limit="120">
    <param name="coverage" value="0.5" />
    <param name="collisions" value="20" />
    <param name="time_limit" value="600" />
  </test>
Each condition is a test case of its own, which tells what was asked and what was measured. time_limit is in the time
of the robots; rostest's own time-limit is in real time, and must leave room for the start. The run begins with the
first message of what is judged.

Goals are to be met: coverage (the newest counts), reach (each place once), docked (the contacts are closed, and were
open before: a robot that never left its dock has not docked). The run ends as soon as all of them are met at once,
or when the time is up. Guards must hold in every message until then: battery, collisions (times the bumper was
pressed anew), fields. Without goals the whole time is judged. A condition of which nothing was heard has failed, and
so has a guard where the run ended early, because nothing was heard for `patience` or the test was stopped.

Of the robot it subscribes to what is needed for what is asked:
  cleaning_status  rumba_msg/CleaningStatus   ground_truth    nav_msgs/Odometry
  dock_status      rumba_msg/DockStatus       bumper          rumba_msg/Bumper
  battery_state    sensor_msgs/BatteryState   battery_status  rumba_msg/BatteryStatus
and to the topics of `fields`, of whatever type. The lower of both charges counts.

Parameters:
"""

import dataclasses
import sys
import threading
import time
import unittest
from typing import Any, Callable, Dict, List, Tuple, Type

import rospy
import rostopic
import rosunit
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState

from rumba_evaluation.verdicts import mission_verdict
from rumba_evaluation.verdicts.mission_asked import Asked
from rumba_evaluation.verdicts.mission_verdict import Condition, Field, Judge, Verdict
from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, DockStatus
from rumba_sim.model.config import setting
from rumba_sim.ros.common import conversions, node
from rumba_sim.ros.common.names import check_names

NAME = 'mission_test'
PERIOD = 0.05  # [s] of the wall clock
OUTPUT = '--gtest_output=xml:'  # what rostest gives every test: where to write the results ...
TEXT = '--text'  # ... or to print them
FAILED = 1
Value = Callable[[Any], Any]
TOPICS: Dict[Type[Condition], List[Tuple[str, Any, Value]]] = {
    mission_verdict.Coverage: [('cleaning_status', CleaningStatus, lambda message: message.coverage)],
    mission_verdict.Reach: [('ground_truth', Odometry, lambda message: conversions.place(message.pose.pose))],
    mission_verdict.Docked: [('dock_status', DockStatus, lambda message: message.is_docked)],
    mission_verdict.Collisions: [
        ('bumper', Bumper, lambda message: message.is_left_pressed or message.is_right_pressed)],
    mission_verdict.Battery: [
        ('battery_state', BatteryState, lambda message: 100.0 * message.percentage),
        ('battery_status', BatteryStatus, lambda message: float(message.percentage_battery))],
}


@dataclasses.dataclass(frozen=True)
class Settings(Asked):
    """The node's private parameters: what is asked, and of whom."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    patience: float = setting(20.0, 'with robots of which nothing is heard, of the wall clock', 's', 0.1, 1e6)

    def __post_init__(self) -> None:
        """Names of topics are made of the robot's name."""
        check_names(self, 'robot')


def main() -> None:
    """Run the node."""
    node.run(NAME, Settings, judge, arguments_of_others=(OUTPUT, TEXT),
             on_refusal=lambda message: report([Verdict('parameters', False, message)]))


def judge(settings: Settings) -> None:
    """Judge one run and report; leaves the process with exit code 1 where a condition was not met.

    Raises:
        ConfigError: what is asked makes no sense.
    """
    court = Court(settings)
    court.sit()
    if not report(court.verdicts()):
        sys.exit(FAILED)


class Court:
    """A judge, and the topics on which the evidence comes."""

    def __init__(self, settings: Settings) -> None:
        """Listen to all that is needed.

        Raises:
            ConfigError: what is asked makes no sense.
        """
        self._robot = settings.robot
        self._patience = settings.patience
        self._judge = Judge(settings.conditions(), settings.time_limit)
        self._lock = threading.Lock()
        self._heard = time.monotonic()
        self._unknown = [condition for condition in self._judge.conditions if isinstance(condition, Field)]
        for condition in self._judge.conditions:
            for topic, kind, value in TOPICS.get(type(condition), []):
                self._listen(condition, f'{self._robot}/{topic}', kind, value)

    def _listen(self, condition: Condition, topic: str, kind: Any, value: Value) -> None:
        rospy.Subscriber(topic, kind, lambda message: self._hear(condition, value(message)))

    def _hear(self, condition: Condition, value: Any) -> None:
        with self._lock:
            self._heard = time.monotonic()
            self._judge.hear(condition, value, rospy.get_time())

    def sit(self) -> None:
        """Wait until the run is over."""
        while not self._judge.is_over:
            self._find_fields()
            time.sleep(PERIOD)  # not rospy's, which waits for the time of robots that may have gone
            with self._lock:
                self._judge.look(rospy.get_time())
                if time.monotonic() - self._heard > self._patience:
                    self._judge.give_up(f'nothing was heard for {self._patience:g} s of the wall clock')
                if rospy.is_shutdown():
                    self._judge.give_up('the test was stopped')

    def _find_fields(self) -> None:
        """Listen to fields that somebody has begun to publish."""
        for field in self._unknown[:]:
            kind, topic, value = rostopic.get_topic_class(rospy.resolve_name(field.path))
            if kind is not None:
                self._unknown.remove(field)
                self._listen(field, topic, kind, value or (lambda message: message))

    def verdicts(self) -> List[Verdict]:
        """What is to be said."""
        with self._lock:
            return self._judge.verdicts(self._source)

    def _source(self, condition: Condition) -> str:
        topics = [condition.path] if isinstance(condition, Field) else [
            f'{self._robot}/{topic}' for topic, _, _ in TOPICS[type(condition)]]
        return ' or '.join(map(rospy.resolve_name, topics))


def report(verdicts: List[Verdict]) -> bool:
    """Tell the verdicts as rostest wants them, a test case for each; returns whether all are good."""
    for verdict in verdicts:
        print(('met     ' if verdict.is_met else 'NOT MET ') + verdict.words, flush=True)
    cases = type('Mission', (unittest.TestCase,), {f'test_{verdict.name}': _case(verdict) for verdict in verdicts})
    suite = unittest.TestLoader().loadTestsFromTestCase(cases)
    if TEXT in sys.argv:
        return unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful()
    path = next((argument[len(OUTPUT):] for argument in sys.argv if argument.startswith(OUTPUT)), '')
    if not path:  # by hand: the lines above tell all
        return all(verdict.is_met for verdict in verdicts)
    result = rosunit.create_xml_runner('rumba_sim', NAME, path).run(suite)
    rosunit.print_unittest_summary(result)
    return result.wasSuccessful()


def _case(verdict: Verdict) -> Callable[[unittest.TestCase], None]:
    def test(case: unittest.TestCase) -> None:
        if not verdict.is_met:
            case.fail(verdict.words)
    return test
