"""A robot can go out the way it came in, even if its map then shows a passage that is too narrow."""

import math

import numpy as np
import pytest
from rooms import room

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.track import Track
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.strategies.frontiers import frontiers
from rumba_cleaning.survey import Survey
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import UNKNOWN, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

SIDE, MIDDLE = 2.0, 1.0  # [m] of a room, and of its neck and the niche behind it, in y
ROOM, NICHE = Pose(1.0, MIDDLE, 0.0), 0.25  # from the neck to the middle of the niche [m]
NECKS = pytest.mark.parametrize('length', [0.06, 0.1, 0.2, 0.4])


def niche(length, width, resolution=0.02):
    """A room of 2 x 2 m, a neck of a length and a width [m] behind it, and a niche of 0.5 x 0.4 m behind that."""
    end, half = SIDE + length, 0.5 * width
    boxes = [(SIDE, 0.0, end, MIDDLE - half), (SIDE, MIDDLE + half, end, SIDE),
             (end, 0.0, 9.0, MIDDLE - 0.2), (end, MIDDLE + 0.2, 9.0, SIDE)]
    return room(end + 0.5, SIDE, resolution, tuple(boxes))


class Told(Survey):
    """Tells the plan and the key frames that a test sets."""

    def __init__(self, plan):
        """Tell a plan."""
        self.newest, self.poses = plan, np.array([ROOM, ROOM])

    def plan(self):
        """The plan."""
        return self.newest

    def frames(self):
        """The key frames."""
        return self.poses


def came_to(context, start, end):
    """Drive straight from one pose to another; returns that."""
    for share in np.linspace(0.0, 1.0, 60):
        context.follow(Pose(*(np.array(start) + share * (np.array(end) - start))))
    return end


def in_the_niche(length, wide=0.4, narrow=0.32):
    """A robot that came through the neck before its map showed that as too narrow; and its pose."""
    context = Context(niche(length, wide), RobotConfig(), CleaningConfig(), survey=Told(niche(length, wide)))
    context.swept.begin(*ROOM[:2])
    pose = came_to(context, ROOM, Pose(SIDE + length + NICHE, MIDDLE, 0.0))
    context.survey.newest = niche(length, narrow)
    return context, pose


@NECKS
def test_a_robot_goes_out_of_a_niche_the_way_it_came_in(length):
    context, pose = in_the_niche(length)
    assert paths.between(Context(niche(length, 0.32), RobotConfig(), CleaningConfig()).ground, np.array(pose[:2]),
                         np.array(ROOM[:2])) is None  # without having come that way
    assert context.learn(pose) and not context.learn(pose)
    path = paths.between(context.ground, np.array(pose[:2]), np.array(ROOM[:2]))
    assert (path[[0, -1]] == [pose[:2], ROOM[:2]]).all()
    in_neck = (path[:, 0] > SIDE) & (path[:, 0] < SIDE + length)
    assert (abs(path[in_neck, 1] - MIDDLE) <= context.plan.resolution).all()
    assert context.swept.reachable_area > 0.8 * SIDE ** 2
    assert math.isfinite(paths.lengths_to(context.ground, *pose[:2])[context.ground.node(*ROOM[:2])])


def test_a_robot_in_a_niche_goes_on_to_explore_what_lies_beyond_the_way_it_came():
    context, pose = in_the_niche(0.1)
    plan = niche(0.1, 0.32)
    occupancy = plan.occupancy.copy()
    occupancy[:, :20] = UNKNOWN
    context.survey.newest = FloorPlan('a part', occupancy, plan.resolution, plan.origin)
    context.learn(pose)
    assert (context.ground.points(frontiers(context.ground, pose))[:, 0] < ROOM.x).all()
    assert len(frontiers(context.ground, pose))


def test_an_obstacle_on_the_way_it_came_holds_a_robot_back():
    context, pose = in_the_niche(0.2)
    context.learn(pose)
    context.ground.mark(SIDE + 0.1, MIDDLE, 0.05)
    assert paths.between(context.ground, np.array(pose[:2]), np.array(ROOM[:2])) is None


def test_the_way_it_came_moves_with_a_redrawn_map():
    context, pose = in_the_niche(0.2)
    moved = niche(0.2, 0.32)
    survey = context.survey
    survey.newest = FloorPlan('moved', moved.occupancy, moved.resolution, (moved.origin[0] + 0.3, moved.origin[1]))
    survey.poses = survey.poses + (0.3, 0.0, 0.0)
    pose = Pose(pose.x + 0.3, pose.y, pose.theta)
    assert context.follow(pose)
    assert paths.between(context.ground, np.array(pose[:2]), np.array([ROOM.x + 0.3, ROOM.y])) is not None


@pytest.mark.parametrize('step', [0.04, 1.0])
def test_no_way_leads_through_a_wall_even_if_the_pose_was_wrong_or_the_robot_was_carried(step):
    plan, track = room(4.0, 2.0, 0.02, [(1.96, 0.0, 2.04, 2.0)]), Track()
    for x in np.arange(0.5, 3.5 + step, step):
        track.follow(Pose(x, 1.0, 0.0))
    context = Context(track.on(plan, 0.18), RobotConfig(), CleaningConfig())
    assert paths.between(context.ground, np.array([1.0, 1.0]), np.array([3.0, 1.0])) is None
    assert plan.clearance[plan.rows // 2].max() == context.plan.clearance[plan.rows // 2].max()


def test_a_floor_of_which_no_way_is_known_stays_as_it_is():
    plan = niche(0.1, 0.32)
    assert Track().on(plan, 0.18) is plan
