#!/usr/bin/env python3
"""turtle_teleop_key, draw_square and mimic."""

import itertools
import math
import os
import pty
import signal
import subprocess
import termios
import unittest

import programs
import rospy
import rostest
from nodes import Heard, Node, Turtlesim, commander, run, start, wait, without_display

MIDDLE = 5.544444


def movements(poses):
    """The poses of a turtle that moves, in lists: one for each side that it drives, and for each turn."""
    moving = [pose for pose in poses[:] if pose.linear_velocity or pose.angular_velocity]
    return [list(group) for _, group in itertools.groupby(moving, lambda pose: pose.angular_velocity != 0.0)]


class ClientsTest(unittest.TestCase):
    """Each test starts its own nodes."""

    def teleop(self, *arguments):
        """Start turtle_teleop_key in a terminal; return node, both ends of the terminal, and its settings before."""
        ours, theirs = pty.openpty()
        for end in (ours, theirs):
            self.addCleanup(os.close, end)
        found = termios.tcgetattr(theirs)
        command = ['setsid', '--ctty', programs.executable('turtlesim', 'turtle_teleop_key'), *arguments]
        node = Node(self, subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs))
        wait(self, lambda: b'q quits' in os.read(ours, 10000), 'its help')
        return node, ours, theirs, found

    def test_arrow_keys_drive_and_q_quits_and_restores_the_terminal(self):
        rospy.set_param('/scale_linear', 1.5)
        self.addCleanup(rospy.delete_param, '/scale_linear')
        node, keyboard, terminal, found = self.teleop()
        heard = Heard(self, '/turtle1/cmd_vel')
        wait(self, lambda: not termios.tcgetattr(terminal)[3] & termios.ECHO, 'a terminal without echo')
        # Keys that are typed before the subscriber is connected are lost.
        wait(self, lambda: (os.write(keyboard, b'\x1b[D'), heard.messages)[1], 'the first command')
        os.write(keyboard, b'\x1b[A\x1b[B\x1bOBxA\x1b[C')
        wait(self, lambda: heard.messages[-1].angular.z == -2.0, 'the last command')
        commands = [(twist.linear.x, twist.angular.z) for twist in heard.messages]
        self.assertEqual(set(commands[:-4]), {(0.0, 2.0)})
        self.assertEqual(commands[-4:], [(1.5, 0.0), (-1.5, 0.0), (-1.5, 0.0), (0.0, -2.0)])
        os.write(keyboard, b'q')
        wait(self, lambda: node.process.poll() is not None, 'the end')
        self.assertEqual(node.process.returncode, 0)
        self.assertEqual(termios.tcgetattr(terminal), found)

    def test_a_signal_restores_the_terminal(self):
        node, _, terminal, found = self.teleop()
        wait(self, lambda: termios.tcgetattr(terminal) != found, 'single keys')
        node.end(signal.SIGTERM)
        self.assertEqual(termios.tcgetattr(terminal), found)

    def test_the_keys_drive_turtle1(self):
        Turtlesim(self)
        pose = Heard(self, '/turtle1/pose')
        _, keyboard, _, _ = self.teleop()
        wait(self, lambda: (os.write(keyboard, b'\x1b[A'), pose.messages[-1].x > MIDDLE + 1.0)[1], 'a drive')

    def test_without_a_terminal_or_with_a_bad_scale_it_prints_one_line_and_exits_with_code_2(self):
        ours, theirs = pty.openpty()
        rospy.set_param('/scale_angular', 'fast')
        self.addCleanup(rospy.delete_param, '/scale_angular')
        for stdin, pattern in ((subprocess.DEVNULL, 'the standard input is not a term'),
                               (theirs, "parameter /scale_angular is 'fast': must be -1000 to 1000")):
            done = run('turtle_teleop_key', stdin=stdin)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, rf'\Ateleop_turtle: {pattern}[^\n]*\n\Z')
        os.close(ours)
        os.close(theirs)

    def test_draw_square_resets_the_field_and_draws_a_square_of_2_m(self):
        node = Turtlesim(self, '_speed:=2')
        node.call('turtle1/teleport_absolute', 1.0, 1.0, 2.0)
        pose = Heard(self, '/turtle1/pose')
        Node(self, start('draw_square'))
        for count in range(2, 9):  # a movement is complete when the next one has begun
            wait(self, lambda: len(movements(pose.messages)) >= count, f'movement {count}')
        found = movements(pose.messages)[:8]
        first, before = found[0][0], (MIDDLE, MIDDLE, 0.0)
        self.assertLess(math.dist((first.x, first.y), before[:2]), 0.5)
        # A command that comes late, on a busy machine, makes a movement longer, never shorter.
        for number, movement in enumerate(found[:-1]):
            end = movement[-1]
            turned = math.remainder(end.theta - before[2], 2.0 * math.pi)
            driven = math.dist((end.x, end.y), before[:2])
            if number % 2:
                self.assertTrue(0.5 * math.pi - 0.03 < turned < 2.9 and driven < 1e-3, (turned, driven))
            else:
                self.assertTrue(1.97 < driven < 3.1 and abs(turned) < 1e-3, (turned, driven))
            before = end.x, end.y, end.theta

    def test_mimic_moves_a_turtle_as_one_of_another_field_moves(self):
        Node(self, subprocess.Popen(['roslaunch', 'turtlesim', 'multisim.launch'], env=without_display(),
                                    stdout=subprocess.DEVNULL))
        Node(self, start('mimic', 'input:=turtlesim1/turtle1', 'output:=turtlesim2/turtle1'))
        first, second = Heard(self, '/turtlesim1/turtle1/pose'), Heard(self, '/turtlesim2/turtle1/pose')
        Heard(self, '/turtlesim2/turtle1/cmd_vel').find()
        commander(self, 'turtlesim1/turtle1')(1.0, 0.0, 0.8)
        moving = second.find(lambda pose: pose.linear_velocity != 0.0)
        self.assertAlmostEqual(moving.linear_velocity, 1.0, places=6)
        self.assertAlmostEqual(moving.angular_velocity, 0.8, places=6)
        # On a busy machine the copy may start and stop some steps later than the turtle, but on the same circle.
        for heard in (first, second):
            end = heard.find(lambda pose: pose.theta > 0.0 and pose.linear_velocity == 0.0)
            self.assertAlmostEqual(end.x, MIDDLE + 1.25 * math.sin(end.theta), delta=0.02)
            self.assertAlmostEqual(end.y, MIDDLE + 1.25 * (1.0 - math.cos(end.theta)), delta=0.02)


if __name__ == '__main__':
    rospy.init_node('test_clients', disable_rostime=True)
    rostest.rosrun('turtlesim', 'clients', ClientsTest)
