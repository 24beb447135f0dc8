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
(a bumper that stays pressed is one), fields, agree, rates. Without goals the run lasts until the time limit. A
condition without any message has failed, and so has a guard if the run was aborted: no message came for `patience`, or
the test was stopped.

Each condition earns points, also in part; the points of guards count by the share of points that the goals have earned.
Beside the results for rostest, a file .json has the points, and why some were lost, as Gradescope reads them.

In lockstep the test takes part: the world waits until it has taken all that belongs to a control tick. Name it in
wait_for of the simulator.

A run counts only if one node alone publishes the topics of the robot: the one that simulator/state names, so the
simulator or turtlesim_body, or the one that the parameter `publisher` names. Otherwise all conditions have failed.
Any nodes may publish topics of `fields`, unless that node publishes them too.

It subscribes to simulator/state (rumba_msg/SimulatorState), and to those topics of the robot that the conditions need:
  cleaning_status  rumba_msg/CleaningStatus   ground_truth    nav_msgs/Odometry
  dock_status      rumba_msg/DockStatus       bumper          rumba_msg/Bumper
  battery_state    sensor_msgs/BatteryState   battery_status  rumba_msg/BatteryStatus
and to the topics of `fields`, `agree` and `rates`, of any type. It subscribes to simulator/lockstep
(rumba_msg/Lockstep), and answers on simulator/lockstep_answers (rumba_msg/LockstepAnswer). The lower charge of the two
topics counts. In an examination, all that the simulator publishes comes over a private socket instead, and the answers
go there.

Parameters:
"""

import dataclasses
import os
import sys
import unittest
from typing import Callable, List, Sequence

import rosunit

from rumba_evaluation.marks import gradescope
from rumba_evaluation.marks.scheme import Mark, Scheme
from rumba_evaluation.ros.judge.recording import Recording
from rumba_evaluation.ros.mission_monitor import MissionMonitor
from rumba_evaluation.verdicts.conditions import Condition
from rumba_evaluation.verdicts.field_conditions import FieldCondition
from rumba_evaluation.verdicts.mission_requirements import Requirements
from rumba_evaluation.verdicts.mission_verdict import Verdict
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.common.paths import absolute
from rumba_sim.ros.running import node

PACKAGE, NAME = 'rumba_evaluation', 'mission_test'
OUTPUT = '--gtest_output=xml:'  # rostest gives each test the file for its results ...
TEXT = '--text'  # ... or tells it to print them
FAILED = 1


@dataclasses.dataclass(frozen=True)
class Settings(Requirements):
    """The node's private parameters: the requirements, and the robot that must meet them."""

    robot: str = setting(FIRST, 'name of the robot: its topics are below it')
    patience: float = setting(40.0, 'time of the wall clock without any message after which the run is aborted', 's',
                              0.1, 1e6)
    publisher: str = setting('', 'full name of the node that publishes the topics of the robot; empty: the one that '
                                 'simulator/state names')
    wait_for: str = setting('', 'topics of the node that is judged, with spaces between, of those that the conditions '
                                'name: in lockstep, the world waits for a message on each after each control tick')
    exam: bool = setting(False, 'an examination: the simulator reports over its private channel; the run is void if '
                                'another process connects to it, or sets a parameter of the simulator')
    recording: str = setting('', 'path of a bag that is written in an examination: ground_truth, who commanded, and '
                                 'what mission_report needs; empty: none')
    results: str = setting('', 'path of results.json for Gradescope; empty: beside the file that rostest asks for, '
                               'if any')
    visibility: str = setting(gradescope.VISIBLE, 'when Gradescope shows students the marks',
                              choices=gradescope.VISIBILITIES)

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
        ConfigError: there is no requirement, or one cannot be understood, or the results cannot be written.
    """
    conditions = settings.conditions()
    _check_awaited(settings.wait_for.split(), conditions)
    scheme = Scheme(conditions, settings.points, settings.partial)
    verdicts = _verdicts(settings, conditions)
    marks = scheme.marks(verdicts)
    path = absolute(settings.results) if settings.results else gradescope.beside(_results_file())
    if path:
        _write(path, gradescope.document(marks, settings.visibility))
    if not report(verdicts, marks):
        sys.exit(FAILED)


def _verdicts(settings: Settings, conditions: List[Condition]) -> List[Verdict]:
    """Watch the run to its end; the recording is finished however it ends."""
    if settings.recording and not settings.exam:
        raise ConfigError('recording: is written in an examination only: set exam, too')
    recording = Recording(absolute(settings.recording), settings.robot) if settings.recording else None
    monitor = MissionMonitor(conditions, settings.robot, settings.time_limit, settings.patience, settings.publisher,
                             settings.wait_for.split(), settings.exam, recording)
    try:
        monitor.run()
        return monitor.verdicts()
    finally:
        monitor.close()
        if recording is not None:
            recording.close()


def _check_awaited(topics: Sequence[str], conditions: Sequence[Condition]) -> None:
    paths = [path for condition in conditions if isinstance(condition, FieldCondition) for path in condition.paths]
    for topic in topics:
        if not any(f'{path}/'.startswith(f'{topic}/') for path in paths):
            raise ConfigError(f'wait_for has {topic!r}: must be topics of fields, agree and rates')


def _write(path: str, text: str) -> None:
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
    except OSError as error:
        raise ConfigError(f'results: {path}: {error.strerror}') from error


def _results_file() -> str:
    """The file that rostest asks for; empty if it asks for none."""
    return next((argument[len(OUTPUT):] for argument in sys.argv if argument.startswith(OUTPUT)), '')


def report(verdicts: List[Verdict], marks: Sequence[Mark] = ()) -> bool:
    """Report the verdicts to rostest, each as a test case; returns whether all conditions are met."""
    for verdict in verdicts:
        print(('met     ' if verdict.is_met else 'NOT MET ') + verdict.words, flush=True)
    if marks:
        print(gradescope.total(marks), flush=True)
    cases = type('Mission', (unittest.TestCase,), {f'test_{verdict.name}': _case(verdict) for verdict in verdicts})
    suite = unittest.TestLoader().loadTestsFromTestCase(cases)
    if TEXT in sys.argv:
        return unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful()
    path = _results_file()
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
