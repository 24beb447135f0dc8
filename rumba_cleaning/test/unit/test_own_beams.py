"""Beams of other docks that cannot be those of the robot's own: compared with a floor that has no other docks."""

import math

import numpy as np
import pytest
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import CERTAIN, Observation
from rumba_cleaning.behaviours.own_beams import own_beams
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.robot import Infrared
from rumba_sim.model.simulation.world import World

AWAY = RADIUS + 0.03
OWN = Pose(1.5, 3.0 - AWAY, 0.5 * math.pi)
LEFT, RIGHT = Pose(AWAY, 1.8, math.pi), Pose(3.0 - AWAY, 1.6, 0.0)
BLURRED = ((0.03 ** 2, 0.0, 0.0), (0.0, 0.03 ** 2, 0.0), (0.0, 0.0, 0.02 ** 2))


def received(docks, pose):
    """What a robot receives in a room of 3 x 3 m with docks."""
    world = World(room(3.0, 3.0, dock=docks[0], further_docks=tuple(docks[1:])), quiet())
    world.spawn('rumba', pose)
    return world.infrared('rumba')


def taken(pose, infrared, covariance=CERTAIN):
    """What it takes for beams of its own dock, among three docks."""
    return own_beams(Observation(0.1, pose, infrared=infrared, covariance=covariance), OWN, [LEFT, RIGHT],
                     quiet()).infrared


def poses(count):
    """Poses in the room."""
    generator = np.random.default_rng(5)
    return [Pose(*generator.uniform((0.3, 0.3, -math.pi), (2.7, 2.7, math.pi)).tolist()) for _ in range(count)]


@pytest.mark.parametrize('off, covariance', [((0.0, 0.0, 0.0), CERTAIN), ((0.05, -0.04, 0.03), BLURRED)])
def test_no_beam_of_the_own_dock_is_dropped(off, covariance):
    """Also if the pose is wrong by two deviations."""
    for pose in poses(200):
        alone = received([OWN], pose)
        wrong = Pose(*(value + by for value, by in zip(pose, off)))
        assert taken(wrong, alone, covariance) == alone


def test_nearly_all_beams_of_other_docks_are_dropped():
    """The pose may be wrong by 2 cm, and the directions in which beams are sent and received have edges."""
    added = kept = 0
    for pose in poses(200):
        alone, among = received([OWN], pose), received([OWN, LEFT, RIGHT], pose)
        added += among != alone
        kept += taken(pose, among) != alone
    assert added > 100 and kept < 0.15 * added


def test_a_robot_that_sees_its_dock_ahead_does_not_take_a_dock_aside_for_it():
    """Before, the edge of the beams of its own dock was where those of the other one ended."""
    pose = Pose(1.5, 1.7, 0.5 * math.pi - 0.4)
    alone, among = received([OWN], pose), received([OWN, LEFT, RIGHT], pose)
    assert (alone.left > 0, alone.right, among.right > 0) == (True, 0, True)
    assert taken(pose, among) == alone


def test_all_beams_count_if_no_other_dock_is_near():
    beams = Infrared(13, 13, 13)
    observation = Observation(0.1, Pose(1.5, 1.0, 0.0), infrared=beams)
    assert own_beams(observation, OWN, [Pose(9.0, 9.0, 0.0)], quiet()).infrared == beams
