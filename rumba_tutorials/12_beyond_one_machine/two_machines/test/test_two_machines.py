#!/usr/bin/env python3
"""Nodes at two addresses find each other by the addresses that they announce."""

import time
import unittest
import xmlrpc.client
from urllib.parse import urlparse

import rosgraph
import rospy
import rostest

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0
ADDRESSES = {'/battery_status_publisher': '127.0.0.2', '/battery_status_listener': '127.0.0.3'}


class TwoMachinesTest(unittest.TestCase):
    """Two addresses of one machine represent two machines."""

    def uri(self, node):
        """Wait for a node; return its URI."""
        def look_up():
            try:
                return rosgraph.Master(rospy.get_name()).lookupNode(node)
            except rosgraph.MasterError:
                return None
        return self.wait(look_up, node)

    def wait(self, condition, what):
        """Wait until a condition holds; return its value."""
        end = time.monotonic() + TIMEOUT
        while True:
            result = condition()
            if result:
                return result
            self.assertLess(time.monotonic(), end, f'{what} did not come')
            time.sleep(0.05)

    def test_each_node_is_registered_at_its_address(self):
        for node, address in ADDRESSES.items():
            self.assertEqual(urlparse(self.uri(node)).hostname, address)

    def test_they_are_connected_across_the_addresses(self):
        publisher = xmlrpc.client.ServerProxy(self.uri('/battery_status_publisher'))
        self.wait(lambda: [connection for connection in publisher.getBusInfo(rospy.get_name())[2]
                           if '/battery_status_listener' in connection and '/rumba/battery_status' in connection],
                  'a connection of the listener')

    def test_a_message_comes_from_the_other_address(self):
        self.assertEqual(rospy.wait_for_message('rumba/battery_status', BatteryStatus, TIMEOUT).percentage_battery, 42)


if __name__ == '__main__':
    rospy.init_node('test_two_machines')
    rostest.rosrun('two_machines', 'two_machines', TwoMachinesTest)
