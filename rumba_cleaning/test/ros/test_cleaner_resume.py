#!/usr/bin/env python3
"""A cleaning that was interrupted is resumed with its memory, or forgotten; clients get answers during planning."""

import os
import time
import unittest

import rospy
import rostest
from cleaners import Cleaner, go_to
from geometry_msgs.msg import Twist
from simulators import Heard, Simulator, folder_of, shared, wait
from tiers import thorough

from rumba_msg.msg import CleanGoal, MissionStatus, Outcome

TARGET = 0.15
INTERRUPTED_AT = 0.08
SWEPT_AGAIN = 0.2  # of the time with the brushes down; without memory it would be 0.5
# Planning takes as long as on a very large map, as long as there is a file named slow beside this module.
SLOW_PLANNER = """import pathlib
import time
from rumba_cleaning.strategies import boustrophedon
plan = boustrophedon.plan
def slow_plan(context, *poses):
    while pathlib.Path(__file__).with_name('slow').exists():
        time.sleep(0.01)
    return plan(context, *poses)
boustrophedon.plan = slow_plan
"""
SOON = 2.0  # [s] of the wall clock


class CleanerResumeTest(unittest.TestCase):
    """One simulator of the studio and one cleaner; each test begins with the robot on its dock."""

    @classmethod
    def setUpClass(cls):
        fixture = shared(cls)
        folder = folder_of(fixture, {'slow_planner.py': SLOW_PLANNER.encode()})
        cls.slow = folder / 'slow'
        path = os.environ['PYTHONPATH']
        os.environ['PYTHONPATH'] = f'{folder}:{path}'
        fixture.addCleanup(os.environ.update, PYTHONPATH=path)
        cls.cleaner = Cleaner(fixture, '_strategies:=slow_planner')
        cls.simulator = Simulator(fixture, '_map:=studio', '_speed:=50')
        cls.cleaner.connect()

    def setUp(self):
        self.simulator.does('reset')
        self.figures = Heard(self, '/rumba/cleaning_status')
        self.figures.fresh(lambda message: message.coverage == 0.0)

    def cleans(self, coverage, **goal):
        """Send a goal of clean, and wait until so much is clean; returns the goal."""
        goal = self.cleaner.send('clean', CleanGoal(**goal))
        self.figures.fresh(lambda message: message.coverage >= coverage)
        return goal

    def is_nothing_to_resume(self):
        """A goal to resume is refused."""
        self.cleaner.refuses('^nothing to resume: no cleaning was preempted or cancelled, or lost its robot, since the '
                             'simulator was started or reset; send a goal without resume$', 'clean',
                             CleanGoal(resume=True))

    def test_1_there_is_nothing_to_resume_before_a_cleaning_was_interrupted(self):
        self.is_nothing_to_resume()
        goal = self.cleaner.send('go_to', go_to(2.4, 2.4)).is_active()
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        wait(self, lambda: self.cleaner.commands.messages[-1:] == [Twist()], 'a stop')
        self.is_nothing_to_resume()

    @thorough
    def test_2_a_preempted_cleaning_is_resumed_and_sweeps_little_again(self):
        self.cleaner.send('clean', CleanGoal(target_coverage=TARGET)).ends(Outcome.SUCCEEDED)
        seconds = self.figures.fresh().time
        self.simulator.does('reset')
        self.figures.fresh(lambda message: message.coverage == 0.0)
        first = self.cleans(INTERRUPTED_AT, target_coverage=TARGET)
        self.cleaner.send('go_to', go_to(1.0, 2.5)).ends(Outcome.SUCCEEDED)
        first.ends(Outcome.PREEMPTED)
        interrupted_at = self.figures.fresh().coverage
        self.assertLess(interrupted_at, INTERRUPTED_AT + 0.1)
        answer = self.cleaner.send('clean', CleanGoal(resume=True)).ends(Outcome.SUCCEEDED)
        self.assertAlmostEqual(answer.cleaning.coverage, TARGET, delta=0.03)
        self.assertLess(answer.cleaning.time, (1.0 + SWEPT_AGAIN) * seconds)
        self.is_nothing_to_resume()

    def test_3_a_cancelled_cleaning_is_resumed_twice_with_its_strategy(self):
        goal = self.cleans(0.05, strategy='bounce', target_coverage=TARGET)
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        goal = self.cleans(0.1, resume=True)
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        self.cleaner.status.messages.clear()
        self.cleaner.send('clean', CleanGoal(resume=True)).ends(Outcome.SUCCEEDED)
        self.assertEqual({message.strategy for message in self.cleaner.status.messages
                          if message.state == MissionStatus.CLEANING}, {'bounce'})

    def test_4_a_goal_to_resume_takes_a_cleaning_over_that_is_going_on(self):
        first = self.cleans(0.05, target_coverage=0.1)
        second = self.cleaner.send('clean', CleanGoal(resume=True))
        first.ends(Outcome.PREEMPTED)
        self.assertAlmostEqual(second.ends(Outcome.SUCCEEDED).cleaning.coverage, 0.1, delta=0.03)

    def test_5_a_new_cleaning_forgets_the_interrupted_one(self):
        goal = self.cleans(0.05)
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        self.cleaner.send('clean', CleanGoal(target_coverage=0.01)).ends(Outcome.SUCCEEDED)
        self.is_nothing_to_resume()

    def test_6_a_refused_goal_leaves_the_interrupted_cleaning_alone(self):
        goal = self.cleans(0.05, target_coverage=0.1)
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        self.cleaner.send('clean', CleanGoal(strategy='zigzag')).ends(Outcome.REFUSED)
        self.cleaner.send('clean', CleanGoal(resume=True, time_limit=-1.0)).ends(Outcome.REFUSED)
        self.cleaner.send('clean', CleanGoal(resume=True)).ends(Outcome.SUCCEEDED)

    def test_7_an_interrupted_cleaning_of_a_world_that_was_reset_is_forgotten(self):
        goal = self.cleans(0.05)
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        self.simulator.does('reset')
        # It is there only by readings of the new world: by then the cleaner has heard of the reset.
        self.cleaner.send('go_to', go_to(2.4, 2.4)).ends(Outcome.SUCCEEDED)
        self.is_nothing_to_resume()

    def test_8_a_cleaning_of_a_world_that_is_reset_begins_again_and_tells_the_truth(self):
        goal = self.cleans(0.5 * TARGET, target_coverage=TARGET)
        self.simulator.does('reset')
        answer = goal.ends(Outcome.SUCCEEDED)
        self.assertAlmostEqual(answer.cleaning.coverage, TARGET, delta=0.03)
        self.assertRegex(answer.outcome.message, r'^1\d\.\d % swept$')

    @thorough
    def test_9_a_resumed_cleaning_of_a_world_that_is_reset_begins_again_too(self):
        goal = self.cleans(0.5 * TARGET, target_coverage=TARGET)
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        goal = self.cleaner.send('clean', CleanGoal(resume=True))
        wait(self, goal.handle.get_goal_status, 'the goal to be accepted')
        self.simulator.does('reset')
        self.assertAlmostEqual(goal.ends(Outcome.SUCCEEDED).cleaning.coverage, TARGET, delta=0.03)

    def test_a_goals_are_cancelled_and_preempted_during_planning(self):
        self.slow.touch()

        def plans():
            goal = self.cleaner.send('clean', CleanGoal(target_coverage=0.05))
            self.cleaner.status.fresh(lambda message: message.message.endswith('planning'))
            return goal
        cancelled = plans()
        begin = time.monotonic()
        cancelled.handle.cancel()
        cancelled.ends(Outcome.CANCELLED)
        self.assertLess(time.monotonic() - begin, SOON)
        preempted = plans()
        begin = time.monotonic()
        going = self.cleaner.send('go_to', go_to(1.0, 2.5))
        preempted.ends(Outcome.PREEMPTED)
        self.assertLess(time.monotonic() - begin, SOON)
        going.ends(Outcome.SUCCEEDED)
        self.slow.unlink()
        self.cleaner.send('clean', CleanGoal(resume=True)).ends(Outcome.SUCCEEDED)

    def test_b_the_node_ends_during_planning(self):
        self.slow.touch()
        self.cleaner.send('clean', CleanGoal())
        self.cleaner.status.fresh(lambda message: message.message.endswith('planning'))
        self.cleaner.end()


if __name__ == '__main__':
    rospy.init_node('test_cleaner_resume')
    rostest.rosrun('rumba_cleaning', 'cleaner_resume', CleanerResumeTest)
