#!/usr/bin/env python3
"""Robots are spawned, killed, teleported and commanded, with valid and invalid input."""

import math
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Pose2D
from rosgraph_msgs.msg import Log
from simulators import ROOM, Commands, Heard, Simulator, folder_of, lookup, wait


def known_of(robot):
    """Topics and services of the simulator below a robot's name."""
    publishers, subscribers, services = rosgraph.Master('/test').getSystemState()
    return {name for kind in (publishers, subscribers, services) for name, nodes in kind
            if name.startswith(f'/{robot}/') and '/simulator' in nodes}


class SimulatorRobotsTest(unittest.TestCase):
    """A simulator for each test, on the empty field, whose walls are at 0 m and 11.09 m."""

    def test_robots_are_spawned_and_killed(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        everything = {name.replace('/rumba/', '/rumba2/') for name in known_of('rumba')}
        self.assertEqual(len(everything), 14)
        for _ in range(2):
            self.assertEqual(simulator.does('spawn', '', Pose2D(3.0, 2.0, 1.0)).name, 'rumba2')
            wait(self, lambda: known_of('rumba2') == everything, 'the topics and services')
            status = Heard(self, '/rumba2/battery_status').find()
            self.assertEqual((status.location_x, status.location_y, status.orientation_theta), (3.0, 2.0, 1.0))
            simulator.teleport(4.0, 2.5, -1.0, 'rumba2')
            simulator.does('rumba2/set_brushes_up', True)
            simulator.does('kill', 'rumba2')
            wait(self, lambda: not known_of('rumba2'), 'the end of the topics and services')
            self.assertIsNone(lookup('/rumba2/teleport'))
        self.assertEqual(simulator.does('spawn', 'eve_2', Pose2D(3.0, 2.0, 0.0)).name, 'eve_2')
        self.assertEqual(simulator.does('spawn', '', Pose2D(3.0, 3.0, 0.0)).name, 'rumba2')
        self.assertEqual(simulator.does('spawn', '', Pose2D(3.0, 4.0, 0.0)).name, 'rumba3')
        simulator.does('kill', 'rumba')
        simulator.refuses("^there is no robot 'rumba': robots are eve_2, rumba2, rumba3$", 'kill', 'rumba')
        self.assertEqual(simulator.does('spawn', '', Pose2D(5.0, 4.0, 0.0)).name, 'rumba')
        simulator.does('reset')
        Heard(self, '/rumba3/odom').find()

    def test_invalid_requests_are_refused_and_change_nothing(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10')
        here = Pose2D(3.0, 2.0, 0.0)
        simulator.refuses("^'rumba' is taken: robots are rumba$", 'spawn', 'rumba', here)
        for name in ('a b', '/x', 'x/y', '1x', '_x', 'ä', 'xä', 'x\n', '~x', '{x}', '-', 65 * 'x',
                     5_000_000 * 'x'):
            simulator.refuses('is not a valid name: must be 1 to 64 letters, digits and _, beginning with a letter$',
                              'spawn', name, here)
        simulator.refuses(r"^there is no robot 'x+\.\.\.x+': robots are rumba$", 'kill', 5_000_000 * 'x')
        places = (
            (Pose2D(0.1, 2.0, 0.0), r'pose at \(0\.10, 2\.00\) m is 0\.100 m from the nearest wall: a robot of '),
            (Pose2D(-3.0, 2.0, 0.0), r'pose at \(-3\.00, 2\.00\) m lies outside the map \(x -'),
            (Pose2D(1e300, 2.0, 0.0), 'lies outside the map'),
            (Pose2D(math.nan, 2.0, 0.0), r'^pose \(nan, 2\.0, 0\.0\): must be finite numbers$'),
            (Pose2D(3.0, 2.0, math.inf), r'^pose \(3\.0, 2\.0, inf\): must be finite numbers$'))
        for place, message in places:
            simulator.refuses(message, 'spawn', 'other', place)
            simulator.refuses(message, 'rumba/teleport', place)
        simulator.does('spawn', 'other', here)
        for place in (here, Pose2D(3.3, 2.0, 0.0)):
            simulator.refuses(r"^\(3\..0, 2\.00\) m: 'other' stands there$", 'rumba/teleport', place)
            simulator.refuses(r"^\(3\..0, 2\.00\) m: 'other' stands there$", 'spawn', 'third', place)
        for name in ('nobody', ''):
            simulator.refuses(f"^there is no robot '{name}': robots are rumba, other$", 'kill', name)
        self.assertEqual({name.split('/')[1] for name in map(str, known_of('other') | known_of('rumba'))},
                         {'rumba', 'other'})
        self.assertFalse(known_of('third'))
        truth = Heard(self, '/rumba/ground_truth').find()
        self.assertAlmostEqual(truth.pose.pose.position.x, 5.544444)

    def test_invalid_commands_are_ignored_and_valid_ones_followed(self):
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_rates/ground_truth:=50')
        log, truth, commands = Heard(self, '/rosout'), Heard(self, '/rumba/ground_truth'), Commands(self)
        commands.send(math.nan, 0.0)
        complaint = log.find(lambda message: (message.level, message.name) == (Log.ERROR, '/simulator'))
        for v, w in ((math.nan, 0.0), (0.1, math.inf), (-math.inf, math.nan)):
            commands.send(v, w)
            truth.fresh(lambda message: message.twist.twist.angular.z == 0.0)
            # The next command arrives after this one: only that one moves the robot.
            commands.send(0.0, 1.0)
            moving = truth.find(lambda message: message.twist.twist.angular.z > 0.5)
            self.assertAlmostEqual(moving.twist.twist.linear.x, 0.0, delta=1e-9)
            self.assertTrue(all(math.isfinite(message.pose.pose.position.x) for message in truth.messages))
        self.assertEqual(complaint.msg, 'rumba/cmd_vel: linear.x nan m/s, angular.z 0.0 rad/s: must be finite numbers; '
                                        'ignored')
        simulator.does('reset')
        for v, w, fastest in ((1e9, 0.0, (0.5, 0.0)), (-1e9, 0.0, (-0.5, 0.0)), (0.0, -1e9, (0.0, -1.9))):
            self.assert_drives_at(fastest, commands, v, w, truth)

    def assert_drives_at(self, fastest, commands, v, w, truth):
        """A command that is repeated leads to a velocity, and never exceeds the limits."""
        def is_there():
            commands.send(v, w)
            twist = truth.messages[-1].twist.twist
            return abs(twist.linear.x - fastest[0]) < 1e-9 and abs(twist.angular.z - fastest[1]) < 1e-9
        wait(self, is_there, f'{fastest}')
        for message in truth.messages:
            self.assertLessEqual(abs(message.twist.twist.linear.x), 0.5 + 1e-9)
            self.assertLessEqual(abs(message.twist.twist.angular.z), 1.9 + 1e-9)

    def test_a_wheel_over_a_cliff_is_reported_until_the_robot_is_teleported(self):
        room = {**ROOM, 'cliff.pgm': b'P5 40 40 255\n' + 40 * (24 * b'\xff' + 16 * b'\x00')}
        room['room.yaml'] += b'cliff: cliff.pgm\n'  # from x = 1.2 m on
        simulator = Simulator(self, '_map:=room.yaml', '_speed:=10', folder=folder_of(self, room))
        simulator.teleport(0.5, 1.0, 0.0)
        cliff, commands = Heard(self, '/rumba/cliff'), Commands(self)
        self.assertFalse(cliff.fresh().is_wheel_dropped)
        wait(self, lambda: commands.send(0.3, 0.0) or cliff.messages[-1].is_wheel_dropped, 'the fall')
        self.assertTrue(cliff.messages[-1].is_cliff_front_left)
        simulator.teleport(0.5, 1.0, 0.0)
        cliff.fresh(lambda message: not message.is_wheel_dropped)

    def test_a_thousand_commands_a_second_are_fine(self):
        Simulator(self, '_map:=field', '_speed:=1')
        truth, commands = Heard(self, '/rumba/ground_truth'), Commands(self)
        rate = rospy.Rate(1000)
        for number in range(2000):
            commands.send(0.0, 0.5 if number < 1999 else -0.5)
            rate.sleep()
        # The last one counts, and soon after it was sent.
        turned = truth.fresh(lambda message: message.twist.twist.angular.z < 0.0)
        self.assertLess((turned.header.stamp - rospy.Time.now()).to_sec(), 1.0)
        truth.fresh(lambda message: message.twist.twist.angular.z == 0.0)


if __name__ == '__main__':
    rospy.init_node('test_simulator_robots')
    rostest.rosrun('rumba_sim', 'simulator_robots', SimulatorRobotsTest)
