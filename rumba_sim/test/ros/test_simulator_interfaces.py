#!/usr/bin/env python3
"""Another robot's interface: each topic is as that robot has it, and nodes that were written for it run unchanged."""

import math
import pathlib
import subprocess
import sys
import unittest

import rosgraph
import rospy
import rostest
from create_msgs.msg import ChargingState, Mode, MotorSetpoint
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import LaserScan
from simulators import STEP_RATE, Commands, Heard, Simulator, folder_of, wait
from std_msgs.msg import Empty, UInt16
from tf2_msgs.msg import TFMessage

from rumba_sim.model.settings.interfaces import AT_SCAN, INTERFACES
from rumba_sim.ros.robot.interface_topics import message_class

NODES = pathlib.Path(__file__).resolve().parent / 'their_nodes'
SECONDS = 4  # of the world in which messages are counted
DRIVE = 120  # [s] of the world for which nodes of others drive
WIDTH, HEIGHT = 4.0, 3.0  # [m] of a room
ROOM = {
    'room.yaml': b'image: room.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n'
                 b'free_thresh: 0.196\n',
    'room.pgm': b'P5 80 60 255\n' + 80 * 60 * b'\xff'}
SCAN_RATES = {'turtlebot3': 5, 'plain': 10}  # [Hz] of the LDS-01, and of rates/scan


class SimulatorInterfacesTest(unittest.TestCase):
    """A simulator for each test."""

    def test_each_topic_of_a_turtlebot3_has_the_type_the_frame_and_the_rate_of_the_real_robot(self):
        self.check_topics('turtlebot3')

    def test_each_topic_of_a_create_has_the_type_the_frame_and_the_rate_of_the_real_robot(self):
        self.check_topics('create')

    def test_each_topic_of_a_plain_robot_has_the_type_the_frame_and_the_rate_that_is_documented(self):
        self.check_topics('plain')

    def check_topics(self, name):
        interface = INTERFACES[name]
        # In lockstep, who comes late is sent once more what it has missed.
        simulator = Simulator(self, '_map:=studio', '_speed:=10', '_lockstep:=false', f'_interface:={name}')
        simulator.pause()
        heard = {topic: Heard(self, f'/{topic.name}', rospy.AnyMsg) for topic in interface.topics}
        for _ in range(2 * SECONDS):  # publishers keep no more messages than those of some seconds
            simulator.step(STEP_RATE // 2)
        for topic, messages in heard.items():
            rate = SCAN_RATES[name] if topic.rate == AT_SCAN else min(topic.rate, STEP_RATE)
            wanted = 0 if topic.name == 'wheeldrop' else rate * SECONDS  # which is only told after a fall
            if wanted:
                wait(self, lambda: len(messages.messages) >= wanted, f'{wanted} messages of {topic.name}')
            self.assertEqual(len(messages.messages), wanted, topic)
            for message in messages.messages[-1:]:
                kind = message_class(topic.type, name)
                self.assertEqual(message._connection_header['type'], topic.type)
                self.assertEqual(message._connection_header['md5sum'], kind._md5sum)
                header = getattr(kind().deserialize(message._buff), 'header', None)
                self.assertEqual(header.frame_id if header else '', topic.frame, topic)
        simulator.end()

    def test_another_robot_has_its_topics_below_its_name_and_obeys_its_own_commands(self):
        simulator = Simulator(self, '_map:=studio', '_speed:=10', '_interface:=turtlebot3', '_robots:=2')
        static = Heard(self, '/tf_static', TFMessage)
        static.find(lambda message: {'base_scan', 'imu_link', 'rumba2/base_scan', 'rumba2/imu_link'} <= {
            part.child_frame_id for part in message.transforms})
        scan = Heard(self, '/rumba2/turtlebot3/scan', LaserScan)
        self.assertEqual(scan.find().header.frame_id, 'rumba2/base_scan')
        mine, other = (Heard(self, f'/{below}odom', Odometry) for below in ('', 'rumba2/turtlebot3/'))
        simulator.teleport(1.5, 2.4, 0.0, 'rumba2')
        moved = rospy.Publisher('/rumba2/turtlebot3/cmd_vel', Twist, queue_size=1)
        self.addCleanup(moved.unregister)
        wait(self, moved.get_num_connections, 'the robot to listen')
        wait(self, lambda: moved.publish(twist(0.1)) or other.messages[-1].twist.twist.linear.x > 0.05)
        self.assertEqual(mine.messages[-1].twist.twist.linear.x, 0.0)
        self.assertEqual((other.messages[-1].header.frame_id, other.messages[-1].child_frame_id),
                         ('rumba2/odom', 'rumba2/base_footprint'))
        simulator.does('kill', 'rumba2')
        wait(self, lambda: not any(name.startswith('/rumba2/') and '/simulator' in nodes
                                   for kind in rosgraph.Master('/test').getSystemState() for name, nodes in kind),
             'the end of its topics')
        simulator.does('spawn', 'rumba2', Pose2D(1.5, 2.4, 0.0))
        scan.fresh()
        simulator.end()

    def test_a_person_overrides_the_commands_of_an_interface(self):
        Simulator(self, '_map:=studio', '_speed:=10', '_interface:=plain', '_lockstep:=false')
        person, program = Commands(self, topic='teleop/cmd_vel'), self.publisher('cmd_vel', Twist)
        truth = Heard(self, '/rumba/ground_truth')

        def turns():
            person.send(0.0, 0.5)
            program.publish(twist(0.0, -0.5))
            return truth.messages and truth.messages[-1].twist.twist.angular.z > 0.4
        wait(self, turns, 'the person to turn the robot', 0.05)

    def test_a_create_seeks_its_dock_alone_and_its_brushes_and_mode_are_commanded(self):
        simulator = Simulator(self, '_map:=studio', '_speed:=20', '_interface:=create', '_lockstep:=false')
        simulator.teleport(1.5, 2.4, 0.0)
        mode, log = Heard(self, '/mode', Mode), Heard(self, '/rosout', Log, waits=False)
        status, docked = Heard(self, '/rumba/battery_status'), Heard(self, '/rumba/dock_status')
        state, beams = Heard(self, '/battery/charging_state', ChargingState), Heard(self, '/ir_omni', UInt16)
        self.assertEqual(mode.fresh().mode, Mode.MODE_FULL)
        self.assertEqual(state.fresh().state, ChargingState.CHARGE_NONE)
        commands = {topic: self.publisher(topic, kind) for topic, kind in {
            'dock': Empty, 'undock': Empty, 'main_brush_motor': MotorSetpoint, 'cmd_vel': Twist}.items()}
        commands['main_brush_motor'].publish(0.0)
        status.find(lambda message: message.brushes_up)
        commands['main_brush_motor'].publish(-0.5)
        status.fresh(lambda message: not message.brushes_up)
        commands['main_brush_motor'].publish(1.5)
        log.find(lambda message: message.msg == 'main_brush_motor: duty_cycle is 1.5: must be -1 to 1; ignored')
        commands['dock'].publish()
        mode.find(lambda message: message.mode == Mode.MODE_PASSIVE)
        # Nobody can hinder it any more.
        wait(self, lambda: commands['cmd_vel'].publish(twist(-0.3)) or docked.messages[-1].is_docked, 'the dock', 0.05)
        state.fresh(lambda message: message.state != ChargingState.CHARGE_NONE)
        self.assertIn(beams.fresh().data, (165, 169, 173))  # the force field, and one or both of the buoys
        self.assertEqual(mode.fresh().mode, Mode.MODE_PASSIVE)
        commands['undock'].publish()
        mode.fresh(lambda message: message.mode == Mode.MODE_FULL)
        wait(self, lambda: commands['cmd_vel'].publish(twist(-0.3)) or not docked.messages[-1].is_docked, 'to leave',
             0.05)

    def publisher(self, topic, kind):
        """A publisher to which the simulator listens."""
        publisher = rospy.Publisher(f'/{topic}', kind, queue_size=10)
        self.addCleanup(publisher.unregister)
        wait(self, publisher.get_num_connections, f'somebody who listens to {topic}')
        return publisher

    # --- nodes of others ------------------------------------------------------------------------------------------

    def run_node(self, node, interface, rate):
        """Where a node drives the robot in an empty room, in lockstep: its poses, ten each second, and its bumps."""
        path = folder_of(self, ROOM) / 'room.yaml'
        simulator = Simulator(self, f'_map:={path}', '_speed:=0', f'_interface:={interface}', '_wait_for:=/cmd_vel',
                              f'_rates/sensors:={rate}')
        simulator.teleport(1.5, 1.5, 0.0)
        truth, bumper = Heard(self, '/rumba/ground_truth'), Heard(self, '/rumba/bumper')
        # It complains if it ends in the middle of a command.
        process = subprocess.Popen([sys.executable, str(NODES / node)], stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        for count in range(DRIVE, 10 * DRIVE + 1, DRIVE):  # a busy machine may take minutes
            wait(self, lambda count=count: len(truth.messages) > count, f'{node} to drive', 0.05)
        process.terminate()
        process.wait(60.0)
        simulator.kill()
        pressed = [message.is_left_pressed or message.is_right_pressed for message in bumper.messages]
        bumps = sum(now and not before for before, now in zip([False, *pressed], pressed))
        return [message.pose.pose.position for message in truth.messages[:10 * DRIVE]], bumps

    def follow(self, interface, rate, nearest):
        """Have a wall follower follow all walls of the room, within a distance [m] of them; returns its bumps."""
        poses, bumps = self.run_node(f'{interface}_follow', interface, rate)
        gaps = [min(distances(pose)) for pose in poses[len(poses) // 4:]]  # it has to find a wall first
        self.assertGreater(sum(gap < nearest for gap in gaps) / len(gaps), 0.95)
        self.assertEqual(walls_met(poses, nearest), 4)
        return bumps

    def test_a_wall_follower_for_a_turtlebot3_follows_the_walls(self):
        self.assertEqual(self.follow('turtlebot3', 5, 0.7), 0)

    def test_a_wall_follower_for_a_create_follows_the_walls(self):
        self.follow('create', 10, 0.4)

    def test_a_wall_follower_for_a_plain_robot_follows_the_walls(self):
        self.assertEqual(self.follow('plain', 10, 0.95), 0)

    def bounce(self, interface, rate, nearest):
        """Have a bouncing node cross the room, from within a distance of the walls [m]; returns its bumps."""
        poses, bumps = self.run_node(f'{interface}_bounce', interface, rate)
        self.assertGreaterEqual(walls_met(poses, nearest), 3)
        self.assertGreater(length(poses), 8.0)
        return bumps

    def test_a_bouncing_node_for_a_turtlebot3_crosses_the_room(self):
        self.assertEqual(self.bounce('turtlebot3', 5, 0.8), 0)

    def test_a_bouncing_node_for_a_create_crosses_the_room(self):
        self.assertGreater(self.bounce('create', 10, 0.25), 2)

    def test_a_bouncing_node_for_a_plain_robot_crosses_the_room(self):
        self.assertEqual(self.bounce('plain', 10, 1.0), 0)


def twist(v, w=0.0):
    """A velocity [m/s], [rad/s]."""
    message = Twist()
    message.linear.x, message.angular.z = v, w
    return message


def distances(point):
    """Distances of a point in the room from its four walls [m]."""
    return point.x, WIDTH - point.x, point.y, HEIGHT - point.y


def walls_met(points, near):
    """How many of the walls come as near as that to one of the points [m]."""
    return sum(min(distances(point)[wall] for point in points) < near for wall in range(4))


def length(points):
    """Length of the way along points [m]."""
    return sum(math.hypot(a.x - b.x, a.y - b.y) for a, b in zip(points, points[1:]))


if __name__ == '__main__':
    rospy.init_node('test_simulator_interfaces')
    rostest.rosrun('rumba_sim', 'simulator_interfaces', SimulatorInterfacesTest)
