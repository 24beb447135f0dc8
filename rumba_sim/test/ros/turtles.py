"""What the tests of turtlesim_body share: turtlesim and the node, started as by a user, and the messages of both.

turtlesim is the stand-in of this repository, or the original, if the system has it. The original needs Qt, knows no
other speed than 1, and dies of SIGINT.
"""

import importlib.util
import os
import signal

import programs
import rospy
from simulators import TIMEOUT, Commands, Heard, wait, wait_for_service
from std_srvs.srv import Empty

from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, Spawn, TeleportAbsolute

IS_STAND_IN = importlib.util.find_spec('turtlesim.ros') is not None  # the original has no nodes in Python
SPEED = 5 if IS_STAND_IN else 1  # times real time
SERVICES = {'reset': Empty, 'kill': Kill, 'spawn': Spawn, 'turtle1/teleport_absolute': TeleportAbsolute}


class Process:
    """A node that runs until the end of a test."""

    def __init__(self, test, service, package, node, *arguments, endings=(0,), **environment):
        self._test = test
        self._endings = endings
        self.process = programs.start(package, node, *arguments, env={**os.environ, **environment})
        test.addCleanup(self.end)
        wait_for_service(test, service, self.process)

    def end(self, number=signal.SIGINT):
        """End it; it must end with one of the exit codes that are expected."""
        if self.process.returncode is None:
            self.process.send_signal(number)
            try:
                self._test.assertIn(self.process.wait(TIMEOUT), self._endings)
            finally:
                self.process.kill()
                self.process.wait()


def turtlesim(test, speed=SPEED):
    """Start a turtlesim without a window; at a speed other than 1, it publishes the clock."""
    node = '/turtle1/set_pen', 'turtlesim', 'turtlesim_node'
    if IS_STAND_IN:
        return Process(test, *node, '_gui:=false', f'_speed:={speed}')
    return Process(test, *node, endings=(0, -signal.SIGINT), QT_QPA_PLATFORM='offscreen')


def body(test, *arguments):
    """Start turtlesim_body; parameters of an earlier one are deleted."""
    if rospy.has_param('/turtlesim_body'):
        rospy.delete_param('/turtlesim_body')
    return Process(test, '/turtlesim_body/reset', 'rumba_sim', 'turtlesim_body', *arguments)


def ask(service, *arguments):
    """Call a service of turtlesim."""
    return rospy.ServiceProxy(f'/{service}', SERVICES[service])(*arguments)


class Turtle:
    """The messages of turtle1, and of the robot whose body it is."""

    def __init__(self, test):
        self._test = test
        self.poses = Heard(test, '/turtle1/pose', Pose)
        self.colours = Heard(test, '/turtle1/color_sensor', Color)
        self.truth = Heard(test, '/rumba/ground_truth')
        self.odometry = Heard(test, '/rumba/odom')
        self.commands = Commands(test)

    def drive(self, v, w, until):
        """Command the robot until a condition of the turtle's newest pose holds; returns that pose."""
        def holds():
            self.commands.send(v, w)
            return self.poses.messages and until(self.poses.messages[-1]) and self.poses.messages[-1]
        self.poses.messages.clear()
        found = wait(self._test, holds, 'the turtle')
        self.commands.send(0.0, 0.0)
        self.poses.fresh(lambda pose: pose.linear_velocity == pose.angular_velocity == 0.0)
        return found

    def goes(self, way, v=0.3):
        """Drive a distance straight ahead [m], measured by the poses of the turtle."""
        begin = self.poses.fresh()
        self.drive(v, 0.0, lambda pose: (pose.x - begin.x) ** 2 + (pose.y - begin.y) ** 2 >= way ** 2)

    def robot_is_at(self, x, y):
        """Wait until the robot is at a position."""
        return self.truth.fresh(lambda odometry: abs(odometry.pose.pose.position.x - x) < 0.01
                                and abs(odometry.pose.pose.position.y - y) < 0.01)

    def believed(self):
        """The pose by odometry: x, y, and z of the quaternion."""
        pose = self.odometry.fresh().pose.pose
        return pose.position.x, pose.position.y, pose.orientation.z
