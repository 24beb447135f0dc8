#!/usr/bin/env python3
"""The sender publishes the laser and the battery of the simulator, and the receiver prints them."""

import re
import subprocess
import unittest

import rospy
import rostest
from sensor_msgs.msg import BatteryState, LaserScan

from lists_and_bytes.msg import IntList, Packet
from lists_and_bytes.packets import decode

TIMEOUT = 30.0


class ListsAndBytesTest(unittest.TestCase):
    """A docked Rumba in the studio: its readings change only by noise."""

    def test_distances_are_the_ranges_of_the_laser_in_order(self):
        distances = rospy.wait_for_message('rumba/distances', IntList, TIMEOUT).data
        ranges = rospy.wait_for_message('rumba/scan', LaserScan, TIMEOUT).ranges
        self.assertEqual(len(distances), 360)
        for millimetres, metres in zip(distances, ranges):
            self.assertAlmostEqual(millimetres / 1000, metres, delta=0.2)

    def test_the_packet_is_the_battery(self):
        battery = decode(rospy.wait_for_message('rumba/packet', Packet, TIMEOUT).payload)
        state = rospy.wait_for_message('rumba/battery_state', BatteryState, TIMEOUT)
        self.assertAlmostEqual(battery.voltage, state.voltage, delta=0.05)
        self.assertAlmostEqual(battery.capacity, state.capacity, delta=0.001)

    def test_the_receiver_prints_both(self):
        lines = subprocess.check_output(['rosrun', 'lists_and_bytes', 'receiver'], timeout=TIMEOUT,
                                        universal_newlines=True).splitlines()
        patterns = ['int32.. is a tuple of 360', 'int32.. with numpy_msg is a ndarray of int32, writeable: False',
                    r'the nearest thing is \d+ mm away', r'uint8.. is bytes of 10, the last of them: \d+',
                    r'Battery\(charging_state=0, voltage=1\d\.\d+, .*capacity=2\.7\)']
        self.assertEqual(len(lines), len(patterns))
        for line, pattern in zip(lines, patterns):
            self.assertTrue(re.fullmatch(pattern, line), line)


if __name__ == '__main__':
    rospy.init_node('test_lists_and_bytes')
    rostest.rosrun('lists_and_bytes', 'lists_and_bytes', ListsAndBytesTest)
