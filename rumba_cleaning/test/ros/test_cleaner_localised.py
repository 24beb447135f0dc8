#!/usr/bin/env python3
"""A robot that localises itself cleans, through ROS as in process; and knows what to do if nobody tells its pose."""

import dataclasses
import os
import re
import threading
import unittest

import rospy
import rostest
from cleaners import Cleaner
from geometry_msgs.msg import PoseWithCovarianceStamped
from localisers import Localiser, Mapper
from sensor_msgs.msg import LaserScan
from simulators import ROOM, Heard, Simulator, folder_of
from teams import QUICKLY
from tiers import thorough

from rumba_cleaning.behaviour import Status
from rumba_cleaning.behaviours import relocation
from rumba_cleaning.belief.context import Context, own_seed
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, STEP_RATE, act
from rumba_cleaning.executors import BeforeNextStep
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.pose_source import Localised
from rumba_msg.msg import CleanGoal, DockStatus, MissionStatus, Outcome
from rumba_sim.model.common.config import updated
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation import obstacle_file
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.participants.maps import map_path

# Two rooms of 2 m, 40 x 40 cells each, with a door that is 0.75 m wide; the dock is in the left one.
ROOMS = {'room.yaml': ROOM['room.yaml'] + b'dock: [0.3, 1.79, 1.5707963]\n',
         'room.pgm': b'P5 82 40 255\n' + 25 * (40 * b'\xff' + 2 * b'\x00' + 40 * b'\xff') + 15 * 82 * b'\xff'}
SEED, TARGET = 3, 0.08  # of the floor: by then the robot has met an obstacle
SIMULATOR = '_map:=studio', f'_seed:={SEED}', '_speed:=0', '_brushes_up:=true', '_localisation:=none'


def digest_in_process(ticks, obstacles, laser, model='ideal'):
    """The digest of the world so many ticks after the start of a mission by a pose that is localised."""
    plan, robot = map_file.load(map_path('studio')), updated(RobotConfig(), {'laser': {'model': model}}, 'test')
    world, planners = World(plan, robot, STEP_RATE, SEED, obstacles), BeforeNextStep()
    world.spawn(FIRST, brushes_up=True)
    source = Localised(plan, world, FIRST, SEED)
    world.step()
    config = dataclasses.replace(QUICKLY, laser=laser)
    mission = Mission(Context(plan, robot, config, own_seed(SEED, FIRST), planners), 'boustrophedon', TARGET)
    dt = 0.0
    while mission.status is Status.RUNNING:
        planners.work()
        act(mission, world, FIRST, dt, source)
        world.step(CONTROL_TICKS)
        dt = CONTROL_DT
    world.step(ticks - world.tick)
    return world.digest()


class CleanerLocalisedTest(unittest.TestCase):
    """Each test has its own nodes."""

    @thorough
    def test_a_mission_by_a_localised_pose_and_by_laser_among_obstacles_is_the_same_as_in_process(self):
        self.assert_same_as_in_process('ideal')

    @thorough
    def test_so_is_a_mission_with_a_laser_that_turns_slowly_and_misses_echoes(self):
        self.assert_same_as_in_process('rplidar_a1')

    def assert_same_as_in_process(self, model):
        path = os.path.join(os.path.dirname(map_path('studio')), '..', 'config', 'obstacles_studio.yaml')
        simulator = Simulator(self, *SIMULATOR, f'_obstacles:={path}', '_wait_for:=cleaner localiser',
                              '_lockstep_patience:=60', f'_laser/model:={model}')
        start = map_file.load(map_path('studio')).dock
        Localiser(self, f'_seed:={SEED}', f'_initial_pose_x:={start.x}', f'_initial_pose_y:={start.y}',
                  f'_initial_pose_a:={start.theta}')
        cleaner = Cleaner(self, f'_seed:={SEED}', f'_target_coverage:={TARGET}', '_autostart:=true',
                          '_laser:=true').connect()
        ended = cleaner.status.find(lambda status: status.state == MissionStatus.IDLE and 'swept' in status.message)
        self.assertRegex(ended.message, rf'^{100.0 * TARGET:.0f}\.\d % swept$')
        (digest, tick), obstacles = simulator.digest(), obstacle_file.load(path)
        self.assertEqual(digest, digest_in_process(tick, obstacles, laser=True, model=model))
        self.assertNotEqual(digest, digest_in_process(tick, obstacles, laser=False, model=model))  # it saw something

    def test_a_robot_whose_localisation_falls_silent_stands_still_until_it_is_back(self):
        Simulator(self, '_map:=studio', '_speed:=10', '_brushes_up:=true', '_localisation:=none',
                  '_lockstep_patience:=1')
        first, cleaner = Localiser(self), Cleaner(self).connect()
        Heard(self, '/rumba/amcl_pose', PoseWithCovarianceStamped).find()
        goal = cleaner.send('clean', CleanGoal(target_coverage=0.5))
        cleaner.status.find(lambda status: status.state == MissionStatus.CLEANING and '%' in status.message)
        first.process.kill()
        first.process.wait()
        cleaner.status.fresh(lambda status: status.message == relocation.MESSAGE)
        cleaner.commands.fresh(lambda twist: not twist.linear.x and not twist.angular.z)
        Localiser(self)
        cleaner.status.fresh(lambda status: status.state == MissionStatus.CLEANING and 'swept' in status.message)
        self.assertFalse(goal.has_ended)

    def test_a_robot_whose_laser_falls_silent_waits_until_it_is_back(self):
        Simulator(self, '_map:=studio', '_speed:=4', '_brushes_up:=true', '_localisation:=none',
                  '_lockstep_patience:=1')
        relayed, is_on = rospy.Publisher('/relayed/scan', LaserScan, queue_size=10), threading.Event()
        is_on.set()
        relay = rospy.Subscriber('/rumba/scan', LaserScan, lambda scan: is_on.is_set() and relayed.publish(scan))
        self.addCleanup(relay.unregister)
        Localiser(self, 'rumba/scan:=/relayed/scan')
        cleaner = Cleaner(self).connect()
        Heard(self, '/rumba/amcl_pose', PoseWithCovarianceStamped).find()
        goal = cleaner.send('clean', CleanGoal(target_coverage=0.5))
        cleaner.status.find(lambda status: status.state == MissionStatus.CLEANING and '%' in status.message)
        is_on.clear()
        waits = re.compile(r'the laser has been silent for \d+ s: waits for it')
        cleaner.status.fresh(lambda status: waits.fullmatch(status.message))
        cleaner.commands.fresh(lambda twist: not twist.linear.x and not twist.angular.z)
        is_on.set()
        cleaner.status.fresh(lambda status: status.state == MissionStatus.CLEANING and 'swept' in status.message
                             and 'silent' not in status.message)
        self.assertFalse(goal.has_ended)

    def test_a_floor_that_nobody_shows_is_explored_and_cleaned(self):
        rooms = folder_of(self, ROOMS) / 'room.yaml'
        simulator = Simulator(self, f'_map:={rooms}', f'_seed:={SEED}', '_speed:=0', '_brushes_up:=true',
                              '_localisation:=slam', '_wait_for:=mapper', '_lockstep_patience:=60')
        Mapper(self)
        cleaner = Cleaner(self, '_mapping:=true', '_strategy:=explore_and_clean').connect()
        goal = cleaner.send('clean', CleanGoal(target_coverage=TARGET))
        cleaner.status.find(lambda status: status.message.endswith('exploring'))
        message = goal.ends(Outcome.SUCCEEDED).outcome.message
        self.assertRegex(message, rf'^{100.0 * TARGET:.0f}\.\d % swept$')
        self.assertTrue(Heard(self, '/rumba/dock_status', DockStatus).find().is_docked)
        self.assertIsNone(simulator.process.poll())


if __name__ == '__main__':
    rospy.init_node('test_cleaner_localised')
    rostest.rosrun('rumba_cleaning', 'cleaner_localised', CleanerLocalisedTest)
