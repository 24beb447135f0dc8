#!/usr/bin/env python3
"""The cleaner when something goes wrong: bad parameters, a robot that is gone, has fallen, or has no charge."""

import os
import signal
import subprocess
import time
import unittest

import programs
import rospy
import rostest
from cleaners import Cleaner, go_to
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Pose2D
from simulators import TIMEOUT, Heard, Simulator, folder_of, shared

from rumba_msg.msg import CleanGoal, MissionStatus, Outcome, UndockGoal

BAD_STARTS = (
    (r"^cleaner: unknown strategy 'zigzag': known are bounce, boustrophedon, explore_and_clean, spiral, wall_follow, "
     'wander\n$', '_strategy:=zigzag'),
    (r"^cleaner: strategies of 'no\.such': No module named 'no'; a module is named as in Python, ",
     '_strategies:=no.such'),
    (r"^cleaner: strategies of 'misspelt': NameError: name 'spede' is not defined \(misspelt\.py:1\)\n$",
     '_strategies:=misspelt'),
    (r"^cleaner: strategies of 'leaves': SystemExit: 3 \(leaves\.py:2\)\n$", '_strategies:=leaves'),
    (r'^cleaner: parameter of /bad_\d+: strategy is 5: must be text\n$', '_strategy:=5'),
    (r"^cleaner: parameter of /bad_\d+: strategies is \['a', 'b'\]: must be text\n$", '_strategies:=[a, b]'),
    (r"^cleaner: there is no map 'moon': give the path of a map_server YAML file, or one of ", '_map:=moon'),
    (r"^cleaner: parameter of /bad_\d+: robot is 'a/b': must be letters, digits and _, beginning with a letter\n$",
     '_robot:=a/b'),
    (r'^cleaner: parameter of /bad_\d+: time_limit/dock is 0\.0: must be 1 to 10000000 \[s\]\n$',
     '_time_limit/dock:=0'),
    (r"^cleaner: parameter of /bad_\d+: sped is unknown: did you mean 'speed'\?\n$", '_sped:=2'))
LONGER_THAN_A_ROBOT_IS_MISSED = 3.0  # [s]


class CleanerTroubleTest(unittest.TestCase):
    """One simulator of the studio and one cleaner, in the order of the tests' names."""

    @classmethod
    def setUpClass(cls):
        fixture = shared(cls)
        cls.cleaner = Cleaner(fixture)
        cls.simulator = Simulator(fixture, '_map:=studio', '_speed:=10')
        cls.cleaner.connect()

    def test_1_a_robot_that_is_gone_is_given_up_and_one_that_comes_back_goes_on_with_its_cleaning(self):
        goal = self.cleaner.send('clean', CleanGoal(strategy='bounce'))
        self.cleaner.waits_to_drive()
        self.simulator.does('kill', 'rumba')
        self.assertEqual(goal.ends(Outcome.NO_READINGS).outcome.message, 'the robot is gone')
        self.assertEqual(self.cleaner.settles().message, 'the robot is gone')
        self.simulator.does('spawn', 'rumba', Pose2D(1.0, 2.5, 0.0))
        self.cleaner.status.last(lambda status: status.message == 'the robot is back, and waits for a goal')
        self.cleaner.status.messages.clear()
        goal = self.cleaner.send('clean', CleanGoal(resume=True))
        cleaning = self.cleaner.status.find(lambda status: status.state == MissionStatus.CLEANING)
        self.assertEqual(cleaning.strategy, 'bounce')
        self.cleaner.send('go_to', go_to(2.0, 2.4)).ends(Outcome.SUCCEEDED)
        goal.ends(Outcome.PREEMPTED)

    def test_2_a_robot_whose_time_stands_still_is_not_gone(self):
        goal = self.cleaner.send('go_to', go_to(1.0, 2.5))
        self.cleaner.waits_to_drive()
        self.simulator.does('pause')
        time.sleep(LONGER_THAN_A_ROBOT_IS_MISSED)
        self.assertFalse(goal.has_ended)
        self.simulator.does('resume')
        goal.ends(Outcome.SUCCEEDED)

    def test_3_a_goal_that_is_cancelled_while_time_stands_still_is_answered(self):
        goal = self.cleaner.send('go_to', go_to(2.4, 2.5))
        self.cleaner.waits_to_drive()
        self.simulator.does('pause')
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        self.simulator.does('resume')

    def test_4_an_empty_battery_ends_every_action_and_leaves_the_robot_stranded(self):
        tuning = Client('/simulator/tuning', timeout=TIMEOUT)
        docked, battery = Heard(self, '/rumba/dock_status'), Heard(self, '/rumba/battery_state')
        for action, goal in (('undock', UndockGoal()), ('go_to', go_to(0.8, 2.4)), ('clean', CleanGoal())):
            tuning.update_configuration({'battery_drain': 1.0})
            self.simulator.does('kill', 'rumba')
            self.simulator.does('spawn', 'rumba', Pose2D(3.075, 2.84, 0.0))
            docked.fresh(lambda message: message.is_docked)
            battery.fresh(lambda message: message.percentage > 0.99)
            self.cleaner.status.messages.clear()
            tuning.update_configuration({'battery_drain': 10000.0})
            outcome = self.cleaner.send(action, goal).ends(Outcome.BATTERY_EMPTY).outcome
            self.assertEqual(outcome.message, 'the battery is empty')
            stranded = self.cleaner.status.find(lambda message: message.state == MissionStatus.STRANDED)
            self.assertEqual(stranded.message, 'the battery is empty')
        tuning.update_configuration({'battery_drain': 1.0})

    def test_5_bad_input_gets_one_line_and_exit_code_2_and_is_forgotten(self):
        folder = folder_of(self, {'misspelt.py': b'spede * 2.0', 'leaves.py': b'import sys\nsys.exit(3)'})
        environment = {**os.environ, 'PYTHONPATH': f'{folder}:{os.environ["PYTHONPATH"]}'}
        for number, (message, argument) in enumerate(BAD_STARTS):
            done = programs.run('rumba_cleaning', 'cleaner', f'__name:=bad_{number}', argument, env=environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIMEOUT,
                                universal_newlines=True)
            self.assertRegex(done.stderr, message)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count('\n')), (2, '', 1))
            self.assertFalse(any(value != {} for value in rospy.get_param(f'/bad_{number}', {}).values()))

    def test_6_a_simulator_that_was_killed_is_no_robot_any_more(self):
        self.simulator.does('reset')
        goal = self.cleaner.send('go_to', go_to(0.7, 2.4, 0.0))
        self.cleaner.waits_to_drive()
        self.simulator.process.send_signal(signal.SIGKILL)
        self.simulator.process.wait(TIMEOUT)
        rospy.delete_param('/use_sim_time')
        self.assertEqual(goal.ends(Outcome.NO_READINGS).outcome.message, 'the robot is gone')


if __name__ == '__main__':
    rospy.init_node('test_cleaner_trouble')
    rostest.rosrun('rumba_cleaning', 'cleaner_trouble', CleanerTroubleTest)
