#!/usr/bin/env python3
"""A whole mission through ROS cleans as much, in as much time, as the same one without."""

import unittest

import rospy
import rostest
from cleaners import Cleaner
from rospkg import RosPack
from simulators import Simulator

from rumba_msg.msg import CleanGoal
from rumba_sim.cleaning.behaviour import Observation, Status
from rumba_sim.cleaning.cleaning_config import CleaningConfig
from rumba_sim.cleaning.context import Context
from rumba_sim.cleaning.mission import Mission
from rumba_sim.model import map_file
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.model.world import World

SPEED = 20
TICKS = 5  # of a reading at 10 Hz


def mission_without_ros():
    """Coverage at the end, and how long it took [s]."""
    plan = map_file.load(f'{RosPack().get_path("rumba_sim")}/maps/studio.yaml')
    world, mission = World(plan, seed=1), Mission(Context(plan, RobotConfig(), CleaningConfig(), 1), 'boustrophedon',
                                                  0.99)
    robot = world.spawn('rumba')
    world.step(TICKS)
    while mission.status is Status.RUNNING:
        command = mission.update(Observation(
            TICKS / world.step_rate, robot.pose, robot.bumper, world.cliffs('rumba'), robot.battery.state_of_charge,
            robot.is_docked, world.infrared('rumba')))
        robot.brushes_up = command.brushes_up
        robot.command(command.v, command.w, world.tick)
        world.step(TICKS)
    return world.floor.coverage, world.time


class CleanerMissionTest(unittest.TestCase):
    """One mission in the studio."""

    def test_a_mission_is_as_good_as_without_ros(self):
        cleaner = Cleaner(self)
        Simulator(self, '_map:=studio', f'_speed:={SPEED}')
        goal = cleaner.connect().send('clean', CleanGoal())
        coverage, seconds = mission_without_ros()
        answer = goal.ends('succeeded')
        self.assertGreaterEqual(answer.cleaning.coverage, 0.98)
        self.assertAlmostEqual(answer.cleaning.coverage, coverage, delta=0.02)
        self.assertAlmostEqual(len(goal.feedback), seconds, delta=0.25 * seconds)


if __name__ == '__main__':
    rospy.init_node('test_cleaner_mission')
    rostest.rosrun('rumba_sim', 'cleaner_mission', CleanerMissionTest)
