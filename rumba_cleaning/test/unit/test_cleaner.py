"""The parts of the cleaner's node that need no master: settings, wheels and brushes, goals, the way to a position."""

import math
import queue
import time
import types

import numpy as np
import pytest
import rospy
from rooms import crooked, quiet, room

from rumba_cleaning.behaviour import Command
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner import activities, actuators, settings
from rumba_cleaning.ros.cleaner.go_to_position import velocity_toward
from rumba_cleaning.ros.cleaner.settings import Settings
from rumba_msg.msg import CleanGoal, CleaningStatus, DockGoal, GoToGoal
from rumba_sim.model.errors import ConfigError, MapError
from rumba_sim.model.geometry import Pose, compose
from rumba_sim.ros.common import maps

TARGET = Pose(3.5, 2.4, -2.0)


def context(plan, **config):
    """A context of a quiet robot."""
    return Context(plan, quiet(), CleaningConfig(**config))


# --- settings and surroundings ------------------------------------------------------------------------------------

def test_settings_hold_those_of_cleaning():
    settings = Settings(speed=0.2, strategy='bounce', robot='rumba2')
    assert settings.cleaning == CleaningConfig(speed=0.2, strategy='bounce')


@pytest.mark.parametrize('robot', ['', '/rumba', 'a/b', '2', 'a b'])
def test_what_is_no_name_of_a_robot_is_refused(robot):
    with pytest.raises(ConfigError, match=r'^robot is .*: must be letters, digits and _, beginning with a letter$'):
        Settings(robot=robot)


def test_the_robot_is_that_of_the_simulator_its_file_and_its_parameters(monkeypatch, tmp_path):
    file = tmp_path / 'robot.yaml'
    file.write_text('drive: {radius: 0.2, max_speed: 0.4}\nspeed: 5.0\n')
    parameters = {'config': str(file), 'drive': {'max_speed': 0.3}, 'battery': {'drain': 7}, 'map': 'studio'}
    monkeypatch.setattr(settings.rospy, 'get_param', lambda name, _: {'body': parameters}[name])
    found = settings.robot_of_simulator('body')
    assert (found.drive.radius, found.drive.max_speed, found.battery.drain) == (0.2, 0.3, 7.0)


def test_without_a_simulator_a_map_must_be_named(monkeypatch):
    monkeypatch.setattr(maps.node, 'is_served', lambda _: False)
    monkeypatch.setattr(maps.rospy, 'is_shutdown', lambda: False)
    monkeypatch.setattr(maps, 'PATIENCE', 0.3)
    with pytest.raises(MapError, match=r'^no simulator tells its map, /simulator/floor_plan: start one, or name a map'):
        maps.map_of_simulator('simulator')


# --- wheels and brushes -------------------------------------------------------------------------------------------

def test_wheels_that_are_held_heed_no_command(monkeypatch):
    told = []
    monkeypatch.setattr(actuators.rospy, 'Publisher', lambda *_, **__: types.SimpleNamespace(
        publish=lambda twist: told.append((twist.linear.x, twist.angular.z))))
    wheels = actuators.Wheels('rumba')
    wheels.drive(Command(0.2, -1.0))
    wheels.hold()
    wheels.drive(Command(0.3, 0.0))
    wheels.release()
    wheels.drive(Command(0.1, 0.5))
    wheels.stop()
    assert told == [(0.2, -1.0), (0.0, 0.0), (0.1, 0.5), (0.0, 0.0)]


def test_brushes_are_asked_for_what_is_new_and_again_where_that_failed(monkeypatch):
    asked, failures = queue.Queue(), [rospy.ServiceException('no')]

    def serve(are_up):
        asked.put(are_up)
        if failures and are_up:
            raise failures.pop()
    monkeypatch.setattr(actuators.rospy, 'ServiceProxy', lambda *_: serve)
    monkeypatch.setattr(actuators.rospy, 'is_shutdown', lambda: False)
    monkeypatch.setattr(actuators.rospy, 'logwarn_throttle', lambda *_: None)
    brushes = actuators.Brushes('rumba')
    for are_up in (False, False, True):
        brushes.want(are_up)
    assert [asked.get(timeout=5.0), asked.get(timeout=5.0)] == [False, True]
    end = time.monotonic() + 5.0
    while asked.empty():
        assert time.monotonic() < end
        brushes.want(True)
    assert asked.get(timeout=5.0) is True
    brushes.want(True)
    brushes.forget()
    brushes.want(True)
    assert asked.get(timeout=5.0) is True
    assert asked.empty()


# --- goals --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('time_limit, begins', [(0.0, 600.0), (5.0, 5.0)])
def test_a_goal_has_its_time_limit_or_the_usual_one(time_limit, begins):
    plan = crooked(dock=Pose(3.8, 1.5, 0.0))
    activity = activities.Docking(context(plan), DockGoal(time_limit))
    assert activity.behaviour._time_limit == begins


def test_a_clean_goal_that_names_nothing_has_the_settings_of_the_node():
    mine = context(crooked(), strategy='spiral', target_coverage=0.5)
    activities.Cleaning(mine, CleanGoal())
    assert (mine.config.strategy, mine.config.target_coverage) == ('spiral', 0.5)
    activities.Cleaning(mine, CleanGoal('bounce', 0.25, 0.0))
    assert (mine.config.strategy, mine.config.target_coverage) == ('bounce', 0.25)


def test_the_report_tells_way_charges_and_floor():
    activity = activities.Cleaning(context(crooked()), CleanGoal())
    report = activity.report(CleaningStatus(distance=2.0), CleaningStatus(distance=5.0, coverage=0.987))
    assert report == ', 3.0 m, 0 charges; the floor is 98.7 % clean'
    assert activity.report(None, CleaningStatus()) == ', 0 charges'


def test_a_target_must_be_finite_but_for_its_heading():
    goal = GoToGoal()
    goal.target.x, goal.target.y, goal.target.theta = 1.0, 1.0, math.nan
    activities.GoingTo(context(crooked()), goal)
    goal.target.theta = math.inf
    with pytest.raises(MapError, match=r'^target \(1\.0, 1\.0, inf\): must be finite numbers$'):
        activities.GoingTo(context(crooked()), goal)


# --- the way to a position ----------------------------------------------------------------------------------------

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
    (Pose(3.5, 1.0, 0.0), r'^no way from \(0\.50, 0\.50\) to \(3\.50, 1\.00\) m$')])
def test_where_no_velocity_leads_there_is_an_error(target, message):
    plan = room(4.0, 3.0, boxes=((1.2, 0.4, 1.5, 0.9), (2.0, -1.0, 2.1, 4.0)))
    with pytest.raises(MapError, match=message):
        velocity_toward(context(plan), Pose(0.5, 0.5, 0.0), target)
