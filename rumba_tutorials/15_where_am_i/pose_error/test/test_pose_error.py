#!/usr/bin/env python3
"""What the node prints is how far the poses are apart that it is told."""

import os
import queue
import subprocess
import threading
import unittest

import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point, Pose, PoseWithCovariance, PoseWithCovarianceStamped, Quaternion
from nav_msgs.msg import Odometry
from std_msgs.msg import Header

TIMEOUT = 60.0
SCRIPT = os.path.join(rospkg.RosPack().get_path('pose_error'), 'scripts', 'pose_error')


def at(x, y, stamp):
    """Header and pose of a robot that faces along x."""
    return Header(stamp=stamp), PoseWithCovariance(Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0)), [0.0] * 36)


class PoseErrorTest(unittest.TestCase):
    """A robot whose odometry began at (1, 2) m."""

    def test_the_distances_are_printed_every_ten_seconds(self):
        topics = {'ground_truth': Odometry, 'odom': Odometry, 'amcl_pose': PoseWithCovarianceStamped}
        publishers = {name: rospy.Publisher(f'rumba/{name}', kind, queue_size=10) for name, kind in topics.items()}
        node = subprocess.Popen([SCRIPT], stdout=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)
        lines = queue.Queue()
        threading.Thread(target=lambda: [lines.put(line) for line in node.stdout], daemon=True).start()
        while not all(publisher.get_num_connections() for publisher in publishers.values()):
            rospy.sleep(0.05)
        begin = rospy.Time(100)
        for seconds, counted, believed in ((0, (0.0, 0.0), (1.0, 2.0)), (5, (1.0, 0.0), (9.0, 9.0)),
                                           (10, (2.3, 0.4), (3.0, 2.12))):
            stamp = begin + rospy.Duration(seconds)
            poses = {'odom': counted, 'amcl_pose': believed, 'ground_truth': (1.0 + 0.2 * seconds, 2.0)}
            for name, (x, y) in poses.items():
                header, pose = at(x, y, stamp)
                publishers[name].publish(topics[name](header=header, pose=pose))
        self.assertEqual(lines.get(timeout=TIMEOUT), 'off by: odometry 0.000 m, localisation 0.000 m\n')
        self.assertEqual(lines.get(timeout=TIMEOUT), 'off by: odometry 0.500 m, localisation 0.120 m\n')


if __name__ == '__main__':
    rospy.init_node('test_pose_error')
    rostest.rosrun('pose_error', 'pose_error', PoseErrorTest)
