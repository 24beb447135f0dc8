#!/usr/bin/env python3
"""Parameters first have the values of the launch file, then those that a client sets."""

import queue
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from sensor_msgs.msg import BatteryState

TIMEOUT = 30.0


class BatteryTest(unittest.TestCase):
    """One battery and one client for all tests."""

    @classmethod
    def setUpClass(cls):
        cls.client = Client('battery', timeout=TIMEOUT)
        cls.began_with = cls.client.get_configuration(TIMEOUT)

    def readings(self, count):
        """Return consecutive messages; the first is made after this call."""
        messages = queue.Queue()
        begin = rospy.Time.now()
        subscriber = rospy.Subscriber('battery_state', BatteryState, messages.put)
        self.addCleanup(subscriber.unregister)
        # The message that ends the loop is dropped too: the node may have computed it before this call.
        while messages.get(timeout=TIMEOUT).header.stamp < begin:
            pass
        return [messages.get(timeout=TIMEOUT) for _ in range(count)]

    def reading(self):
        """Return the next message."""
        return self.readings(1)[0]

    def turn(self, **parameters):
        """Change parameters; return the values in use."""
        return self.client.update_configuration(parameters)

    def test_the_launch_file_and_the_defaults_come_first(self):
        self.assertTrue(self.began_with['brushes_up'])
        self.assertEqual(self.began_with['load'], 0.19)

    def test_current_and_voltage_follow_the_load(self):
        self.turn(load=0.5, brushes_up=True)
        low = self.reading()
        self.turn(load=2.5)
        high = self.reading()
        self.assertAlmostEqual(low.current, -0.5, places=5)
        self.assertAlmostEqual(high.current, -2.5, places=5)
        self.assertAlmostEqual(low.voltage - high.voltage, 2.0 * 0.25, delta=0.02)  # the inner resistance: 0.25 Ohm

    def test_brushes_draw_half_an_ampere_while_they_are_down(self):
        self.turn(load=1.0, brushes_up=False)
        self.assertAlmostEqual(self.reading().current, -1.5, places=5)
        self.turn(brushes_up=True)
        self.assertAlmostEqual(self.reading().current, -1.0, places=5)

    def test_a_value_out_of_range_becomes_the_limit_and_the_client_gets_it_back(self):
        self.assertEqual(self.turn(load=99.0, brushes_up=True)['load'], 5.0)
        self.assertAlmostEqual(self.reading().current, -5.0, places=5)

    def test_the_rate_changes_while_it_runs(self):
        self.turn(rate=2.0)
        self.assertGreater(self.shortest_period(4), 0.45)
        self.turn(rate=50.0)
        self.assertLess(self.shortest_period(20), 0.1)

    def shortest_period(self, count):
        """Return the shortest time between two consecutive messages [s]."""
        stamps = [message.header.stamp.to_sec() for message in self.readings(count)]
        return min(after - before for before, after in zip(stamps, stamps[1:]))


if __name__ == '__main__':
    rospy.init_node('test_live_parameters')
    rostest.rosrun('live_parameters', 'live_parameters', BatteryTest)
