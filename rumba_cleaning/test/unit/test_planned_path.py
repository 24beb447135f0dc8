"""What a robot shows of its plan is what it drives by, and nothing if it has none."""

import math

import numpy as np
import pytest
import rospy
from drivers import context_of
from pytest import approx
from rooms import RADIUS, crooked, quiet

from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.control import steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import State
from rumba_cleaning.ros.cleaner.robots import plan_topic
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.conversions import heading

PLAN = crooked(dock=Pose(4.0 - RADIUS - 0.01, 1.2, 0.0))
NEAR = 0.1  # [m] from a path: corners are rounded
NOW = rospy.Time(7)


def distance(path, point):
    """From a point to the lines between the corners of a path [m]."""
    first, along = path[:-1], np.diff(path, axis=0)
    share = np.clip(((point - first) * along).sum(axis=1) / (along ** 2).sum(axis=1), 0.0, 1.0)
    return np.hypot(*(point - first - share[:, np.newaxis] * along).T).min()


@pytest.mark.thorough(except_for=['explore_and_clean'])
@pytest.mark.parametrize('strategy', ['boustrophedon', 'explore_and_clean'])
def test_a_mission_drives_along_what_it_shows(strategy):
    world = World(PLAN, quiet())
    robot = world.spawn('rumba', PLAN.dock)
    mission = Mission(context_of(PLAN, world), strategy, 0.95)
    shown = {state: [] for state in State}
    for _ in steps(mission, world, seconds=600.0):
        path = mission.planned_path()
        if path is not None:
            shown[mission.state].append(distance(path, np.array(robot.pose[:2])))
    assert mission.message.startswith('95.')
    assert shown[State.UNDOCKING] == [] and len(shown[State.CLEANING]) > 500 and len(shown[State.RETURNING]) > 20
    assert max(shown[State.CLEANING]) < 0.35 and np.mean(np.array(shown[State.CLEANING]) < NEAR) > 0.95
    assert max(shown[State.RETURNING]) < NEAR


def test_a_strategy_without_a_plan_shows_none():
    world = World(PLAN, quiet())
    world.spawn('rumba', Pose(0.4, 0.4, 1.0))
    mission = Mission(context_of(PLAN, world), 'bounce', 0.9)
    assert all(mission.planned_path() is None for _ in steps(mission, world, seconds=20.0))


def test_the_path_of_go_to_leads_from_the_robot_to_the_target_and_is_gone_while_a_person_drives():
    world = World(PLAN, quiet())
    world.spawn('rumba', Pose(0.4, 0.4, 1.0))
    behaviour = Bounded(GoTo(context_of(PLAN, world), Pose(3.5, 2.4, -2.0)), 100.0)
    assert behaviour.planned_path() is None
    for observation, _ in steps(behaviour, world, seconds=0.5):
        pass
    path = behaviour.planned_path()
    assert (path[0].tolist(), path[-1].tolist()) == (approx([0.4, 0.4], abs=0.02), approx([3.5, 2.4], abs=0.02))
    behaviour.stand_by(observation)
    assert behaviour.planned_path() is None


# --- the message ------------------------------------------------------------------------------------------------------

def test_each_pose_of_the_message_faces_the_next_one():
    told = plan_topic.message(np.array([(1.0, 1.0), (2.0, 1.0), (2.0, 0.0)]), NOW)
    assert (told.header.frame_id, told.header.stamp) == ('map', NOW)
    assert [(one.pose.position.x, one.pose.position.y) for one in told.poses] == [(1.0, 1.0), (2.0, 1.0), (2.0, 0.0)]
    assert [heading(one.pose.orientation) for one in told.poses] == approx([0.0, -0.5 * math.pi, -0.5 * math.pi])
    assert {(one.header.frame_id, one.header.stamp) for one in told.poses} == {('map', NOW)}


@pytest.mark.parametrize('path', [None, np.empty((0, 2)), np.array([(1.0, 2.0)])])
def test_no_plan_is_a_message_without_poses(path):
    assert plan_topic.message(path, NOW).poses == []


def test_many_corners_become_few_within_a_centimetre():
    angles = np.linspace(0.0, 6.0, 3000)
    path = np.stack([2.0 * np.cos(angles), 2.0 * np.sin(angles)], axis=1)
    told = np.array([(one.pose.position.x, one.pose.position.y) for one in plan_topic.message(path, NOW).poses])
    assert len(told) < 100 and told[[0, -1]].tolist() == path[[0, -1]].tolist()
    assert max(distance(told, point) for point in path) < 0.0101


def test_only_another_plan_is_published(monkeypatch):
    told = []
    monkeypatch.setattr(rospy.Time, 'now', lambda: NOW)
    monkeypatch.setattr(plan_topic.rospy, 'Publisher', lambda *args, **kwargs: type(
        'Publisher', (), {'publish': lambda self, message: told.append(len(message.poses))})())
    topic = plan_topic.PlanTopic('rumba')
    path, other = np.array([(0.0, 0.0), (1.0, 0.0)]), np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])
    for shown in (None, path, path, other, other, None, None):
        topic.show(shown, None)
    assert told == [0, 2, 3, 0]
