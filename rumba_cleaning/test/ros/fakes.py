"""What the tests of robots that are not ours share: the fake robot, and the master's parameters that it needs."""

import pathlib

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
