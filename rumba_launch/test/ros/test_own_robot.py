"""own_robot.launch has a robot clean that shares no code with Rumba: it judges by itself what was swept."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import roslib.packages
import rospy
from std_msgs.msg import Float32
from tiers import thorough

from rumba_msg.msg import MissionStatus

FAKE = pathlib.Path(roslib.packages.get_pkg_dir('rumba_cleaning')) / 'test' / 'ros'
ARGUMENTS = (f'robot:={FAKE / "fake_robot.yaml"}', 'scan:=/front/laser', 'odom:=/base/odometry',
             'cmd_vel:=/base/velocity')
LIMIT = 3600.0  # [s] of the robot's time for a mission
WALL_LIMIT = 550.0  # [s] of the wall clock


class OwnRobotTest(unittest.TestCase):
    """One mission after another."""

    def _start(self, *command):
        process = subprocess.Popen(command, env={**os.environ, 'ROS_HOSTNAME': 'localhost'})

        def end():
            process.terminate()
            process.wait(60.0)
        self.addCleanup(end)

    def _swept(self, room, *arguments, **parameters):
        """What share a mission sweeps, by the judgement of the fake robot, and what the cleaner says at its end."""
        statuses, shares = [], []
        for topic, kind, heard in (('/rumba/mission_status', MissionStatus, statuses), ('/coverage', Float32, shares)):
            self.addCleanup(rospy.Subscriber(topic, kind, heard.append).unregister)
        self._start(sys.executable, str(FAKE / 'fake_robot.py'), f'_room:={room}', '_wait_for_correction:=true',
                    *(f'_{name}:={value}' for name, value in parameters.items()))
        self._start('roslaunch', 'rumba_launch', 'own_robot.launch', *ARGUMENTS, *arguments)
        for _ in range(int(WALL_LIMIT / 0.1)):
            rospy.rostime.wallsleep(0.1)
            has_begun = any(status.state == MissionStatus.CLEANING for status in statuses)
            if has_begun and statuses[-1].state == MissionStatus.IDLE or rospy.get_time() > LIMIT:
                break
        self.assertTrue(shares and statuses, 'nothing was heard')
        return shares[-1].data, statuses[-1].message

    def test_it_maps_and_cleans_a_chamber_from_nothing(self):
        share, message = self._swept('chamber')
        self.assertGreaterEqual(share, 0.95, message)
        self.assertRegex(message, '9[5-9].* % swept')

    @thorough
    def test_it_maps_and_cleans_a_furnished_room_from_nothing(self):
        share, message = self._swept('furnished')
        self.assertGreaterEqual(share, 0.95, message)

    @thorough
    def test_it_finds_itself_on_a_map_and_cleans_a_furnished_room(self):
        sys.path.append(str(FAKE))
        import fake_robot
        with tempfile.TemporaryDirectory() as folder:
            fake_robot.draw(fake_robot.ROOMS['furnished'], f'{folder}/room')
            share, message = self._swept('furnished', f'map:={folder}/room.yaml')
        self.assertGreaterEqual(share, 0.97, message)
