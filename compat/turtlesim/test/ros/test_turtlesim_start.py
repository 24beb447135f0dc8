#!/usr/bin/env python3
"""turtlesim_node starts with and without a window, at any speed, or refuses to start."""

import signal
import subprocess
import time
import unittest

import rospy
import rostest
from nodes import TIMEOUT, Heard, Turtlesim, commander, forget_parameters, run, start, wait, without_display

MIDDLE = 5.544444
STEP = 16_000_000  # [ns]


class TurtlesimStartTest(unittest.TestCase):
    """Each test starts a node."""

    def assert_refused(self, pattern, *arguments):
        """Start a node that must refuse its arguments with one line and exit code 2."""
        done = run('turtlesim_node', *arguments)
        self.assertEqual((done.returncode, done.stdout), (2, ''), done.stderr)
        self.assertRegex(done.stderr, rf'\Aturtlesim: {pattern}[^\n]*\n\Z')

    def test_bad_input_gets_one_line_and_exit_code_2_and_leaves_no_parameter(self):
        forget_parameters('/turtlesim')
        for pattern, *arguments in (
                ("parameter /turtlesim/png_name is '/tmp/a.png': must be letters, digits", '_png_name:=/tmp/a.png'),
                ('parameter /turtlesim/speed is -1: must be 0 to 1e', '_speed:=-1'),
                ("parameter /turtlesim/gui is 'perhaps': must be true, false or auto", '_gui:=perhaps'),
                ('_speed:=.9999.* cannot be a parameter: int exceeds XML-RPC limits$', f'_speed:={40 * "9"}'),
                (r'_png_name:=.\[. cannot be a parameter: ', '_png_name:=[', '_png_name:=a.png'),
                ('gui is true, but there is no display', '_gui:=true'),
                ('unknown parameter _spede: known are _background_r:=, ', '_spede:=2'),
                ("unknown argument 'fast': known are ", 'fast'),
                (r"cannot start: \[Errno 20\] Not a directory: '/dev/null/x'$", '__log:=/dev/null/x'),
                ('speed:= remaps a topic: for the parameter write _speed:=', 'speed:=2')):
            self.assert_refused(pattern, *arguments)
            self.assertFalse(rospy.get_param('/turtlesim', {}))
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_without_a_master_it_says_so_and_waits(self):
        node = start('turtlesim_node', '_speed:=2', stderr=subprocess.PIPE, universal_newlines=True,
                     env=without_display(ROS_MASTER_URI='http://localhost:9'))
        self.addCleanup(node.communicate)
        self.addCleanup(node.kill)
        self.assertEqual(node.stderr.readline(),
                         'turtlesim: no roscore answers at http://localhost:9 yet: waiting for it\n')
        node.send_signal(signal.SIGINT)
        self.assertEqual(node.communicate(timeout=TIMEOUT), (None, ''))

    def test_help_names_every_parameter(self):
        done = subprocess.run(['rosrun', 'turtlesim', 'turtlesim_node', '--help'], stdout=subprocess.PIPE, check=True,
                              universal_newlines=True, timeout=TIMEOUT)
        for name in ('background_r', 'background_g', 'background_b', 'speed', 'gui', 'png_name'):
            self.assertRegex(done.stdout, rf'\n  {name} +\w')

    def test_without_a_display_it_logs_one_line_and_works(self):
        node = Turtlesim(self, stdout=subprocess.PIPE, universal_newlines=True)
        Heard(self, '/turtle1/pose').find()
        node.end()
        self.assertRegex(node.process.stdout.read(), r'\A\[INFO\] \S+: no window: there is no display\n'
                                                     r'\[INFO\] \S+: Starting turtlesim with node name /turtlesim\n')

    def test_a_window_opens_on_the_offscreen_platform_of_qt(self):
        node = Turtlesim(self, '_gui:=true', '-platform', 'offscreen', stdout=subprocess.PIPE, universal_newlines=True)
        pose = Heard(self, '/turtle1/pose')
        commander(self)(1.0, 0.0, 0.0)
        pose.find(lambda pose: pose.x > MIDDLE + 0.9)
        node.end()
        self.assertNotIn('no window', node.process.stdout.read())

    def test_faster_than_real_time_every_step_is_on_the_clock_and_commands_last_a_second_of_it(self):
        node = Turtlesim(self, '_speed:=10')
        self.assertTrue(rospy.get_param('/use_sim_time'))
        clock, pose = Heard(self, '/clock'), Heard(self, '/turtle1/pose')
        begin, first = time.monotonic(), clock.fresh().clock.to_nsec()
        last = clock.find(lambda message: message.clock.to_nsec() >= first + 10_000_000_000)
        took = time.monotonic() - begin
        # The first message took a moment to arrive, and a busy machine may be very late.
        self.assertGreater(took, 0.8)
        self.assertLess(took, 8.0)
        times = [message.clock.to_nsec() for message in clock.messages]
        times = times[:times.index(last.clock.to_nsec()) + 1]
        differences = [later - earlier for earlier, later in zip(times, times[1:])]
        self.assertTrue(all(difference > 0 and difference % STEP == 0 for difference in differences), differences)
        # A subscriber on a busy machine may miss some.
        self.assertGreater(differences.count(STEP), 0.9 * len(differences))
        commander(self)(2.0, 0.0, 0.0)
        end = pose.find(lambda pose: pose.x > 7.0 and pose.linear_velocity == 0.0)
        self.assertAlmostEqual(end.x, MIDDLE + 2.0 * 63 * 0.016, 5)
        node.end()
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_as_fast_as_possible_services_are_answered(self):
        node = Turtlesim(self, '_speed:=0')
        clock = Heard(self, '/clock')
        clock.find(lambda message: message.clock.to_sec() > 60.0)
        node.call('turtle1/teleport_absolute', 2.0, 3.0, 1.0)
        pose = Heard(self, '/turtle1/pose').find()
        self.assertEqual((pose.x, pose.y, pose.theta), (2.0, 3.0, 1.0))

    def test_a_second_node_that_would_publish_the_clock_is_refused(self):
        Turtlesim(self, '_speed:=2')
        self.assert_refused('speed is not 1, but /turtlesim publishes /clock already',
                            '__ns:=/other', '_speed:=3')
        self.assertTrue(rospy.get_param('/use_sim_time'))
        clock = Heard(self, '/clock')
        first = clock.fresh().clock
        wait(self, lambda: (clock.messages[-1].clock - first).to_sec() > 1.0, 'time')

    def test_the_topics_that_a_killed_node_left_at_the_master_do_not_hinder_a_new_one(self):
        killed = Turtlesim(self, '_speed:=2', '__ns:=/killed', name='/killed/turtlesim')
        killed.process.kill()
        killed.process.wait(TIMEOUT)
        self.assertIn('/clock', dict(rospy.get_published_topics()))
        node = Turtlesim(self, '_speed:=2')
        Heard(self, '/turtle1/pose').find()
        node.end()
        self.assertFalse(rospy.has_param('/use_sim_time'))

    def test_afterwards_use_sim_time_is_true_if_it_was_true_before(self):
        self.addCleanup(forget_parameters, '/use_sim_time')
        rospy.set_param('/use_sim_time', True)
        node = Turtlesim(self, '_speed:=2')
        Heard(self, '/clock').find()
        node.end()
        self.assertTrue(rospy.get_param('/use_sim_time'))
        self.assertFalse(rospy.has_param('/use_sim_time_before_simulator'))


if __name__ == '__main__':
    rospy.init_node('test_turtlesim_start', disable_rostime=True)
    rostest.rosrun('turtlesim', 'turtlesim_start', TurtlesimStartTest)
