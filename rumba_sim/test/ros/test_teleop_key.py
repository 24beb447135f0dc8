#!/usr/bin/env python3
"""teleop_key on a pseudo-terminal, while simulated time stands still."""

import os
import pty
import select
import signal
import subprocess
import termios
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from programs import executable
from std_srvs.srv import SetBool, SetBoolResponse

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0
COMMAND = executable('rumba_sim', 'teleop_key')
READY = 'show the keys'
HIDE_CURSOR, SHOW_CURSOR = '\x1b[?25l', '\x1b[?25h'
ZEROS = 3


class Keyboard:
    """The node in a separate terminal and namespace, and what it publishes."""

    def __init__(self, test, namespace, *arguments, shell=None):
        self.heard = []
        self.screen = ''
        self._test = test
        self._ours, self._theirs = pty.openpty()
        self.found = self.attributes()
        subscriber = rospy.Subscriber(f'/{namespace}/rumba/teleop/cmd_vel', Twist, self._hear)
        command = [COMMAND, f'__ns:=/{namespace}', *arguments]
        if shell:
            command = ['sh', '-mc', shell.format(' '.join(command))]
        self.process = subprocess.Popen(['setsid', '--ctty', *command], stdin=self._theirs, stdout=self._theirs,
                                        stderr=self._theirs)
        for cleanup in (self._close, self.process.wait, self.process.kill, subscriber.unregister):
            test.addCleanup(cleanup)
        self.wait_to_see(READY)

    def _hear(self, twist):
        self.heard.append((twist.linear.x, twist.angular.z))

    def _close(self):
        os.close(self._ours)
        os.close(self._theirs)

    def attributes(self):
        """The settings of the terminal."""
        return termios.tcgetattr(self._theirs)

    def type(self, keys):
        """Type; what was shown and published before is deleted."""
        self.screen = ''
        self.heard.clear()
        os.write(self._ours, keys.encode())

    def wait(self, condition, what):
        """Wait until a condition holds, and read what the node prints."""
        end = time.monotonic() + TIMEOUT
        while not condition():
            self._test.assertLess(time.monotonic(), end, f'{what}; heard {self.heard}, seen {self.screen}')
            self._read(0.01)

    def _read(self, timeout):
        if select.select([self._ours], [], [], timeout)[0]:
            self.screen += os.read(self._ours, 10000).decode()

    def wait_to_see(self, text):
        """Wait until the screen shows a text."""
        self.wait(lambda: text in self.screen, f'to see {text!r}')

    def wait_to_hear(self, linear, angular, times=1):
        """Wait until a command has arrived a number of times."""
        self.wait(lambda: self.heard.count((linear, angular)) >= times, f'to hear {linear, angular}')

    def listen(self, duration):
        """Listen for a time [s]."""
        end = time.monotonic() + duration
        while time.monotonic() < end:
            self._read(0.01)

    def end(self):
        """Wait until the process ends by itself; returns its exit code."""
        self.wait(lambda: self.process.poll() is not None, 'the end')
        self._read(0.0)
        return self.process.returncode


class TeleopKeyTest(unittest.TestCase):
    """Each test has a node; `hold` is long if a loaded machine could miss the key otherwise."""

    def test_each_key_has_its_command(self):
        keyboard = Keyboard(self, 'ways', '_linear:=0.3', '_angular:=0.7', '_hold:=5')
        for key, linear, angular in (
                ('\x1b[A', 0.3, 0.0), ('\x1b[D', 0.0, 0.7), ('\x1b[B', -0.3, 0.0), ('\x1b[C', 0.0, -0.7),
                ('\x1bOA', 0.3, 0.0), ('\x1bOD', 0.0, 0.7), ('u', 0.3, 0.7), ('.', -0.3, 0.7), (' ', 0.0, 0.0),
                ('m', -0.3, -0.7), ('X', 0.0, 0.0), ('o', 0.3, -0.7), ('k', 0.0, 0.0)):
            keyboard.type(key)
            keyboard.wait_to_hear(linear, angular)

    def test_the_robot_stops_after_a_key_is_released_and_then_nothing_is_published(self):
        keyboard = Keyboard(self, 'released')
        begin = time.monotonic()
        keyboard.type('i')
        keyboard.wait_to_hear(0.2, 0.0)
        keyboard.wait_to_hear(0.0, 0.0)
        self.assertGreaterEqual(time.monotonic() - begin, 0.7)
        keyboard.wait_to_hear(0.0, 0.0, times=ZEROS)
        keyboard.listen(0.5)
        moves = len(keyboard.heard) - ZEROS
        self.assertEqual(keyboard.heard, [(0.2, 0.0)] * moves + [(0.0, 0.0)] * ZEROS)
        # At 10 Hz for 0.7 s; a loaded machine may miss some.
        self.assertIn(moves, range(2, 9))

    def test_the_robot_drives_while_a_key_is_held(self):
        keyboard = Keyboard(self, 'held', '_hold:=2', '_rate:=20')
        keyboard.type('i')
        end = time.monotonic() + 3.0
        while time.monotonic() < end:
            os.write(keyboard._ours, b'i')
            keyboard.listen(0.03)
        self.assertEqual(set(keyboard.heard), {(0.2, 0.0)})
        self.assertLessEqual(len(keyboard.heard), 3.2 * 20 + 1)

    def test_speeds_change_and_stay_within_the_limits(self):
        keyboard = Keyboard(self, 'speeds', '_linear:=0.4', '_angular:=1.5', '_hold:=5')
        keyboard.type('w')
        keyboard.wait_to_see('0.44 m/s  1.50 rad/s   stop ')
        keyboard.type('c')
        keyboard.wait_to_see('0.44 m/s  1.35 rad/s   stop ')
        self.assertEqual(keyboard.heard, [])
        keyboard.type('qqqqu')
        keyboard.wait_to_see('0.50 m/s  1.90 rad/s   forward left ')
        keyboard.wait_to_hear(0.5, 1.9)

    def test_the_brushes_go_up_and_down(self):
        asked = []
        rospy.Service('/brushes/rumba/set_brushes_up', SetBool,
                      lambda request: (asked.append(request.data), SetBoolResponse(success=True))[1])
        keyboard = Keyboard(self, 'brushes')
        for state in ('up', 'down', 'up'):
            keyboard.type('b')
            keyboard.wait_to_see(f'brushes {state:<4} ')
        self.assertEqual(asked, [True, False, True])

    def test_what_the_robot_says_of_its_brushes_counts(self):
        asked = []
        rospy.Service('/status/rumba/set_brushes_up', SetBool,
                      lambda request: (asked.append(request.data), SetBoolResponse(False, 'a sock is in the way'))[1])
        publisher = rospy.Publisher('/status/rumba/battery_status', BatteryStatus, queue_size=1, latch=True)
        publisher.publish(BatteryStatus(brushes_up=True))
        keyboard = Keyboard(self, 'status')
        keyboard.wait_to_see('brushes up   ')  # not that of the help
        keyboard.type('b')
        keyboard.wait_to_see('brushes: a sock is in the way\r\n')
        self.assertEqual(asked, [False])
        self.assertNotIn('brushes down', keyboard.screen)

    def test_without_the_service_a_line_says_so_and_driving_continues(self):
        keyboard = Keyboard(self, 'alone', '_hold:=5')
        keyboard.type('b')
        keyboard.wait_to_see('brushes: service [/alone/rumba/set_brushes_up] unavailable\r\n')
        keyboard.type('i')
        keyboard.wait_to_hear(0.2, 0.0)

    def test_a_service_that_does_not_answer_delays_nothing(self):
        answer = threading.Event()
        self.addCleanup(answer.set)
        rospy.Service('/stuck/rumba/set_brushes_up', SetBool, lambda _: answer.wait() and SetBoolResponse())
        keyboard = Keyboard(self, 'stuck', '_hold:=5')
        keyboard.type('bi')
        keyboard.wait_to_hear(0.2, 0.0, times=5)
        keyboard.type('b')
        keyboard.wait_to_see('/stuck/rumba/set_brushes_up has not answered yet\r\n')
        keyboard.type('\x1b')
        self.assertEqual(keyboard.end(), 0)

    def test_the_help_is_shown_again(self):
        keyboard = Keyboard(self, 'help')
        for key in '?h':
            keyboard.type(key)
            keyboard.wait_to_see('Hold a key to drive /help/rumba/teleop/cmd_vel')
        self.assertEqual(keyboard.heard, [])

    def test_the_robot_stops_and_the_terminal_is_restored_at_every_kind_of_end(self):
        def send(number):
            return lambda keyboard: keyboard.process.send_signal(number)

        def kill(_):
            subprocess.check_call(['rosnode', 'kill', '/ended/teleop_key'], stdout=subprocess.DEVNULL)

        for name, leave in (
                ('Esc', lambda keyboard: keyboard.type('\x1b')), ('Ctrl-C', lambda keyboard: keyboard.type('\x03')),
                ('Ctrl-D', lambda keyboard: keyboard.type('\x04')), ('SIGINT', send(signal.SIGINT)),
                ('SIGTERM', send(signal.SIGTERM)), ('SIGHUP', send(signal.SIGHUP)), ('rosnode kill', kill)):
            keyboard = Keyboard(self, 'ended', '_hold:=5')
            self.assertIn(HIDE_CURSOR, keyboard.screen)
            self.assertNotEqual(keyboard.attributes(), keyboard.found)
            keyboard.type('i')
            keyboard.wait_to_hear(0.2, 0.0)
            leave(keyboard)
            self.assertEqual(keyboard.end(), 0)
            keyboard.wait_to_hear(0.0, 0.0)
            self.assertEqual(keyboard.heard[-1], (0.0, 0.0))
            self.assertEqual(keyboard.attributes(), keyboard.found)
            self.assertEqual(keyboard.screen.split('\x1b')[-1], SHOW_CURSOR[1:] + '\r\n')

    def test_while_it_is_suspended_the_robot_stands_and_the_shell_has_the_terminal(self):
        keyboard = Keyboard(self, 'suspended', '_hold:=5', shell='{}; echo suspended; read line; fg >/dev/null')
        keyboard.type('i')
        keyboard.wait_to_hear(0.2, 0.0)
        keyboard.type('\x1a')
        keyboard.wait_to_hear(0.0, 0.0)
        keyboard.wait_to_see('suspended\r\n')
        self.assertEqual(keyboard.attributes(), keyboard.found)
        keyboard.type('\n')
        keyboard.wait_to_see(READY)
        self.assertNotIn((0.2, 0.0), keyboard.heard)
        keyboard.type('j')
        keyboard.wait_to_hear(0.0, 1.0)
        keyboard.type('\x1b')
        self.assertEqual(keyboard.end(), 0)
        self.assertEqual(keyboard.attributes(), keyboard.found)

    def test_without_a_terminal_it_prints_one_line_and_ends_with_exit_code_2(self):
        ours, theirs = pty.openpty()
        for options, argument, message in (
                ({'stdin': subprocess.DEVNULL, 'stdout': theirs}, '_hold:=1', 'needs a terminal for its input and '),
                ({'stdin': theirs, 'stdout': subprocess.DEVNULL}, '_hold:=1', 'needs a terminal for its input and '),
                ({'stdin': theirs, 'stdout': theirs}, '_linear:=0.6', r'.*linear is 0\.6: must be 0\.02 to 0\.5 ')):
            done = subprocess.run([COMMAND, argument], stderr=subprocess.PIPE, universal_newlines=True,
                                  timeout=TIMEOUT, check=False, **options)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, rf'\Ateleop_key: {message}[^\n]*\n\Z')
        os.close(ours)
        os.close(theirs)


if __name__ == '__main__':
    rospy.init_node('test_teleop_key')
    rostest.rosrun('rumba_sim', 'teleop_key', TeleopKeyTest)
