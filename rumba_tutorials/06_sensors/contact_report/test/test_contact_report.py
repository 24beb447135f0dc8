#!/usr/bin/env python3
"""A contact with a wall is reported once, with its speed and its side."""

import math
import queue
import re
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose2D, Twist, Vector3
from rosgraph_msgs.msg import Log

from contact_report.msg import ContactReport
from rumba_msg.msg import Bumper
from rumba_msg.srv import Teleport

TIMEOUT = 30.0
BEFORE_THE_WALL = Pose2D(0.5, 2.5, math.pi)  # 0.33 m between robot and wall, in the studio


class ContactReportTest(unittest.TestCase):
    """In the root namespace, a simulator runs; in the others, only this test publishes readings."""

    def listen(self, topic, kind):
        """Subscribe to a topic that has a publisher; return the queue of its messages."""
        heard = queue.Queue()
        subscriber = rospy.Subscriber(topic, kind, heard.put)
        self.addCleanup(subscriber.unregister)
        self.wait_for_connection(subscriber)
        return heard

    def publisher(self, topic, kind):
        """Return a publisher that has a subscriber."""
        publisher = rospy.Publisher(topic, kind, queue_size=10)
        self.addCleanup(publisher.unregister)
        self.wait_for_connection(publisher)
        return publisher

    def wait_for_connection(self, topic):
        end = rospy.get_time() + TIMEOUT
        while topic.get_num_connections() == 0:
            self.assertLess(rospy.get_time(), end, topic.resolved_name)
            rospy.sleep(0.01)

    def test_into_a_wall(self):
        reports = self.listen('contact_report', ContactReport)
        rospy.wait_for_service('rumba/teleport', TIMEOUT)
        self.assertTrue(rospy.ServiceProxy('rumba/teleport', Teleport)(BEFORE_THE_WALL).success)
        publisher = self.publisher('rumba/cmd_vel', Twist)
        end = rospy.get_time() + TIMEOUT
        while reports.empty():
            self.assertLess(rospy.get_time(), end, 'no contact')
            publisher.publish(Twist(linear=Vector3(x=0.25)))
            rospy.sleep(0.05)
        report = reports.get()
        self.assertEqual((report.count, report.side, report.header.frame_id), (1, 'front', 'base_link'))
        self.assertAlmostEqual(report.speed, 0.25, delta=0.05)

    def test_sides_and_going_on(self):
        reports = self.listen('/told/contact_report', ContactReport)
        publisher = self.publisher('/told/rumba/bumper', Bumper)
        for left, right in ((False, True), (True, True), (False, False), (True, False), (False, False), (True, True)):
            publisher.publish(is_left_pressed=left, is_right_pressed=right)
        heard = [reports.get(timeout=TIMEOUT) for _ in range(3)]
        self.assertEqual([(report.count, report.side) for report in heard], [(1, 'right'), (2, 'left'), (3, 'front')])
        self.assertTrue(all(math.isnan(report.speed) for report in heard))

    def test_what_is_printed(self):
        log = self.listen('/rosout', Log)
        publisher = self.publisher('/printed/rumba/bumper', Bumper)
        end = rospy.get_time() + TIMEOUT
        said = ''
        while not re.fullmatch(r'contact \d+: left, at nan m/s', said):
            self.assertLess(rospy.get_time(), end, said)
            publisher.publish(is_left_pressed=True)
            publisher.publish(is_left_pressed=False)
            rospy.sleep(0.05)
            while not log.empty():
                entry = log.get()
                said = entry.msg if entry.name == '/printed/contact' else said


if __name__ == '__main__':
    rospy.init_node('test_contact_report')
    rostest.rosrun('contact_report', 'contact_report', ContactReportTest)
