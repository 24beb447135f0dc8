#!/usr/bin/env python3
"""The gateway passes messages in both directions, is never blocked, and ends cleanly."""

import json
import queue
import signal
import socket
import subprocess
import time
import unittest
import xmlrpc.client

import rosgraph
import rosnode
import rospy
import rostest

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0
STATUS = BatteryStatus(42, 1.5, -2.5, 0.75, True, 'from ROS')


class GatewayTest(unittest.TestCase):
    """Each test starts a gateway."""

    def setUp(self):
        self.gateway = subprocess.Popen(['rosrun', 'asyncio_node', 'gateway'], stdout=subprocess.PIPE,
                                        universal_newlines=True)
        self.addCleanup(self.forget_port)
        self.addCleanup(self.gateway.communicate)
        self.addCleanup(self.gateway.kill)
        self.port = int(self.gateway.stdout.readline().split()[-1])
        self.heard = queue.Queue()
        subscriber = rospy.Subscriber('rumba/battery_status', BatteryStatus, self.heard.put)
        self.addCleanup(subscriber.unregister)
        self.publisher = rospy.Publisher('rumba/battery_status', BatteryStatus, queue_size=10)
        self.addCleanup(self.publisher.unregister)
        self.wait(lambda: self.is_subscribed_to_the_gateway() and self.publisher.get_num_connections() == 2)
        self.client = self.connect()

    def is_subscribed_to_the_gateway(self):
        """Whether the gateway knows of the subscriber, and not only the other way round."""
        gateway = xmlrpc.client.ServerProxy(rosgraph.Master(rospy.get_name()).lookupNode('/gateway'))
        return any(direction == 'o' and destination == rospy.get_name()
                   for _, destination, direction, *_ in gateway.getBusInfo(rospy.get_name())[2])

    def forget_port(self):
        """Have the next gateway take a port of its own: one that was killed leaves its port, which may be taken now."""
        if rospy.has_param('/gateway/port'):
            rospy.delete_param('/gateway/port')

    def wait(self, condition):
        """Wait until a condition holds."""
        end = time.monotonic() + TIMEOUT
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def connect(self):
        """Return a client that has got an answer from the gateway."""
        connection = socket.create_connection(('localhost', self.port), TIMEOUT)
        self.addCleanup(connection.close)
        file = connection.makefile('rw')
        self.addCleanup(file.close)
        self.send('', file)
        self.assertIn('error', json.loads(file.readline()))
        return file

    def send(self, line, client=None):
        """Send a line from a client."""
        client = client or self.client
        client.write(line + '\n')
        client.flush()

    def test_a_message_reaches_every_client_as_json(self):
        second = self.connect()
        self.publisher.publish(STATUS)
        for client in (self.client, second):
            self.assertEqual(json.loads(client.readline()), {
                'percentage_battery': 42, 'location_x': 1.5, 'location_y': -2.5, 'orientation_theta': 0.75,
                'brushes_up': True, 'debug_message': 'from ROS'})

    def test_a_line_of_a_client_is_published(self):
        self.send('{"percentage_battery": 7, "location_y": 2, "debug_message": "from outside"}')
        self.assertEqual(self.heard.get(timeout=TIMEOUT), BatteryStatus(7, 0.0, 2, 0.0, False, 'from outside'))

    def test_a_bad_line_is_answered_with_an_error_and_the_next_line_is_published(self):
        for line, wrong in (('{"percentage": 7}', 'percentage is not an attribute of BatteryStatus'),
                            ('{"percentage_battery": "full"}', 'percentage_battery must be an integer'),
                            ('[1]', 'must be an object such as {"percentage_battery": 0}'),
                            ('no json', 'Expecting value')):
            self.send(line)
            self.assertIn(wrong, json.loads(self.client.readline())['error'])
        self.send('{"percentage_battery": 8}')
        self.assertEqual(self.heard.get(timeout=TIMEOUT).percentage_battery, 8)

    def test_a_subscriber_that_hangs_blocks_nothing(self):
        stuck = subprocess.Popen(['rostopic', 'echo', '/rumba/battery_status'], stdout=subprocess.DEVNULL)
        self.addCleanup(stuck.wait)
        self.addCleanup(stuck.kill)
        self.wait(lambda: self.publisher.get_num_connections() == 3)
        stuck.send_signal(signal.SIGSTOP)
        long = json.dumps({'debug_message': 50_000 * 'x'})
        for _ in range(400):  # 20 MB, more than the buffers of a connection can hold
            self.send(long)
        self.send('over')
        while 'error' not in json.loads(self.client.readline()):
            pass

    def ends(self):
        """Check that it ends with exit code 0, closes its client and deletes its parameter."""
        self.assertEqual(self.gateway.wait(TIMEOUT), 0)
        self.assertEqual(self.gateway.stdout.read().splitlines()[-1], 'gateway is closed')
        self.assertEqual(self.client.readline(), '')
        self.assertFalse(rospy.has_param('/gateway/port'))

    def test_ctrl_c_ends_loop_and_node(self):
        self.gateway.send_signal(signal.SIGINT)
        self.ends()

    def test_rosnode_kill_ends_loop_and_node(self):
        rosnode.kill_nodes(['/gateway'])
        self.ends()


if __name__ == '__main__':
    rospy.init_node('test_asyncio_node')
    rostest.rosrun('asyncio_node', 'asyncio_node', GatewayTest)
