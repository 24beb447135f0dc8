#!/usr/bin/env python3
"""Obstacles come from a file and by services, are bumped into and seen, and are told to those who want to see them."""

import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose2D
from simulators import ROOM, Commands, Heard, Simulator, folder_of, wait
from visualization_msgs.msg import Marker, MarkerArray

from rumba_msg.srv import AddObstacleRequest
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation import obstacle_file
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.participants.maps import map_path

RADIUS = RobotConfig().drive.radius
THINGS = b"""
leg: {pose: [3.0, 2.0], radius: 0.05, height: 0.4}
book: {pose: [5.0, 3.0, 0.5], size: [0.3, 0.2], height: 0.03}
cat: {waypoints: [[4.0, 5.0], [6.0, 5.0]], speed: 0.5, radius: 0.1, height: 0.3}
"""


def disc(name, x, y, radius=0.1, height=0.4, **more):
    """The request for a disc."""
    return AddObstacleRequest(name=name, pose=Pose2D(x, y, 0.0), radius=radius, height=height, **more)


class SimulatorObstaclesTest(unittest.TestCase):
    """A simulator for each test, on the empty field, whose walls are at 0 m and 11.09 m."""

    def setUp(self):
        self.path = folder_of(self, {'things.yaml': THINGS}) / 'things.yaml'

    def simulator(self, *arguments, things=True):
        """A simulator with the obstacles of the file, or with none."""
        return Simulator(self, '_map:=field', '_speed:=10', '_laser/noise:=0', '_rates/sensors:=50',
                         *([f'_obstacles:={self.path}'] if things else []), *arguments)

    def markers(self):
        """The messages of the topic."""
        return Heard(self, '/simulator/obstacles', MarkerArray)

    def test_the_obstacles_of_a_file_are_told_to_each_new_subscriber(self):
        simulator = self.simulator()
        simulator.pause()
        message = self.markers().find()
        first, *shown = message.markers
        self.assertEqual(first.action, Marker.DELETEALL)
        self.assertEqual([(one.ns, one.type, one.action, one.header.frame_id) for one in shown], [
            ('leg', Marker.CYLINDER, Marker.ADD, 'map'), ('book', Marker.CUBE, Marker.ADD, 'map'),
            ('cat', Marker.CYLINDER, Marker.ADD, 'map')])
        leg, book, _ = shown
        self.assertEqual((leg.pose.position.x, leg.pose.position.y, leg.pose.position.z), (3.0, 2.0, 0.2))
        self.assertEqual((leg.scale.x, leg.scale.y, leg.scale.z), (0.1, 0.1, 0.4))
        self.assertEqual((book.scale.x, book.scale.y, book.scale.z), (0.3, 0.2, 0.03))
        self.assertAlmostEqual(2.0 * math.atan2(book.pose.orientation.z, book.pose.orientation.w), 0.5)

    def test_movers_are_told_five_times_a_second_where_they_are(self):
        simulator = self.simulator()
        heard = self.markers()
        simulator.pause()
        simulator.does('reset')
        heard.find(lambda message: message.markers[-1].pose.position.x == 4.0)
        heard.messages.clear()
        simulator.step(200)
        wait(self, lambda: len(heard.messages) == 20, 'twenty messages')
        cats = [message.markers[-1] for message in heard.messages]
        self.assertEqual({cat.pose.position.y for cat in cats}, {5.0})
        for before, after in zip(cats, cats[1:]):
            self.assertEqual((after.header.stamp - before.header.stamp).to_nsec(), 200_000_000)
            self.assertAlmostEqual(after.pose.position.x - before.pose.position.x, 0.1)

    def test_the_laser_sees_what_is_high_and_the_bumper_finds_everything(self):
        simulator = self.simulator()
        simulator.teleport(2.0, 2.0, 0.0)
        scan = Heard(self, '/rumba/scan')
        self.assertAlmostEqual(scan.fresh(lambda message: message.ranges[180] < 5.0).ranges[180], 0.95, places=5)
        bumper, truth, commands = Heard(self, '/rumba/bumper'), Heard(self, '/rumba/ground_truth'), Commands(self)
        for x, y, theta in ((2.6, 2.0, 0.0), (5.0, 2.6, math.pi / 2.0)):
            simulator.teleport(x, y, theta)
            bumper.fresh(lambda message: not message.is_left_pressed)
            while not any(message.is_left_pressed for message in bumper.messages[-1:]):
                commands.send(0.2, 0.0)
                bumper.fresh()
        pose = truth.fresh().pose.pose.position
        self.assertLess(pose.y, 3.0 - RADIUS - 0.05)

    def test_obstacles_are_added_and_removed_by_services(self):
        simulator = self.simulator(things=False)
        heard = self.markers()
        self.assertEqual(len(heard.find().markers), 1)
        simulator.teleport(2.0, 2.0, 0.0)
        simulator.does('add_obstacle', disc('vase', 3.0, 2.0))
        heard.find(lambda message: [one.ns for one in message.markers[1:]] == ['vase'])
        scan = Heard(self, '/rumba/scan')
        self.assertAlmostEqual(scan.find(lambda message: message.ranges[180] < 5.0).ranges[180], 0.9, places=5)
        simulator.does('add_obstacle', AddObstacleRequest(
            name='dog', height=0.3, length=0.5, width=0.2, speed=0.5, pause_max=1.0, waypoints=[
                Pose2D(4.0, 4.0, 0.5), Pose2D(5.0, 4.0, 0.5)]))
        heard.find(lambda message: len(message.markers) == 3 and message.markers[2].pose.position.x > 4.5)
        simulator.does('remove_obstacle', 'vase')
        heard.find(lambda message: [one.ns for one in message.markers[1:]] == ['dog'])
        self.assertEqual(scan.fresh(lambda message: message.ranges[180] == math.inf).ranges[180], math.inf)

    def test_invalid_requests_are_refused_with_one_line_and_change_nothing(self):
        simulator = self.simulator()
        simulator.pause()
        simulator.teleport(2.0, 2.0, 0.0)
        before = simulator.digest()
        for request, message in (
                (disc('leg', 7.0, 7.0), r"^'leg' is taken: obstacles are leg, book, cat$"),
                (disc('a b', 7.0, 7.0), r"^'a b' is not a valid name: must be 1 to 64 letters, digits and _, "),
                (disc('', 7.0, 7.0), r"^'' is not a valid name: "),
                (disc('vase', 2.2, 2.0), r"^vase at \(2\.20, 2\.00\) m: 'rumba' stands there$"),
                (disc('vase', 20.0, 2.0), r'^vase at \(20\.00, 2\.00\) m lies outside the map \(x '),
                (disc('vase', math.nan, 2.0), r'^vase/pose is \[nan, 2\.0, 0\.0\]: must be \[x, y, yaw\] in m, m, rad'),
                (disc('vase', 7.0, 7.0, 0.0), r'^vase has none of radius, size: must have one of them$'),
                (disc('vase', 7.0, 7.0, -1.0), r'^vase/radius is -1\.0: must be 0\.005 to 20 \[m\]$'),
                (disc('vase', 7.0, 7.0, math.inf), r'^vase/radius is inf: must be 0\.005 to 20 \[m\]$'),
                (disc('vase', 7.0, 7.0, height=0.0), r'^vase/height is 0\.0: must be 0\.001 to 10 \[m\]$'),
                (disc('vase', 7.0, 7.0, length=1.0, width=1.0), r'^vase has radius and size of radius, size: '),
                (disc('vase', 7.0, 7.0, waypoints=[Pose2D(7.0, 7.0, 0.0)], speed=1.0), r'^vase/waypoints is \[\['),
                (disc('vase', 7.0, 7.0, waypoints=[Pose2D(), Pose2D(1.0, 1.0, 0.0)]), r'^vase/speed is 0\.0: ')):
            simulator.refuses(message, 'add_obstacle', request)
        simulator.refuses(r"^there is no obstacle 'vase': obstacles are leg, book, cat$", 'remove_obstacle', 'vase')
        simulator.refuses(r"^\(3\.10, 2\.00\) m: the obstacle 'leg' stands there$", 'rumba/teleport',
                          Pose2D(3.1, 2.0, 0.0))
        simulator.refuses(r"^\(3\.10, 2\.00\) m: the obstacle 'leg' stands there$", 'spawn', 'other',
                          Pose2D(3.1, 2.0, 0.0))
        self.assertEqual(simulator.digest(), before)

    def test_a_reset_puts_movers_back_and_the_run_repeats(self):
        simulator = self.simulator()
        simulator.pause()
        digests = []
        for _ in range(2):
            simulator.does('reset')
            simulator.step(150)
            digests.append(simulator.digest())
        self.assertEqual(digests[0], digests[1])
        world = World(map_file.load(map_path('field')), RobotConfig(), 50, 1, obstacle_file.load(str(self.path)))
        world.spawn('rumba')
        world.step(150)
        self.assertEqual((world.digest(), world.tick), digests[0])

    def test_a_saved_world_goes_on_with_its_obstacles(self):
        folder = folder_of(self, ROOM)
        arguments = [f'_state:={folder / "state"}']
        simulator = self.simulator(*arguments)
        simulator.does('add_obstacle', disc('vase', 7.0, 7.0))
        simulator.pause()
        simulator.step(40)
        digest = simulator.digest()
        simulator.end()
        again = self.simulator(*arguments)
        names = [one.ns for one in self.markers().find().markers[1:]]
        self.assertEqual(names, ['leg', 'book', 'cat', 'vase'])
        again.pause()
        self.assertGreaterEqual(again.digest()[1], digest[1])


if __name__ == '__main__':
    rospy.init_node('test_simulator_obstacles')
    rostest.rosrun('rumba_sim', 'simulator_obstacles', SimulatorObstaclesTest)
