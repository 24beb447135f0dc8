#!/usr/bin/env python3
"""The cleaner's actions on a floor on which nothing goes wrong: what they do, publish, and refuse."""

import math
import unittest

import rospy
import rostest
from cleaners import Cleaner, drives, go_to
from nav_msgs.msg import Path
from simulators import TICK, Commands, Heard, Simulator, shared, wait

from rumba_msg.msg import CleanGoal, DockGoal, GoToActionFeedback, MissionStatus, Outcome, UndockGoal
from rumba_msg.srv import TargetPosition

NAN = math.nan


class CleanerActionsTest(unittest.TestCase):
    """One simulator of the studio and one cleaner; each test begins with the robot on its dock."""

    @classmethod
    def setUpClass(cls):
        fixture = shared(cls)
        cls.cleaner = Cleaner(fixture)
        cls.simulator = Simulator(fixture, '_map:=studio', '_speed:=10', '_rates/ground_truth:=50')
        cls.cleaner.connect()

    def setUp(self):
        self.simulator.does('reset')
        self.docked = Heard(self, '/rumba/dock_status')
        self.docked.fresh(lambda message: message.is_docked)
        self.truth = Heard(self, '/rumba/ground_truth')

    def truth_now(self):
        """The truth about the robot at this tick, or soon after: on a busy machine, older messages still arrive."""
        _, tick = self.simulator.digest()
        return self.truth.fresh(lambda message: message.header.stamp.to_nsec() >= tick * TICK)

    def pose(self):
        """Where the robot is now, in truth."""
        pose = self.truth_now().pose.pose
        return pose.position.x, pose.position.y, 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)

    def assert_at_rest(self):
        """The newest command is to stop, the robot does, and no further command comes."""
        self.truth.fresh(lambda message: message.twist.twist.linear.x == message.twist.twist.angular.z == 0.0)
        last = self.cleaner.commands.messages[-1]
        self.assertEqual((last.linear.x, last.angular.z), (0.0, 0.0))
        count, begin = len(self.cleaner.commands.messages), self.truth.fresh().header.stamp
        self.truth.find(lambda message: (message.header.stamp - begin).to_sec() > 1.0)
        self.assertEqual(len(self.cleaner.commands.messages), count)

    def test_go_to_arrives_where_it_says_at_rest_with_the_heading(self):
        goal = self.cleaner.send('go_to', go_to(1.0, 2.5, -2.0))
        answer = goal.ends(Outcome.SUCCEEDED)
        x, y, theta = self.pose()
        self.assertLess(math.hypot(x - 1.0, y - 2.5), 0.03)
        self.assertLess(abs(theta + 2.0), 0.05)
        for told, true in zip((answer.pose.x, answer.pose.y, answer.pose.theta), (x, y, theta)):
            self.assertAlmostEqual(told, true, delta=0.005)
        self.assertRegex(answer.outcome.message, r'^at \(')
        self.assert_at_rest()
        self.assertEqual(self.cleaner.states()[-2:], [MissionStatus.GOING_TO, MissionStatus.IDLE])
        self.assertGreater(goal.feedback[0].pose.x, goal.feedback[-1].pose.x)
        remaining = [feedback.distance_remaining for feedback in goal.feedback
                     if not math.isnan(feedback.distance_remaining)]  # NaN until a path is planned
        self.assertGreater(remaining[0], remaining[-1])

    def test_the_plan_is_shown_as_long_as_it_is_followed(self):
        plan = Heard(self, '/rumba/plan', Path)
        plan.find(lambda message: not message.poses)
        goal = self.cleaner.send('go_to', go_to(1.0, 2.5, 0.0))
        last = plan.find(lambda message: message.poses).poses[-1].pose.position
        self.assertLess(math.hypot(last.x - 1.0, last.y - 2.5), 0.03)
        self.assertFalse(goal.has_ended)
        goal.ends(Outcome.SUCCEEDED)
        plan.last(lambda message: not message.poses)

    def test_any_heading_will_do_if_none_is_named(self):
        self.cleaner.send('go_to', go_to(2.0, 2.4)).ends(Outcome.SUCCEEDED)
        x, y, _ = self.pose()
        self.assertLess(math.hypot(x - 2.0, y - 2.4), 0.03)

    def test_feedback_comes_at_1_hz_of_simulated_time(self):
        feedback = Heard(self, '/rumba/go_to/feedback', GoToActionFeedback)
        self.cleaner.status.messages.clear()
        self.cleaner.send('go_to', go_to(0.8, 2.4, 0.0)).ends(Outcome.SUCCEEDED)
        first, *_, last = [message.header.stamp.to_sec() for message in self.cleaner.status.messages]
        self.assertGreater(last - first, 4.0)
        for messages in (feedback.messages, self.cleaner.status.messages[:-1]):
            self.assertAlmostEqual(len(messages), last - first, delta=1.0 + 0.25 * (last - first))

    def test_undock_and_dock(self):
        self.cleaner.status.messages.clear()
        undock = self.cleaner.send('undock', UndockGoal())
        self.assertFalse(undock.ends(Outcome.SUCCEEDED).is_docked)
        self.assertAlmostEqual(undock.feedback[0].distance_remaining, 0.4, delta=0.05)
        x, y, theta = self.pose()
        self.assertAlmostEqual(x, 3.075 - 0.45, delta=0.1)
        self.assertAlmostEqual(abs(theta), math.pi, delta=0.1)
        outcome = self.cleaner.send('undock', UndockGoal()).ends(Outcome.SUCCEEDED).outcome
        self.assertEqual(outcome.message, 'was not docked')
        self.simulator.teleport(2.6, 0.6, -1.5)  # behind a corner: out of the beams
        dock = self.cleaner.send('dock', DockGoal())
        self.assertTrue(dock.ends(Outcome.SUCCEEDED).is_docked)
        # The first feedback may come before this test listens to it.
        self.assertGreater(max(feedback.distance_remaining for feedback in dock.feedback
                               if not math.isnan(feedback.distance_remaining)), 0.2)
        self.assertTrue(any(feedback.dock_visible for feedback in dock.feedback))
        self.assertTrue(self.docked.fresh().is_docked)
        kinds = MissionStatus
        self.assertEqual([state for state in self.cleaner.states() if state != kinds.IDLE],
                         [kinds.UNDOCKING, kinds.RETURNING, kinds.DOCKING])

    def test_a_small_mission_goes_through_its_states_and_its_result_describes_the_floor(self):
        self.cleaner.status.messages.clear()
        goal = self.cleaner.send('clean', CleanGoal(strategy='', target_coverage=0.05))
        answer = goal.ends(Outcome.SUCCEEDED)
        kinds = MissionStatus
        self.assertEqual(self.cleaner.states(), [
            kinds.UNDOCKING, kinds.CLEANING, kinds.RETURNING, kinds.DOCKING, kinds.IDLE])
        strategies = {status.strategy for status in self.cleaner.status.messages if status.state == kinds.CLEANING}
        self.assertEqual(strategies, {'boustrophedon'})
        self.assertTrue(self.docked.fresh().is_docked)
        newest = Heard(self, '/rumba/cleaning_status').fresh()
        self.assertEqual((answer.cleaning.coverage, answer.cleaning.time), (newest.coverage, newest.time))
        self.assertEqual(answer.cleaning.distance, newest.distance)
        self.assertAlmostEqual(newest.coverage, 0.05, delta=0.03)
        self.assertRegex(answer.outcome.message, r'^\d+\.\d % swept$')
        self.assertIn(kinds.CLEANING, [feedback.mission.state for feedback in goal.feedback])
        self.assertGreater(goal.feedback[-1].cleaning.coverage, 0.04)

    def test_cancel_stops_the_wheels_at_once(self):
        goals = {'go_to': go_to(0.8, 2.4, 0.0), 'clean': CleanGoal(), 'undock': UndockGoal()}
        for action, goal in goals.items():
            self.simulator.does('reset')
            self.docked.fresh(lambda message: message.is_docked)
            goal = self.cleaner.send(action, goal)
            self.cleaner.waits_to_drive()
            goal.handle.cancel()
            self.assertEqual(goal.ends(Outcome.CANCELLED).outcome.message, 'cancelled')
            self.assert_at_rest()
            self.assertGreater(math.hypot(self.pose()[0] - 0.8, self.pose()[1] - 2.4), 0.5)
        self.assertEqual(self.cleaner.settles().state, MissionStatus.IDLE)

    def test_a_new_goal_preempts_the_one_before_on_any_action(self):
        first = self.cleaner.send('clean', CleanGoal())
        self.cleaner.waits_to_drive()
        second = self.cleaner.send('go_to', go_to(0.8, 3.4))
        self.assertEqual(first.ends(Outcome.PREEMPTED).outcome.message, 'preempted by a goal of go_to')
        second.is_active()
        third = self.cleaner.send('go_to', go_to(2.4, 2.4, 1.0))
        self.assertEqual(second.ends(Outcome.PREEMPTED).outcome.message, 'preempted by a goal of go_to')
        third.ends(Outcome.SUCCEEDED)
        x, y, theta = self.pose()
        self.assertLess(math.hypot(x - 2.4, y - 2.4), 0.03)
        self.assertLess(abs(theta - 1.0), 0.05)

    def test_a_goal_that_cannot_be_carried_out_is_refused_and_nothing_moves(self):
        known = r"^unknown strategy 'zigzag': known are .*\bbounce, boustrophedon\b.*\bspiral, wall_follow, wander$"
        for pattern, action, goal in (
                (known, 'clean', CleanGoal(strategy='zigzag')),
                (r'^target_coverage is 1\.5: must be 0 to 1$', 'clean', CleanGoal(target_coverage=1.5)),
                (r'^target_coverage is -0\.1: must be 0 to 1$', 'clean', CleanGoal(target_coverage=-0.1)),
                (r'^target_coverage is nan: must be 0 to 1$', 'clean', CleanGoal(target_coverage=NAN)),
                (r'^time_limit is -1\.0: must be a finite number, 0 or more \[s\]$', 'dock', DockGoal(-1.0)),
                (r'^time_limit is nan: must be ', 'undock', UndockGoal(NAN)),
                (r'^time_limit is inf: must be ', 'clean', CleanGoal(time_limit=math.inf)),
                (r'^target at \(3\.90, 2\.50\) m is 0\.\d+ m from the nearest wall: a robot of radius 0\.174 m does ',
                 'go_to', go_to(3.9, 2.5)),
                (r'^target at \(-5\.00, 2\.00\) m lies outside the map', 'go_to', go_to(-5.0, 2.0)),
                (r'^target \(nan, 2\.0, 0\.0\): must be finite numbers$', 'go_to', go_to(NAN, 2.0, 0.0)),
                (r'^target \(1\.0, 2\.0, inf\): must be finite numbers$', 'go_to', go_to(1.0, 2.0, math.inf))):
            self.cleaner.refuses(pattern, action, goal)
        self.assertTrue(self.docked.fresh().is_docked)

    def test_a_goal_that_is_refused_leaves_the_one_before_alone(self):
        goal = self.cleaner.send('go_to', go_to(1.5, 2.4))
        self.cleaner.send('clean', CleanGoal(strategy='zigzag')).ends(Outcome.REFUSED)
        goal.ends(Outcome.SUCCEEDED)

    def test_the_time_limit_counts_simulated_time(self):
        begin = self.truth.fresh().header.stamp
        answer = self.cleaner.send('go_to', go_to(0.8, 2.4, 0.0, time_limit=2.0)).ends(Outcome.TIMED_OUT)
        self.assertRegex(answer.outcome.message, r'^not done after 2 s: ')
        self.assertGreater((self.truth_now().header.stamp - begin).to_sec(), 2.0)
        self.assertLess((self.truth.messages[-1].header.stamp - begin).to_sec(), 8.0)
        self.assert_at_rest()
        self.assertGreater(self.pose()[0], 1.5)

    def test_a_robot_that_is_put_elsewhere_arrives_nevertheless(self):
        for action, goal in (('go_to', go_to(2.4, 2.4, 1.0)), ('dock', DockGoal())):
            self.simulator.teleport(0.7, 3.2, 1.0)
            goal = self.cleaner.send(action, goal)
            self.cleaner.waits_to_drive()
            self.simulator.teleport(2.6, 0.5, 1.5)
            goal.ends(Outcome.SUCCEEDED)
        self.assertTrue(self.docked.fresh().is_docked)

    def test_go_to_position_leads_there_call_by_call(self):
        self.simulator.teleport(1.0, 3.4, 0.0)
        ask = rospy.ServiceProxy('/rumba/go_to_position', TargetPosition)
        target = (2.6, 0.6, 2.0)
        commands = Commands(self)

        def is_there():
            was_moving = drives(self.truth_now().twist.twist)  # on a busy machine it turns too far at first
            answer = ask(*target)
            self.assertTrue(answer.feedback, answer.message)
            commands.send(answer.linear_x, answer.angular_z)
            is_commanded = (answer.linear_x, answer.angular_z) != (0.0, 0.0)
            return answer.message == 'there' and not is_commanded and not was_moving
        wait(self, is_there, 'the target')
        x, y, theta = self.pose()
        self.assertLess(math.hypot(x - target[0], y - target[1]), 0.03)
        self.assertLess(abs(theta - target[2]), 0.1)
        for pattern, place in ((r'must be finite numbers$', (NAN, 2.0, 0.0)), ('does not fit$', (3.9, 2.5, 0.0)),
                               ('outside the map', (50.0, 2.5, 0.0)), ('must be finite', (1.0, 2.0, NAN))):
            answer = ask(*place)
            self.assertEqual((answer.linear_x, answer.angular_z, answer.feedback), (0.0, 0.0, False))
            self.assertRegex(answer.message, pattern)

    def test_go_to_position_does_not_disturb_a_goal(self):
        ask = rospy.ServiceProxy('/rumba/go_to_position', TargetPosition)
        goal = self.cleaner.send('go_to', go_to(0.8, 2.4))
        while not goal.has_ended:
            self.assertTrue(ask(2.6, 0.6, 0.0).feedback)
        goal.ends(Outcome.SUCCEEDED)
        self.assertLess(abs(self.pose()[0] - 0.8), 0.03)

    def test_brushes_are_down_only_to_clean(self):
        battery = Heard(self, '/rumba/battery_status')
        self.cleaner.send('clean', CleanGoal(target_coverage=0.03))
        battery.fresh(lambda message: not message.brushes_up)
        self.cleaner.send('go_to', go_to(1.0, 2.4)).ends(Outcome.SUCCEEDED)
        battery.fresh(lambda message: message.brushes_up)

    def test_dock_on_the_dock_is_done_at_once(self):
        self.assertTrue(self.cleaner.send('dock', DockGoal()).ends(Outcome.SUCCEEDED).is_docked)
        self.assertGreater(self.pose()[0], 3.0)


if __name__ == '__main__':
    rospy.init_node('test_cleaner_actions')
    rostest.rosrun('rumba_cleaning', 'cleaner_actions', CleanerActionsTest)
