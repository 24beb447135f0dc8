"""mission_test: a test node for rostest, like hztest and paramtest: gives a verdict on a robot's run.

In a .test file, beside the nodes under test:
  <test test-name="cleans" pkg="rumba_evaluation" type="mission_test" time-limit="120">
    <param name="coverage" value="0.5" />
    <param name="collisions" value="20" />
    <param name="time_limit" value="600" />
  </test>
Each condition is a test case of its own, which reports the requirement and the measured values. time_limit is in the
time of the robots; rostest's own time-limit is in real time, and must include the start. The run begins with the first
message of a topic that a condition needs.

Goals must be met at the end: coverage (the newest value counts), reach (each waypoint once), docked (the contacts are
closed after they were open: a robot that never left its dock has not docked). The run ends as soon as all goals are met
at the same time, or when the time limit is reached. Guards must hold in every message until then: battery, collisions
(a bumper that stays pressed is one), fields. Without goals the run lasts until the time limit. A condition without any
message has failed, and so has a guard if the run was aborted: no message came for `patience`, or the test was stopped.

A run counts only if one node alone publishes the topics of the robot: the one that simulator/state names, so the
simulator or turtlesim_body, or the one that the parameter `publisher` names. Otherwise all conditions have failed.
Any nodes may publish topics of `fields`, unless that node publishes them too.

It subscribes to simulator/state (rumba_msg/SimulatorState), and to those topics of the robot that the conditions need:
  cleaning_status  rumba_msg/CleaningStatus   ground_truth    nav_msgs/Odometry
  dock_status      rumba_msg/DockStatus       bumper          rumba_msg/Bumper
  battery_state    sensor_msgs/BatteryState   battery_status  rumba_msg/BatteryStatus
and to the topics of `fields`, of any type. The lower charge of the two topics counts.

Parameters:
"""

import dataclasses
import sys
import threading
import time
import unittest
from typing import Any, Callable, Dict, List, Tuple, Type

import rosgraph
import rospy
import rostopic
import rosunit
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState

from rumba_evaluation.verdicts import mission_verdict
from rumba_evaluation.verdicts.mission_requirements import Requirements
from rumba_evaluation.verdicts.mission_verdict import Condition, Field, Judge, Verdict
from rumba_evaluation.verdicts.origins import Origins
from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, DockStatus, SimulatorState
from rumba_sim.model.config import setting
from rumba_sim.model.robot import FIRST
from rumba_sim.ros.common import conversions, node, peers, simulator_client
from rumba_sim.ros.common.names import check_names

PACKAGE, NAME = 'rumba_evaluation', 'mission_test'
PERIOD = 0.05  # [s] of the wall clock
LOOK_PERIOD = 0.5  # [s] of the wall clock from one look at the master to the next
OUTPUT = '--gtest_output=xml:'  # rostest gives each test the file for its results ...
TEXT = '--text'  # ... or tells it to print them
FAILED = 1
Value = Callable[[Any], Any]
TOPICS: Dict[Type[Condition], List[Tuple[str, Any, Value]]] = {
    mission_verdict.Coverage: [('cleaning_status', CleaningStatus, lambda message: message.coverage)],
    mission_verdict.Reach: [('ground_truth', Odometry, lambda message: conversions.plane_pose(message.pose.pose))],
    mission_verdict.Docked: [('dock_status', DockStatus, lambda message: message.is_docked)],
    mission_verdict.Collisions: [
        ('bumper', Bumper, lambda message: message.is_left_pressed or message.is_right_pressed)],
    mission_verdict.Battery: [
        ('battery_state', BatteryState, lambda message: 100.0 * message.percentage),
        ('battery_status', BatteryStatus, lambda message: float(message.percentage_battery))],
}


@dataclasses.dataclass(frozen=True)
class Settings(Requirements):
    """The node's private parameters: the requirements, and the robot that must meet them."""

    robot: str = setting(FIRST, 'name of the robot: its topics are below it')
    patience: float = setting(40.0, 'time of the wall clock without any message after which the run is aborted', 's',
                              0.1, 1e6)
    publisher: str = setting('', 'full name of the node that publishes the topics of the robot; empty: the one that '
                                 'simulator/state names')

    def __post_init__(self) -> None:
        """The robot's name is a part of names of topics."""
        check_names(self, 'robot')


def main() -> None:
    """Run the node."""
    node.run(NAME, Settings, judge, arguments_of_others=(OUTPUT, TEXT),
             on_refusal=lambda message: report([Verdict('parameters', False, message)]))


def judge(settings: Settings) -> None:
    """Judge one run and report; leaves the process with exit code 1 if a condition was not met.

    Raises:
        ConfigError: there is no requirement, or one cannot be understood.
    """
    monitor = MissionMonitor(settings)
    monitor.run()
    if not report(monitor.verdicts()):
        sys.exit(FAILED)


class MissionMonitor:
    """Judges a run by the messages of a robot's topics."""

    def __init__(self, settings: Settings) -> None:
        """Subscribe to the topics that the conditions need.

        Raises:
            ConfigError: there is no requirement, or one cannot be understood.
        """
        self._robot = settings.robot
        self._patience = settings.patience
        self._judge = Judge(settings.conditions(), settings.time_limit)
        self._lock = threading.Lock()  # held while judge or origins change
        self._last_message = self._last_look = time.monotonic()
        self._unpublished = [condition for condition in self._judge.conditions if isinstance(condition, Field)]
        measured = [(condition, rospy.resolve_name(f'{self._robot}/{topic}'), kind, value)
                    for condition in self._judge.conditions
                    for topic, kind, value in TOPICS.get(type(condition), [])]
        state = rospy.resolve_name(simulator_client.TOPIC)
        self._origins = Origins([topic for _, topic, _, _ in measured], state, settings.publisher)
        rospy.Subscriber(state, SimulatorState, self._on_state)
        for one in measured:
            self._subscribe(*one)

    def _subscribe(self, condition: Condition, topic: str, kind: Any, value: Value) -> None:
        rospy.Subscriber(topic, kind, lambda message: self._update(condition, topic, message, value))

    def _on_state(self, message: SimulatorState) -> None:
        with self._lock:
            self._origins.publishes(rospy.resolve_name(simulator_client.TOPIC), peers.caller(message))
            self._origins.names(message.node)

    def _update(self, condition: Condition, topic: str, message: Any, value: Value) -> None:
        with self._lock:
            self._last_message = time.monotonic()
            self._origins.publishes(topic, peers.caller(message))
            self._judge.update(condition, value(message), _now())

    def run(self) -> None:
        """Wait until the run is over."""
        while not self._judge.is_over:
            self._subscribe_to_fields()
            self._look_at_publishers(LOOK_PERIOD)
            time.sleep(PERIOD)  # rospy.sleep would wait for the clock of a simulator, which may have ended
            with self._lock:
                self._judge.check_time(_now())
                if time.monotonic() - self._last_message > self._patience:
                    self._judge.abort(f'no message came for {self._patience:g} s of the wall clock')
                if rospy.is_shutdown():
                    self._judge.abort('the test was stopped')
        self._complete()

    def _complete(self) -> None:
        """Wait until it is known who must publish: the run may end before the state of the simulator comes."""
        end = time.monotonic() + self._patience
        self._look_at_publishers()
        while not self._origins.is_complete and time.monotonic() < end and not rospy.is_shutdown():
            time.sleep(PERIOD)
        self._look_at_publishers()
        with self._lock:
            if not self._origins.is_complete:
                self._judge.annul(self._origins.unknown())

    def _look_at_publishers(self, period: float = 0.0) -> None:
        """Ask the master who publishes, not more often than in a period [s]; the run is void if a wrong node does."""
        if time.monotonic() - self._last_look >= period:
            self._last_look = time.monotonic()
            try:
                publishers = rosgraph.Master(rospy.get_name()).getSystemState()[0]
            except (rosgraph.MasterException, OSError):  # it ends, or is busy: messages tell their senders too
                publishers = []
            with self._lock:
                for topic, nodes in publishers:
                    for name in nodes:
                        self._origins.publishes(topic, name)
        with self._lock:
            problem = self._origins.problem()
            if problem:
                self._judge.annul(problem)

    def _subscribe_to_fields(self) -> None:
        """Subscribe to the topics of those fields that have a publisher since the last call."""
        for field in self._unpublished[:]:
            try:
                kind, topic, value = rostopic.get_topic_class(rospy.resolve_name(field.path))
            except rostopic.ROSTopicException as error:  # no master, or a type that this workspace does not have
                rospy.logwarn_throttle(self._patience, f'{field.path}: {error}')
                continue
            if kind is not None:
                self._unpublished.remove(field)
                with self._lock:
                    self._origins.watch(topic)
                self._subscribe(field, topic, kind, value or (lambda message: message))

    def verdicts(self) -> List[Verdict]:
        """The verdict on each condition."""
        with self._lock:
            return self._judge.verdicts(self._source)

    def _source(self, condition: Condition) -> str:
        topics = [condition.path] if isinstance(condition, Field) else [
            f'{self._robot}/{topic}' for topic, _, _ in TOPICS[type(condition)]]
        return ' or '.join(map(rospy.resolve_name, topics))


def _now() -> float:
    """Time of the robots [s]; in real time one that nobody can set."""
    return time.monotonic() if rospy.rostime.is_wallclock() else float(rospy.get_time())


def report(verdicts: List[Verdict]) -> bool:
    """Report the verdicts to rostest, each as a test case; returns whether all conditions are met."""
    for verdict in verdicts:
        print(('met     ' if verdict.is_met else 'NOT MET ') + verdict.words, flush=True)
    cases = type('Mission', (unittest.TestCase,), {f'test_{verdict.name}': _case(verdict) for verdict in verdicts})
    suite = unittest.TestLoader().loadTestsFromTestCase(cases)
    if TEXT in sys.argv:
        return unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful()
    path = next((argument[len(OUTPUT):] for argument in sys.argv if argument.startswith(OUTPUT)), '')
    if not path:  # started by hand: the lines above are the report
        return all(verdict.is_met for verdict in verdicts)
    result = rosunit.create_xml_runner(PACKAGE, NAME, path).run(suite)
    rosunit.print_unittest_summary(result)
    return bool(result.wasSuccessful())


def _case(verdict: Verdict) -> Callable[[unittest.TestCase], None]:
    def test(case: unittest.TestCase) -> None:
        if not verdict.is_met:
            case.fail(verdict.words)
    return test
