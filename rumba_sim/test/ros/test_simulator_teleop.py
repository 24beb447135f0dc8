#!/usr/bin/env python3
"""Who drives a robot: the commands of a person override those of a program, and for 0.5 s after the last one."""

import math
import time
import unittest

import rospy
import rostest
from simulators import Commands, Heard, Simulator, wait

from rumba_sim.ros.common import teleop

LEFT, RIGHT = 1.0, -1.0  # [rad/s]


class SimulatorTeleopTest(unittest.TestCase):
    """A robot in real time, a person who turns it to the left, and a program that turns it to the right."""

    def setUp(self):
        Simulator(self, '_map:=field', '_rates/ground_truth:=50')
        self.log, self.truth = Heard(self, '/rosout'), Heard(self, '/rumba/ground_truth')
        self.truth.find()
        self.person, self.program = Commands(self, topic=teleop.TOPIC), Commands(self)

    def turn_rates(self):
        """How fast the robot has turned [rad/s] since the list of messages was cleared."""
        return [message.twist.twist.angular.z for message in self.truth.messages[:]]

    def turns(self, rate, *commands):
        """Send pairs of a publisher and a turn rate, until the robot turns at a rate."""
        def is_there():
            for publisher, command in commands:
                publisher.send(0.0, command)
            return self.turn_rates() and abs(self.turn_rates()[-1] - rate) < 1e-9
        wait(self, is_there, f'{rate} rad/s')

    def test_a_person_overrides_a_program_and_half_a_second_later_the_program_drives_again(self):
        self.turns(RIGHT, (self.program, RIGHT))
        self.turns(LEFT, (self.person, LEFT), (self.program, RIGHT))
        self.truth.messages.clear()

        def have_both_sent():
            self.person.send(0.0, LEFT)
            self.program.send(0.0, RIGHT)
            return len(self.truth.messages) >= 50
        wait(self, have_both_sent)
        self.assertEqual({round(rate, 9) for rate in self.turn_rates()}, {LEFT})
        last = time.monotonic()
        self.person.send(0.0, LEFT)
        self.truth.messages.clear()

        def turns_right():
            self.program.send(0.0, RIGHT)
            return any(rate < 0.0 for rate in self.turn_rates())
        wait(self, turns_right, 'the program to drive again')
        self.assertGreaterEqual(time.monotonic() - last, teleop.TIMEOUT)

    def test_numbers_that_are_no_command_override_nothing(self):
        self.person.send(math.nan, 0.0)
        self.log.find(lambda message: message.msg == (
            'rumba/teleop/cmd_vel: linear.x nan m/s, angular.z 0.0 rad/s: must be finite numbers; ignored'))
        self.turns(RIGHT, (self.person, math.inf), (self.program, RIGHT))
        self.turns(LEFT, (self.person, LEFT))


if __name__ == '__main__':
    rospy.init_node('test_simulator_teleop')
    rostest.rosrun('rumba_sim', 'simulator_teleop', SimulatorTeleopTest)
