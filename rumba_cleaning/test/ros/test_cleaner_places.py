#!/usr/bin/env python3
"""The cleaner elsewhere: two robots in a namespace, floors without a way or a dock, another localisation."""

import os
import subprocess
import tempfile
import unittest

import rospy
import rostest
from cleaners import Cleaner, go_to
from geometry_msgs.msg import Pose2D, TransformStamped
from simulators import Heard, Simulator, lookup, wait
from tf2_msgs.msg import TFMessage

from rumba_msg.msg import CleanGoal, DockGoal
from rumba_msg.srv import Teleport

ROOMS = """image: rooms.pgm
resolution: 0.05
origin: [0, 0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
WIDTH, HEIGHT, WALL = 80, 40, 40  # [cells]; the wall between the rooms stands at 2 m
BREAKS = """from rumba_cleaning.behaviour import Behaviour, Command
from rumba_cleaning.strategies import strategy
@strategy('breaks')
class Breaks(Behaviour):
    def __init__(self, context):
        self.updates = 0
    def update(self, observation):
        self.updates += 1
        return Command(0.1, 0.0) if self.updates < 9 else 1 / 0
@strategy('never_begins')
def never_begins(context):
    return context.no_such_thing
"""


def write(folder, name, content):
    """Make a file; returns its path."""
    path = os.path.join(folder, name)
    with open(path, 'wb') as file:
        file.write(content)
    return path


def two_rooms(folder):
    """Write a map of two rooms with a wall between them and no dock; returns its path."""
    row = bytearray(b'\xff' * WIDTH)
    row[WALL] = 0
    write(folder, 'rooms.pgm', b'P5 %d %d 255\n' % (WIDTH, HEIGHT) + bytes(row * HEIGHT))
    return write(folder, 'rooms.yaml', ROOMS.encode())


class CleanerPlacesTest(unittest.TestCase):
    """A simulator for each place."""

    def folder(self):
        """A folder for this test."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return folder.name

    def test_two_robots_in_two_rooms_without_a_dock_or_a_door(self):
        if rospy.has_param('/upstairs'):
            rospy.delete_param('/upstairs')
        cleaners = {robot: Cleaner(self, '__ns:=/upstairs', f'__name:=cleaner_of_{robot}', f'_robot:={robot}',
                                   name=f'/upstairs/cleaner_of_{robot}', robot=f'/upstairs/{robot}')
                    for robot in ('rumba', 'rumba2')}
        path = two_rooms(self.folder())
        process = subprocess.Popen(['rosrun', 'rumba_sim', 'simulator', '__ns:=/upstairs', f'_map:={path}',
                                    '_robots:=2', '_speed:=10'])
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        wait(self, lambda: lookup('/upstairs/simulator/spawn'), 'the simulator')
        for robot, x in (('rumba2', 3.0), ('rumba', 1.0)):
            rospy.ServiceProxy(f'/upstairs/{robot}/teleport', Teleport)(Pose2D(x, 1.0, 0.0))
            cleaners[robot].connect()
        cleaner = cleaners['rumba']
        cleaner.refuses(r'rooms\.yaml: no dock on the map: ', 'dock', DockGoal())
        cleaner.refuses(r'^no way from \(1\.00, 1\.00\) to \(3\.00, 1\.00\) m$', 'go_to', go_to(3.0, 1.0))
        cleaning = cleaner.send('clean', CleanGoal(target_coverage=0.3))
        cleaners['rumba2'].send('go_to', go_to(3.5, 1.4, 2.0)).ends('succeeded')
        truth = Heard(self, '/upstairs/rumba2/ground_truth').fresh().pose.pose.position
        self.assertAlmostEqual(truth.x, 3.5, delta=0.03)
        self.assertAlmostEqual(truth.y, 1.4, delta=0.03)
        self.assertRegex(cleaning.ends('succeeded').message, r'^30\.\d % swept$')

    def test_a_localisation_of_the_users_own_and_a_strategy_that_breaks(self):
        path = os.environ['PYTHONPATH']
        os.environ['PYTHONPATH'] = f'{self.folder()}:{path}'
        self.addCleanup(os.environ.update, PYTHONPATH=path)
        write(os.environ['PYTHONPATH'].split(':')[0], 'my_strategies.py', BREAKS.encode())
        cleaner = Cleaner(self, '_strategies:=my_strategies', '_strategy:=breaks')
        Simulator(self, '_map:=studio', '_speed:=10', '_localisation:=false')
        cleaner.connect()
        cleaner.refuses('^nobody tells where it is: tf has no map -> odom -> base_footprint$', 'go_to',
                        go_to(1.5, 2.5))
        publisher = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.addCleanup(publisher.unregister)
        start = TransformStamped()
        start.header.frame_id, start.child_frame_id = 'map', 'odom'
        start.transform.translation.x, start.transform.translation.y = 3.075, 2.84
        start.transform.rotation.w = 1.0
        publisher.publish([start])
        cleaner.send('go_to', go_to(1.5, 2.5)).ends('succeeded')
        truth = Heard(self, '/rumba/ground_truth')
        self.assertAlmostEqual(truth.fresh().pose.pose.position.x, 1.5, delta=0.15)
        self.assertAlmostEqual(truth.fresh().pose.pose.position.y, 2.5, delta=0.15)
        answer = cleaner.send('clean', CleanGoal()).ends('aborted')
        self.assertEqual(answer.message, 'ZeroDivisionError: division by zero')
        truth.fresh(lambda message: message.twist.twist.linear.x == 0.0)
        cleaner.refuses("^AttributeError: 'Context' object has no attribute 'no_such_thing'$", 'clean',
                        CleanGoal('never_begins', 0.0, 0.0))
        cleaner.send('go_to', go_to(2.0, 2.5)).ends('succeeded')


if __name__ == '__main__':
    rospy.init_node('test_cleaner_places')
    rostest.rosrun('rumba_sim', 'cleaner_places', CleanerPlacesTest)
