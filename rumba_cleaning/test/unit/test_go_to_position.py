"""The service go_to_position: velocities and headings that lead to a target, call by call."""

import math

import numpy as np
import pytest
from floors import context
from rooms import crooked, room

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner.goals.go_to_position import Knowledge, heading_toward, velocity_toward
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.settings.robot_config import RobotConfig

TARGET = Pose(3.5, 2.4, -2.0)


def test_velocities_call_by_call_lead_to_the_target_around_what_is_in_the_way():
    mine, pose = context(crooked()), Pose(0.4, 0.4, 1.0)
    for _ in range(1000):
        v, w, message = velocity_toward(mine, pose, TARGET)
        if message == 'there':
            break
        assert abs(v) <= 0.5 and abs(w) <= 1.9 + 1e-9
        pose = compose(pose, Pose(0.1 * v, 0.0, 0.1 * w))
        assert mine.plan.safe_clearance_at(pose.x, pose.y) > mine.robot.drive.radius - 0.02
    assert (v, w, message) == (0.0, 0.0, 'there')
    assert math.hypot(pose.x - TARGET.x, pose.y - TARGET.y) < 0.02
    assert abs(pose.theta - TARGET.theta) < 0.03


def test_headings_and_speeds_call_by_call_lead_to_the_target_around_what_is_in_the_way():
    mine, pose, driven = context(crooked()), Pose(0.4, 0.4, 1.0), 0.0
    _, _, first = heading_toward(mine, pose, TARGET)
    for _ in range(1000):
        speed, heading, message = heading_toward(mine, pose, TARGET)
        assert -math.pi <= heading <= math.pi
        if message in ('turning', 'there'):
            break
        assert speed == -1.0
        pose = compose(Pose(pose.x, pose.y, heading), Pose(0.015 * speed, 0.0, 0.0))
        driven += 0.015
        assert mine.plan.safe_clearance_at(pose.x, pose.y) > mine.robot.drive.radius - 0.02
    assert math.hypot(pose.x - TARGET.x, pose.y - TARGET.y) < 0.02
    assert (speed, heading) == (0.0, TARGET.theta)
    way, *words = first.split()
    assert float(way) == pytest.approx(driven, rel=0.05) and words == ['m', 'to', 'go']
    assert heading_toward(mine, Pose(TARGET.x, TARGET.y, TARGET.theta + 2.0 * math.pi), TARGET) == (
        0.0, TARGET.theta, 'there')


def test_a_heading_points_away_from_the_target_as_in_the_lesson_whatever_the_robot_faces():
    mine = context(room(4.0, 3.0))
    for bearing in (3.0, 1.0, -1.0, -3.0):
        for theta in (0.0, 2.5):
            target = Pose(2.0 - math.cos(bearing), 1.5 - math.sin(bearing), 0.0)
            answer = heading_toward(mine, Pose(2.0, 1.5, theta), target)
            assert answer == (-1.0, pytest.approx(bearing, abs=0.02), '1.00 m to go')


def test_the_side_to_turn_to_is_the_nearer_one():
    mine = context(room(4.0, 3.0))
    for bearing in (2.0, 1.0, -1.0, -2.0):
        target = Pose(2.0 + math.cos(bearing), 1.5 + math.sin(bearing), 0.0)
        v, w, message = velocity_toward(mine, Pose(2.0, 1.5, 0.0), target)
        assert v == 0.0 and np.sign(w) == np.sign(bearing)
        assert message == '1.00 m to go'


@pytest.mark.parametrize('target, message', [
    (Pose(math.nan, 1.0, 0.0), 'must be finite numbers'), (Pose(1.0, 1.0, math.nan), 'must be finite numbers'),
    (Pose(1.35, 0.6, 0.0), 'does not fit'), (Pose(-3.0, 1.0, 0.0), 'lies outside the map'),
    (Pose(3.5, 1.0, 0.0), r'^no path from \(0\.50, 0\.50\) to \(3\.50, 1\.00\) m$')])
def test_a_target_that_cannot_be_reached_is_an_error(target, message):
    plan = room(4.0, 3.0, boxes=((1.2, 0.4, 1.5, 0.9), (2.0, -1.0, 2.1, 4.0)))
    for toward in (velocity_toward, heading_toward):
        with pytest.raises(MapError, match=message):
            toward(context(plan), Pose(0.5, 0.5, 0.0), target)


class Floors:
    """A workplace that says which plan and which robot there are now."""

    def __init__(self, plan, robot):
        self.now = plan, robot

    def look(self):
        """The plan and the robot."""
        return self.now


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
def test_what_it_knows_of_floor_and_robot_is_worked_out_once(resolution):
    plan, robot = room(2.0, 2.0, resolution), RobotConfig()
    floors = Floors(plan, robot)
    knowledge = Knowledge(floors, CleaningConfig())
    first = knowledge.context()
    assert knowledge.context() is first
    floors.now = plan, updated(robot, {'drive': {'radius': 0.1}}, 'small')
    second = knowledge.context()
    assert second is not first and second.robot.drive.radius == 0.1
    floors.now = room(3.0, 2.0, resolution), second.robot
    assert knowledge.context().plan.columns > second.plan.columns
