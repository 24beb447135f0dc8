"""What the tests of robots that are not ours share: the fake robot, safe_drive, and the parameters that they need."""

import pathlib
import unittest

import programs
import rospy
from simulators import ENDS_WITHIN

HERE = pathlib.Path(__file__).resolve().parent
FILE = HERE / 'fake_robot.yaml'  # what it is like
TOPICS = {'rumba/scan': '/front/laser', 'rumba/odom': '/base/odometry', 'rumba/safe_cmd_vel': '/base/velocity'}
REMAPPED = [f'{ours}:={theirs}' for ours, theirs in TOPICS.items()]


class Fake:
    """A fake robot for one test."""

    def __init__(self, test, *arguments):
        rospy.set_param('/use_sim_time', True)
        if rospy.has_param('/fake_robot'):
            rospy.delete_param('/fake_robot')
        self.process = programs.start_script(HERE / 'fake_robot.py', *arguments)
        test.addCleanup(self.end)

    def end(self):
        """End it, as often as it is called."""
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait(ENDS_WITHIN)


class SafeDriveRun(unittest.TestCase):
    """A test that runs safe_drive, and is the robot itself."""

    def start(self, *arguments):
        """Start safe_drive."""
        rospy.set_param('/use_sim_time', True)
        if rospy.has_param('/safe_drive'):
            rospy.delete_param('/safe_drive')
        self.process = programs.start('rumba_cleaning', 'safe_drive', f'_own_robot:={FILE}', *arguments)
        self.addCleanup(self.end)

    def publisher(self, topic, kind):
        """A publisher until the end of the test."""
        publisher = rospy.Publisher(topic, kind, queue_size=10)
        self.addCleanup(publisher.unregister)
        return publisher

    def end(self):
        """End safe_drive."""
        self.process.terminate()
        self.process.wait(ENDS_WITHIN)
