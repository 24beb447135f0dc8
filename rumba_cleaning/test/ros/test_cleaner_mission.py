#!/usr/bin/env python3
"""A whole mission through ROS cleans as much, in as much time, as the same one without."""

import unittest

import rospy
import rostest
from cleaners import Cleaner
from simulators import Simulator

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import STEP_RATE, steps
from rumba_cleaning.mission.mission import Mission
from rumba_msg.msg import CleanGoal, Outcome
from rumba_sim.model import map_file
from rumba_sim.model.robot import FIRST
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.model.world import World
from rumba_sim.ros.common.maps import map_path

SPEED = 20


def mission_without_ros():
    """Coverage at the end, and how long it took [s]."""
    config = CleaningConfig()
    plan = map_file.load(map_path('studio'))
    world = World(plan, RobotConfig(), STEP_RATE, seed=1)
    world.spawn(FIRST, brushes_up=True)
    world.step()  # the contacts of the dock close in the first tick
    mission = Mission(Context(plan, RobotConfig(), config, seed=1), config.strategy, config.target_coverage)
    for _ in steps(mission, world, FIRST, 3600.0):
        pass
    assert mission.status is Status.SUCCEEDED, mission.message
    return world.floor.coverage, world.time


class CleanerMissionTest(unittest.TestCase):
    """One mission in the studio."""

    def test_a_mission_is_as_good_as_without_ros(self):
        cleaner = Cleaner(self)
        Simulator(self, '_map:=studio', f'_speed:={SPEED}')
        goal = cleaner.connect().send('clean', CleanGoal())
        coverage, seconds = mission_without_ros()
        answer = goal.ends(Outcome.SUCCEEDED)
        self.assertGreaterEqual(answer.cleaning.coverage, 0.98)
        self.assertAlmostEqual(answer.cleaning.coverage, coverage, delta=0.02)
        # Through ROS, time passes while the cleaner plans, and all the more on a busy machine.
        self.assertAlmostEqual(len(goal.feedback), seconds, delta=0.5 * seconds)


if __name__ == '__main__':
    rospy.init_node('test_cleaner_mission')
    rostest.rosrun('rumba_cleaning', 'cleaner_mission', CleanerMissionTest)
