#!/usr/bin/env python3
"""A whole mission through ROS cleans as much, in as much time, as the same one without."""

import unittest

import rospy
import rostest
from cleaners import Cleaner
from rospkg import RosPack
from simulators import Simulator

from rumba_evaluation.trials.trial import Trial
from rumba_msg.msg import CleanGoal
from rumba_sim.model import map_file

SPEED = 20


def mission_without_ros():
    """Coverage at the end, and how long it took [s]."""
    trial = Trial(map_file.load(f'{RosPack().get_path("rumba_sim")}/maps/studio.yaml'), 'boustrophedon', seed=1)
    while not trial.is_over:
        trial.step()
    return trial.world.floor.coverage, trial.world.time


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
