"""Commands come in threads of rospy, and the loop of the node takes them: none is lost in between."""

import threading
import types

import pytest
from geometry_msgs.msg import Twist

from rumba_sim.ros.robot import robot_node
from rumba_sim.ros.robot.robot_node import RobotNode


class Guarded(RobotNode):
    """A robot without topics, whose command may be touched only under its lock."""

    def __init__(self):
        self._mux, self._mux_lock = robot_node.VelocityMux(robot_node.INPUTS), threading.Lock()
        self._name, self._examiner, self._inputs = 'rumba', None, {'cmd_vel': '/rumba/cmd_vel'}
        self._report_command = lambda _: None
        self.commands = []
        robot = types.SimpleNamespace(command=lambda v, w, _: self.commands.append((v, w)))
        self._world = types.SimpleNamespace(robots={'rumba': robot}, tick=1)

    @property
    def _command(self):
        assert self._mux_lock.locked()
        return self.__dict__.get('command')

    @_command.setter
    def _command(self, command):
        assert self._mux_lock.locked()
        self.__dict__['command'] = command


@pytest.fixture
def node():
    """A robot that was commanded."""
    guarded, twist = Guarded(), Twist()
    twist.linear.x = 0.2
    guarded._on_command(twist, 'cmd_vel')
    return guarded


def test_a_command_is_taken_once_and_under_the_lock(node):
    node.apply_command()
    node.apply_command()
    assert node.commands == [(0.2, 0.0)]


def test_a_command_is_forgotten_under_the_lock(node):
    node.forget_command()
    node.apply_command()
    assert node.commands == []
