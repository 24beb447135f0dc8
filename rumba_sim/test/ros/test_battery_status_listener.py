#!/usr/bin/env python3
"""battery_status_listener prints each message on a line into a pipe, and all on one live line in a terminal."""

import os
import pty
import signal
import subprocess
import unittest

import rospy
import rostest
from programs import executable

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0
MESSAGES = [BatteryStatus(97, 1.25, -2.0, 1.5707963, True, '\x1b[2Jone\n'),
            BatteryStatus(5, 0.0, 0.0, 0.0, False, 'two')]
LINES = ['battery  97 %   at (1.25, -2.00) m, 90 deg   brushes up   \\x1b[2Jone\\n',
         'battery   5 %   at (0.00, 0.00) m, 0 deg   brushes down   two']


class BatteryStatusListenerTest(unittest.TestCase):
    """Each test has a listener in a separate namespace."""

    def start(self, namespace, **options):
        """Start the node in a separate namespace."""
        command = [executable('rumba_sim', 'battery_status_listener'), f'__ns:=/{namespace}']
        process = subprocess.Popen(command, **options)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def publish(self, namespace):
        """Publish the messages as soon as there is a subscriber."""
        publisher = rospy.Publisher(f'/{namespace}/rumba/battery_status', BatteryStatus, queue_size=10)
        begin = rospy.get_time()
        while publisher.get_num_connections() == 0:
            self.assertLess(rospy.get_time() - begin, TIMEOUT)
            rospy.sleep(0.01)
        for message in MESSAGES:
            publisher.publish(message)

    def test_a_line_for_each_message_into_a_pipe(self):
        process = self.start('piped', stdout=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(process.stdout.readline(), 'waiting for /piped/rumba/battery_status\n')
        self.publish('piped')
        self.assertEqual([process.stdout.readline().rstrip('\n') for _ in LINES], LINES)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(TIMEOUT), 0)
        process.stdout.close()

    def test_one_live_line_on_a_terminal(self):
        ours, theirs = pty.openpty()
        process = self.start('shown', stdout=theirs, env={**os.environ, 'COLUMNS': '40'})
        os.close(theirs)
        self.publish('shown')
        wanted = '\r\x1b[K' + LINES[1][:39]
        shown = ''
        while not shown.endswith(wanted):
            shown += os.read(ours, 1000).decode()
        self.assertIn('\r\x1b[K' + LINES[0][:39], shown)
        self.assertNotIn('\n', shown)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(TIMEOUT), 0)
        os.close(ours)


if __name__ == '__main__':
    rospy.init_node('test_battery_status_listener')
    rostest.rosrun('rumba_sim', 'battery_status_listener', BatteryStatusListenerTest)
