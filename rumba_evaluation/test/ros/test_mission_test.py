#!/usr/bin/env python3
"""mission_test judges a robot and reports to rostest; this test publishes the robot's topics and its clock."""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

import programs
import rosgraph
import rospy
import rostest
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import BatteryState
from simulators import TIMEOUT, wait
from std_msgs.msg import Float64, Header

from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, DockStatus, SimulatorState
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.robot import Twist
from rumba_sim.ros.robot.packed import OdometryPacker

TOPICS = {'cleaning_status': CleaningStatus, 'ground_truth': Odometry, 'dock_status': DockStatus, 'bumper': Bumper,
          'battery_state': BatteryState, 'battery_status': BatteryStatus, 'level': Float64}

NAMELESS = 'simulator/state:=/nobody/state'  # as if no node told its name there


class Run:
    """A running mission_test."""

    def __init__(self, test, *arguments, robot='', command=()):
        self._test = test
        folder = tempfile.TemporaryDirectory()
        test.addCleanup(folder.cleanup)
        self._results = pathlib.Path(folder.name, 'results.xml')
        if rospy.has_param('/mission_test'):
            rospy.delete_param('/mission_test')
        arguments = [f'_robot:={robot or test.robot}', *arguments, f'--gtest_output=xml:{self._results}']
        streams = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'universal_newlines': True}
        self.process = (subprocess.Popen([*command, *arguments], **streams) if command else
                        programs.start('rumba_evaluation', 'mission_test', *arguments, **streams))
        test.addCleanup(self._kill)

    def _kill(self):
        self.process.kill()
        self.process.communicate()

    def ends(self, exit_code):
        """Wait for the end; returns the failure of each test case by its name ('' if it passed), and stderr."""
        output, errors = self.process.communicate(timeout=TIMEOUT)
        self._test.assertEqual(self.process.returncode, exit_code, output + errors)
        suite = xml.etree.ElementTree.parse(str(self._results)).getroot()
        cases = {case.attrib['name']: ''.join(failure.text for failure in case) for case in suite.iter('testcase')}
        self._test.assertEqual(int(suite.attrib['tests']), len(cases))
        self._test.assertEqual(int(suite.attrib['failures']), len([words for words in cases.values() if words]))
        return cases, errors

    def marks(self):
        """What was written for Gradescope, by the name of the condition."""
        content = json.loads(self._results.with_suffix('.json').read_text())
        return {test['name']: test for test in content['tests']}


class MissionTestTest(unittest.TestCase):
    """Verdicts, one after another; time goes on from each test to the next.

    Each test has a robot of its own, because a publisher counts a killed subscriber as connected until it publishes.
    """

    @classmethod
    def setUpClass(cls):
        cls.seconds = 100.0
        cls.robots = 0
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=10, latch=True)
        cls.state = rospy.Publisher('simulator/state', SimulatorState, queue_size=10, latch=True)
        cls.state.publish(SimulatorState(node=rospy.get_name()))

    def setUp(self):
        type(self).robots += 1
        self.robot = f'judged{self.robots}'
        self.publishers = {topic: rospy.Publisher(f'{self.robot}/{topic}', kind, queue_size=100)
                           for topic, kind in TOPICS.items()}

    def tell(self, topic, message):
        """Publish a message once mission_test has subscribed."""
        wait(self, self.publishers[topic].get_num_connections, f'a subscriber of {topic}')
        self.publishers[topic].publish(message)

    def passes(self, seconds):
        """Advance the robot's clock."""
        type(self).seconds += seconds
        self.clock.publish(rospy.Time.from_sec(self.seconds))

    def time_goes_on(self):
        """Advance the clock a little, after earlier messages have arrived."""
        time.sleep(0.05)
        self.passes(0.5)

    def is_at(self, x, y, theta):
        """Publish the robot's pose."""
        self.tell('ground_truth', OdometryPacker('map', 'base_footprint').message(
            rospy.Time(), Pose(x, y, theta), Twist(0.0, 0.0)))

    def test_each_condition_is_a_test_case_and_all_are_met(self):
        run = Run(self, '_coverage:=0.5', '_reach:=3 1 -0.5', '_docked:=true', '_battery:=20', '_collisions:=1',
                  f'_fields:={self.robot}/level/data -3 -2', '_time_limit:=1000')
        self.passes(0.0)
        for is_pressed in (False, True, True, False):
            self.tell('bumper', Bumper(Header(), is_pressed, False))
        self.tell('battery_state', BatteryState(percentage=0.3))
        self.tell('battery_status', BatteryStatus(percentage_battery=21))
        self.is_at(3.05, 1.0, -0.4)
        self.tell('dock_status', DockStatus(is_docked=False))
        self.tell('dock_status', DockStatus(is_docked=True))
        self.tell('cleaning_status', CleaningStatus(coverage=0.6))
        self.tell('level', Float64(-2.5))
        cases, _ = run.ends(0)
        self.assertEqual(cases, dict.fromkeys(
            ['test_coverage', 'test_reach', 'test_docked', 'test_battery', 'test_collisions',
             f'test_field_{self.robot}_level_data'], ''))
        self.assertEqual({name: mark['score'] for name, mark in run.marks().items()}, {
            'coverage': 1.0, 'reach': 1.0, 'docked': 1.0, 'battery': 1.0, 'collisions': 1.0,
            f'field_{self.robot}_level_data': 1.0})

    def test_failures_are_reported_at_the_time_limit_of_the_robots_clock(self):
        run = Run(self, '_coverage:=0.5', '_reach:=3 1', '_docked:=true', '_battery:=20', '_collisions:=1',
                  f'_fields:={self.robot}/level/data 0 5', '_time_limit:=30')
        self.passes(0.0)
        for is_pressed in (True, False, True, False):
            self.tell('bumper', Bumper(Header(), False, is_pressed))
        self.tell('battery_state', BatteryState(percentage=math.nan))
        self.tell('battery_status', BatteryStatus(percentage_battery=19))
        self.is_at(3.0, 3.0, 0.0)
        self.tell('cleaning_status', CleaningStatus(coverage=0.4))
        self.tell('dock_status', DockStatus(is_docked=True))
        for level in (1.0, 9.0, 3.0):
            self.tell('level', Float64(level))
        wait(self, lambda: run.process.poll() is not None or self.time_goes_on(), 'the end')
        cases, errors = run.ends(1)
        for name, words in (
                ('coverage', r'^coverage: required at least 50\.0 % of the floor swept; measured 40\.0 % after 30\.0 s '
                             r'of 30 s: the time limit is reached; the robot was at \(3\.00, 3\.00\) m\n'),
                ('reach', r'measured a smallest distance of 2\.00 m'),
                ('docked', r'measured on the dock, which it never left'),
                ('battery', r'measured a lowest charge of 19\.0 %'),
                ('collisions', r'at most 1 collision; measured 2'),
                (f'field_{self.robot}_level_data', r'level/data always within 0 to 5; measured 1 to 9')):
            self.assertRegex(cases[f'test_{name}'], words)
        self.assertEqual(errors, '')

    def test_the_time_of_a_run_does_not_begin_before_the_clock_of_the_robot_has_come(self):
        clock = rospy.Publisher(f'{self.robot}/clock', Clock, queue_size=10, latch=True)
        run = Run(self, '_coverage:=0.5', '_time_limit:=30', f'/clock:={clock.resolved_name}')
        for _ in range(10):  # it takes some of them, or all
            self.tell('cleaning_status', CleaningStatus(coverage=0.1))
            time.sleep(0.05)
        clock.publish(rospy.Time(100))
        time.sleep(0.5)  # for a time limit that is over by then
        self.tell('cleaning_status', CleaningStatus(coverage=0.6))
        run.ends(0)

    def test_points_are_earned_in_part_and_it_is_told_when_they_were_lost(self):
        run = Run(self, '_coverage:=0.5', '_collisions:=0', '_points:=coverage 8; collisions 2',
                  '_partial:=coverage 0.1', '_visibility:=hidden', '_time_limit:=30')
        self.passes(0.0)
        self.tell('bumper', Bumper(Header(), False, False))
        self.tell('cleaning_status', CleaningStatus(coverage=0.3))
        self.time_goes_on()
        self.tell('bumper', Bumper(Header(), True, False))
        wait(self, lambda: run.process.poll() is not None or self.time_goes_on(), 'the end')
        run.ends(1)
        marks = run.marks()
        self.assertEqual([(marks[name]['score'], marks[name]['visibility']) for name in ('coverage', 'collisions')],
                         [(4.0, 'hidden'), (0.0, 'hidden')])
        self.assertRegex(marks['collisions']['output'], r'^2 of 2 points lost: .*; violated first after \d+\.\d s')

    def forges(self, topic, kind, message):
        """A node publishes a message on a topic of the robot, and goes on publishing it."""
        forger = subprocess.Popen(
            ['rostopic', 'pub', '-r', '10', f'/{self.robot}/{topic}', kind, message, '__name:=forger'])
        self.addCleanup(forger.wait)
        self.addCleanup(forger.terminate)

    def test_the_node_that_is_marked_cannot_publish_what_it_is_judged_by(self):
        run = Run(self, '_coverage:=0.5', '_battery:=20', '_time_limit:=1000')
        self.passes(0.0)
        self.tell('battery_state', BatteryState(percentage=0.5))
        self.tell('cleaning_status', CleaningStatus(coverage=0.1))
        self.forges('cleaning_status', 'rumba_msg/CleaningStatus', '{coverage: 1.0}')
        cases, _ = run.ends(1)
        for words in cases.values():
            self.assertIn(f': /{self.robot}/cleaning_status is published by /forger: {rospy.get_name()} alone may do '
                          'that', words)

    def test_a_silent_second_publisher_of_what_is_judged_makes_the_run_void(self):
        run = Run(self, '_battery:=20', '_time_limit:=1000')
        self.passes(0.0)
        self.tell('battery_state', BatteryState(percentage=0.5))
        master = rosgraph.Master('/forger')
        master.registerPublisher(f'/{self.robot}/battery_status', 'rumba_msg/BatteryStatus', 'http://localhost:9/')
        self.addCleanup(master.unregisterPublisher, f'/{self.robot}/battery_status', 'http://localhost:9/')
        cases, _ = run.ends(1)
        self.assertIn('battery_status is published by /forger', cases['test_battery'])

    def test_a_run_of_a_robot_whose_node_does_not_tell_its_name_is_void(self):
        run = Run(self, '_coverage:=0.5', '_patience:=3', NAMELESS)
        self.passes(0.0)
        self.tell('cleaning_status', CleaningStatus(coverage=1.0))
        cases, _ = run.ends(1)
        self.assertIn(f'/{self.robot}/cleaning_status is published by {rospy.get_name()}, but no node publishes '
                      '/nobody/state', cases['test_coverage'])

    def test_a_robot_whose_node_does_not_tell_its_name_is_judged_if_that_is_given(self):
        run = Run(self, '_coverage:=0.5', f'_publisher:={rospy.get_name()}', NAMELESS)
        self.passes(0.0)
        self.tell('cleaning_status', CleaningStatus(coverage=1.0))
        run.ends(0)

    def test_a_robot_without_messages_fails(self):
        cases, _ = Run(self, '_battery:=20', '_fields:=nobody/publishes/this 0 1', '_patience:=0.5',
                       robot='nobody').ends(1)
        self.assertRegex(cases['test_battery'], 'measured nothing on /nobody/battery_state or /nobody/battery_status '
                                                'after 0.0 s of 60 s: no message came for 0.5 s of the wall clock')
        self.assertRegex(cases['test_field_nobody_publishes_this'], 'measured nothing on /nobody/publishes/this')

    def test_a_field_that_the_topic_does_not_have_fails(self):
        run = Run(self, '_battery:=20', f'_fields:={self.robot}/battery_state/voltag 0 1', '_time_limit:=1')
        self.passes(0.0)
        self.tell('battery_state', BatteryState(percentage=0.5))
        wait(self, lambda: run.process.poll() is not None or self.time_goes_on(), 'the end')
        cases, _ = run.ends(1)
        self.assertEqual(cases['test_battery'], '')
        self.assertRegex(cases[f'test_field_{self.robot}_battery_state_voltag'],
                         'measured nothing on .*, which has no field voltag; its fields are header, voltage, ')

    def test_a_stopped_test_fails_and_says_so(self):
        run = Run(self, '_battery:=20')
        self.tell('battery_state', BatteryState(percentage=0.5))
        run.process.terminate()
        cases, _ = run.ends(1)
        self.assertRegex(cases['test_battery'], 'the test was stopped')

    def test_matplotlib_is_not_needed(self):
        script = os.path.join(os.path.dirname(__file__), '..', '..', 'scripts', 'mission_test')
        block = ('import runpy, sys; sys.modules["matplotlib"] = None; sys.argv[:1] = []; '
                 'runpy.run_path(sys.argv[0], run_name="__main__")')
        run = Run(self, '_battery:=20', '_patience:=0.5', command=(sys.executable, '-c', block, script))
        cases, errors = run.ends(1)
        self.assertEqual(errors, '')
        self.assertRegex(cases['test_battery'], 'no message came for 0.5 s')

    def test_bad_parameters_fail_with_one_line(self):
        for arguments, message in (
                ([], 'there is no requirement: set one or more of coverage, reach, '),
                (['_coverage:=1.5'], 'parameter of /mission_test: coverage is 1.5: must be 0 to 1'),
                (['_covrage:=0.5'], "parameter of /mission_test: covrage is unknown: did you mean 'coverage'?"),
                (['_reach:=here'], "reach has 'here': must be x y or x y theta"),
                (['_coverage:=0.5', '_points:=docked 1'], "points names 'docked': must be one of coverage"),
                (['_coverage:=0.5', '_wait_for:=a/b'], "wait_for has 'a/b': must be topics of fields, agree and rates"),
                (['_coverage:=0.5', 'nonsense'], "unknown argument 'nonsense'"),
                (['_coverage:=0.5', '_robot:=a/b'], "robot is 'a/b': must be letters")):
            cases, errors = Run(self, *arguments).ends(2)
            self.assertEqual(list(cases), ['test_parameters'])
            self.assertTrue(cases['test_parameters'].startswith(message) or message in cases['test_parameters'])
            self.assertEqual(errors.count('\n'), 1)
            self.assertIn(message, errors)


if __name__ == '__main__':
    rospy.set_param('/use_sim_time', True)
    rospy.init_node('test_mission_test')
    rostest.rosrun('rumba_evaluation', 'mission_test', MissionTestTest)
