"""What the tests of robots that are not ours share: a fake robot and a launch file, and what is heard of both."""

import os
import pathlib
import subprocess
import sys
import unittest

import roslib.packages
import rospy
from std_msgs.msg import Float32

from rumba_msg.msg import MissionStatus

FAKES = pathlib.Path(roslib.packages.get_pkg_dir('rumba_cleaning')) / 'test' / 'ros'
LIMIT = 3600.0  # [s] of the robot's time for a mission
WALL_LIMIT = 550.0  # [s] of the wall clock


class ForeignRobotTest(unittest.TestCase):
    """One mission after another."""

    def setUp(self):
        self.statuses, self.shares = [], []
        self.hear('/rumba/mission_status', MissionStatus, self.statuses.append)
        self.hear('/coverage', Float32, self.shares.append)

    def hear(self, topic, kind, take):
        """Have a function take the messages of a topic."""
        self.addCleanup(rospy.Subscriber(topic, kind, take).unregister)

    def start(self, fake, launch, *arguments, **parameters):
        """Start a fake robot with parameters, and a launch file for it with arguments."""
        if rospy.has_param(f'/{fake}'):
            rospy.delete_param(f'/{fake}')
        self._run(sys.executable, str(FAKES / f'{fake}.py'), '_wait_for_correction:=true',
                  *(f'_{name}:={value}' for name, value in parameters.items()))
        self._run('roslaunch', 'rumba_launch', launch, *arguments)

    def _run(self, *command):
        process = subprocess.Popen(command, env={**os.environ, 'ROS_HOSTNAME': 'localhost'})

        def end():
            process.terminate()
            process.wait(60.0)
        self.addCleanup(end)

    def wait_for_end(self):
        """Wait until the mission has ended; what share it swept, by the fake's judgement, and what the cleaner says."""
        for _ in range(int(WALL_LIMIT / 0.1)):
            rospy.rostime.wallsleep(0.1)
            has_begun = any(status.state == MissionStatus.CLEANING for status in self.statuses)
            if has_begun and self.statuses[-1].state in (MissionStatus.IDLE, MissionStatus.STRANDED) or (
                    rospy.get_time() > LIMIT):
                break
        self.assertTrue(self.shares and self.statuses, 'nothing was heard')
        return self.shares[-1].data, self.statuses[-1].message
