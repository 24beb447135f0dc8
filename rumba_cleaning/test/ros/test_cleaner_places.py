#!/usr/bin/env python3
"""The cleaner with other simulators, maps and strategies: in a namespace, without a dock, with another localisation."""

import os
import subprocess
import unittest

import rospy
import rostest
from cleaners import Cleaner, Person, go_to
from geometry_msgs.msg import Pose2D, TransformStamped
from simulators import Heard, Simulator, folder_of, wait_for_service
from tf2_msgs.msg import TFMessage
from tiers import thorough

from rumba_msg.msg import CleanGoal, DockGoal, MissionStatus, Outcome
from rumba_msg.srv import Teleport

HEADER = """resolution: 0.05
origin: [0, 0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
start: [1.0, 1.0, 0.0]
"""


def picture(*parts):
    """A picture of 80 x 40 cells; each part is a number of columns, and whether they are dark."""
    return b'P5 80 40 255\n' + 40 * b''.join(columns * (b'\0' if is_dark else b'\xff') for columns, is_dark in parts)


# Two rooms with a wall between them at 2 m, and no dock.
ROOMS = {'rooms.yaml': f'image: rooms.pgm\n{HEADER}'.encode(),
         'rooms.pgm': picture((40, False), (1, True), (39, False))}
# A floor whose right half is a cliff.
CLIFF = {'cliff.yaml': f'image: floor.pgm\ncliff: cliff.pgm\n{HEADER}'.encode(),
         'floor.pgm': picture((80, False)), 'cliff.pgm': picture((40, False), (40, True))}
BREAKS = """from rumba_cleaning.behaviour import Behaviour, Command
from rumba_cleaning.strategies import strategy
@strategy('breaks')
class Breaks(Behaviour):
    def __init__(self, context):
        self.updates = 0
    def update(self, observation):
        self.updates += 1
        return Command(0.1, 0.0) if self.updates < 9 else 1 / 0
def nonsense(command):
    class Nonsense(Breaks):
        def update(self, observation):
            return command
    return Nonsense
strategy('text')(nonsense(Command('0.1', 0)))
strategy('nan')(nonsense(Command(float('nan'), 0)))
strategy('nothing')(nonsense(None))
@strategy('leaves')
class Leaves(Breaks):
    def update(self, observation):
        raise SystemExit(3)
@strategy('never_begins')
def never_begins(context):
    return context.no_such_thing
"""
NO_COMMAND = 'Nonsense.update returned {}: must be a Command of finite numbers'
NONSENSE = (('text', NO_COMMAND.format("Command(v='0.1', w=0, brushes_up=False, seeks_dock=False)")),
            ('nothing', NO_COMMAND.format('None')),
            ('nan', NO_COMMAND.format('Command(v=nan, w=0, brushes_up=False, seeks_dock=False)')),
            ('leaves', 'SystemExit: 3'))


class CleanerPlacesTest(unittest.TestCase):
    """A simulator for each place."""

    @thorough
    def test_two_robots_in_two_rooms_without_a_dock_or_a_door(self):
        if rospy.has_param('/upstairs'):
            rospy.delete_param('/upstairs')
        path = folder_of(self, ROOMS) / 'rooms.yaml'
        process = subprocess.Popen(['rosrun', 'rumba_sim', 'simulator', '__ns:=/upstairs', f'_map:={path}',
                                    '_robots:=2', '_speed:=10'])
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        wait_for_service(self, '/upstairs/simulator/spawn')
        cleaners = {robot: Cleaner(self, '__ns:=/upstairs', f'__name:=cleaner_of_{robot}', f'_robot:={robot}',
                                   name=f'/upstairs/cleaner_of_{robot}', robot=f'/upstairs/{robot}')
                    for robot in ('rumba', 'rumba2')}
        for robot, x in (('rumba2', 3.0), ('rumba', 1.0)):
            rospy.ServiceProxy(f'/upstairs/{robot}/teleport', Teleport)(Pose2D(x, 1.0, 0.0))
            cleaners[robot].connect()
        cleaner = cleaners['rumba']
        cleaner.refuses(r'rooms\.yaml: no dock on the map: ', 'dock', DockGoal())
        cleaner.refuses(r'^no path from \(1\.00, 1\.00\) to \(3\.00, 1\.00\) m$', 'go_to', go_to(3.0, 1.0),
                        Outcome.NO_PATH)
        cleaning = cleaner.send('clean', CleanGoal(target_coverage=0.3))
        cleaners['rumba2'].send('go_to', go_to(3.5, 1.4, 2.0)).ends(Outcome.SUCCEEDED)
        truth = Heard(self, '/upstairs/rumba2/ground_truth').fresh().pose.pose.position
        self.assertAlmostEqual(truth.x, 3.5, delta=0.03)
        self.assertAlmostEqual(truth.y, 1.4, delta=0.03)
        self.assertRegex(cleaning.ends(Outcome.SUCCEEDED).outcome.message, r'^30\.\d % swept$')

    def test_the_simulator_may_have_any_name_and_relative_paths_of_any_folder(self):
        folder = folder_of(self, {**ROOMS, 'slow.yaml': b'drive: {max_speed: 0.1}\n'})
        cleaner = Cleaner(self)
        Simulator(self, '__name:=sim2', '_map:=./rooms.yaml', '_config:=./slow.yaml', '_speed:=10', node='/sim2',
                  folder=folder)
        cleaner.connect()
        truth = Heard(self, '/rumba/ground_truth')
        cleaner.refuses(r'^no path from ', 'go_to', go_to(3.0, 1.0), Outcome.NO_PATH)  # it knows the map ...
        cleaner.send('go_to', go_to(1.4, 1.0)).ends(Outcome.SUCCEEDED)
        fastest = max(message.linear.x for message in cleaner.commands.messages)
        self.assertAlmostEqual(fastest, 0.1, delta=0.001)  # ... and the robot
        self.assertAlmostEqual(truth.fresh().pose.pose.position.x, 1.4, delta=0.03)

    def test_a_robot_that_a_person_drives_over_a_cliff_gives_up_and_goes_on_once_it_is_put_elsewhere(self):
        cleaner = Cleaner(self)
        simulator = Simulator(self, f'_map:={folder_of(self, CLIFF)}/cliff.yaml', '_speed:=10')
        cleaner.connect()
        person = Person(self)
        goal = cleaner.send('clean', CleanGoal())
        cleaner.waits_to_drive()
        person.press(0.3, 0.0)
        cleaner.status.find(lambda message: message.state == MissionStatus.YIELDING)
        simulator.teleport(1.5, 1.0, 0.0)
        outcome = goal.ends(Outcome.FALLEN).outcome
        self.assertEqual(outcome.message, 'a wheel hangs over a cliff: the robot must be put elsewhere')
        cleaner.status.find(lambda message: message.state == MissionStatus.STRANDED)
        person.release()
        cleaner.refuses('^a wheel hangs over a cliff: ', 'go_to', go_to(1.0, 1.0), Outcome.FALLEN)
        simulator.teleport(0.5, 0.5, 0.0)
        cleaner.send('go_to', go_to(1.0, 1.0)).ends(Outcome.SUCCEEDED)

    def test_a_localisation_of_the_users_own_and_a_strategy_that_breaks(self):
        path = os.environ['PYTHONPATH']
        os.environ['PYTHONPATH'] = f'{folder_of(self, {"my_strategies.py": BREAKS.encode()})}:{path}'
        self.addCleanup(os.environ.update, PYTHONPATH=path)
        cleaner = Cleaner(self, '_strategies:=my_strategies', '_strategy:=breaks')
        Simulator(self, '_map:=studio', '_speed:=10', '_localisation:=none')
        cleaner.connect()
        cleaner.refuses('^no pose: tf has no map -> odom -> base_footprint$', 'go_to', go_to(1.5, 2.5),
                        Outcome.NO_READINGS)
        publisher = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.addCleanup(publisher.unregister)
        start = TransformStamped()
        start.header.frame_id, start.child_frame_id = 'map', 'odom'
        start.transform.translation.x, start.transform.translation.y = 3.075, 2.84
        start.transform.rotation.w = 1.0
        publisher.publish([start])
        cleaner.send('go_to', go_to(1.5, 2.5)).ends(Outcome.SUCCEEDED)
        truth = Heard(self, '/rumba/ground_truth')
        self.assertAlmostEqual(truth.fresh().pose.pose.position.x, 1.5, delta=0.15)
        self.assertAlmostEqual(truth.fresh().pose.pose.position.y, 2.5, delta=0.15)
        outcome = cleaner.send('clean', CleanGoal()).ends(Outcome.ERROR).outcome
        self.assertEqual(outcome.message, "strategy 'breaks': ZeroDivisionError: division by zero")
        truth.fresh(lambda message: message.twist.twist.linear.x == 0.0)
        for strategy, message in NONSENSE:
            outcome = cleaner.send('clean', CleanGoal(strategy=strategy)).ends(Outcome.ERROR).outcome
            self.assertEqual(outcome.message, f"strategy '{strategy}': {message}")
        cleaner.refuses("^AttributeError: 'Context' object has no attribute 'no_such_thing'$", 'clean',
                        CleanGoal(strategy='never_begins'), Outcome.ERROR)
        cleaner.send('go_to', go_to(2.0, 2.5)).ends(Outcome.SUCCEEDED)


if __name__ == '__main__':
    rospy.init_node('test_cleaner_places')
    rostest.rosrun('rumba_cleaning', 'cleaner_places', CleanerPlacesTest)
