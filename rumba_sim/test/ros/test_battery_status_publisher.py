#!/usr/bin/env python3
"""battery_status_publisher through a real master: content, latching, bad parameters, signals."""

import signal
import subprocess
import unittest

import programs
import rospy
import rostest
from rosgraph_msgs.msg import Clock

from rumba_msg.msg import BatteryStatus

TOPIC = 'rumba/battery_status'
TIMEOUT = 30.0


class BatteryStatusPublisherTest(unittest.TestCase):
    """The node of the launch file's namespace, and nodes that the test starts."""

    def start(self, namespace, *arguments):
        """Start the node in a separate namespace."""
        process = programs.start('rumba_sim', 'battery_status_publisher', f'__ns:=/{namespace}', *arguments,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def test_content(self):
        status = rospy.wait_for_message(TOPIC, BatteryStatus, TIMEOUT)
        self.assertEqual((status.location_x, status.location_y), (1.5, -2.5))
        self.assertAlmostEqual(status.orientation_theta, 7.0 - 2.0 * 3.141592653589793)
        self.assertTrue(status.brushes_up)
        self.assertEqual(status.percentage_battery, 80)
        self.assertEqual(status.debug_message, '15.8 V, 0.19 A, discharging')

    def percentage(self, namespace):
        """The next charge that the node of a namespace publishes [%]."""
        return rospy.wait_for_message(f'/{namespace}/{TOPIC}', BatteryStatus, TIMEOUT).percentage_battery

    def test_the_battery_drains_according_to_its_loads(self):
        """2.7 Ah at 0.19 A and a drain of 1000: 1 % in 0.51 s."""
        self.start('draining', '_percentage:=80', '_drain:=1000', '_rate:=50', '_brushes_up:=true')
        first = self.percentage('draining')
        begin = rospy.get_time()
        while self.percentage('draining') > first - 6:
            self.assertLess(rospy.get_time() - begin, TIMEOUT)
        self.assertAlmostEqual(rospy.get_time() - begin, 6 * 2.7 * 36.0 / (0.19 * 1000.0), delta=1.0)

    def test_the_battery_drains_to_zero_and_stays_there(self):
        self.start('emptied', '_percentage:=2', '_drain:=10000', '_rate:=50')
        begin = rospy.get_time()
        while self.percentage('emptied') > 0:
            self.assertLess(rospy.get_time() - begin, TIMEOUT)
        self.assertEqual([self.percentage('emptied') for _ in range(3)], [0, 0, 0])

    def test_a_clock_that_begins_at_any_time_does_not_empty_the_battery(self):
        for running in ('/plain', '/set'):  # they must not take the time from /clock
            rospy.wait_for_message(f'{running}/{TOPIC}', BatteryStatus, TIMEOUT)
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        self.start('begun', '_percentage:=90')
        clock = rospy.Publisher('/clock', Clock, queue_size=10)
        self.addCleanup(clock.unregister)
        heard = []
        subscriber = rospy.Subscriber(f'/begun/{TOPIC}', BatteryStatus, heard.append)
        self.addCleanup(subscriber.unregister)
        now, begin = 1.6e9, rospy.get_time()
        while len(heard) < 10:
            self.assertLess(rospy.get_time() - begin, TIMEOUT,
                            f'{len(heard)} messages; {clock.get_num_connections()} nodes listen to /clock')
            now += 0.05 if clock.get_num_connections() else 0.0
            clock.publish(rospy.Time.from_sec(now))
            rospy.sleep(0.01)
        self.assertEqual({status.percentage_battery for status in heard}, {90})

    def test_messages_are_new_and_not_latched(self):
        arrived = []
        subscriber = rospy.Subscriber(TOPIC, BatteryStatus, arrived.append)
        rospy.wait_for_message(TOPIC, BatteryStatus, TIMEOUT)
        while not arrived:
            rospy.sleep(0.01)
        self.assertEqual(arrived[0]._connection_header['latching'], '0')
        subscriber.unregister()

    def test_an_empty_battery_says_so(self):
        process = self.start('empty', '_percentage:=0')
        status = rospy.wait_for_message('/empty/' + TOPIC, BatteryStatus, TIMEOUT)
        self.assertEqual((status.percentage_battery, status.debug_message), (0, 'battery empty'))
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(TIMEOUT), 0)

    def test_bad_input_ends_the_node_with_one_line_and_exit_code_2_and_leaves_no_parameter(self):
        where = r'^battery_status_publisher: parameter of /refused/battery_status_publisher: '
        for argument, message in (
                ('_rate:=0', where + r'rate is 0\.0: must be 0\.01 to 1000 \[Hz\]\n$'),
                ('_percentage:=-1', where + r'percentage is -1\.0: must be 0 to 100 \[%\]\n$'),
                ('_brushes_up:=5', where + r'brushes_up is 5: must be true or false\n$'),
                ('_drian:=2', where + r"drian is unknown: did you mean 'drain'\?\n$"),
                ('_rate:=[', r"^battery_status_publisher: _rate:='\[': cannot be a parameter: [^\n]*\n$"),
                ('rate:=5', r'^battery_status_publisher: rate:= remaps a topic: for the parameter write _rate:=\n$'),
                ('5', r"^battery_status_publisher: unknown argument '5': .*\n$")):
            process = self.start('refused', argument)
            out, err = process.communicate(timeout=TIMEOUT)
            self.assertEqual((process.returncode, out), (2, ''), argument)
            self.assertRegex(err, message)
        self.assertEqual(rospy.get_param('/refused/battery_status_publisher', {}), {})

    def test_help_names_the_topic_and_every_parameter(self):
        out, _ = self.start('help', '--help').communicate(timeout=TIMEOUT)
        for word in ('rumba/battery_status', 'rate', 'percentage', 'drain', 'location_x', 'brushes_up', '[Hz]'):
            self.assertIn(word, out)


if __name__ == '__main__':
    rospy.init_node('test_battery_status_publisher')
    rostest.rosrun('rumba_sim', 'battery_status_publisher', BatteryStatusPublisherTest)
