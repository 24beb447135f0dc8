"""What the cleaner does for a goal, without a master."""

import math
import types

import pytest
from floors import context
from geometry_msgs.msg import Pose2D
from rooms import crooked

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.mission.stages import State
from rumba_cleaning.ros.cleaner.goals import activities
from rumba_msg.msg import CleanGoal, CleaningStatus, DockGoal, GoToGoal, MissionStatus, UndockGoal
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose


@pytest.mark.parametrize('time_limit, begins', [(0.0, 600.0), (5.0, 5.0)])
def test_a_goal_has_its_time_limit_or_the_usual_one(time_limit, begins):
    plan = crooked(dock=Pose(3.8, 1.5, 0.0))
    activity = activities.Docking(context(plan), DockGoal(time_limit))
    assert activity.behaviour._time_limit == begins


def test_a_clean_goal_that_names_nothing_has_the_settings_of_the_node(monkeypatch):
    mine = context(crooked(), strategy='spiral', target_coverage=0.5)
    monkeypatch.setattr(activities, 'Mission', lambda _, strategy, target: types.SimpleNamespace(
        strategy=strategy, target=target))
    activity = activities.Cleaning.of_goal(mine, CleanGoal())
    assert (activity.strategy, activity.behaviour.behaviour.target) == ('spiral', 0.5)
    activity = activities.Cleaning.of_goal(mine, CleanGoal(strategy='bounce', target_coverage=0.25))
    assert (activity.strategy, activity.behaviour.behaviour.target) == ('bounce', 0.25)


@pytest.mark.parametrize('make, goal', [
    (activities.Cleaning.of_goal, CleanGoal()), (activities.Docking, DockGoal()), (activities.Undocking, UndockGoal()),
    (activities.GoingTo, GoToGoal(Pose2D(1.0, 1.0, 0.0), 0.0))])
def test_feedback_and_state_are_there_before_the_first_step_since_a_person_may_drive_then(make, goal):
    activity = make(context(crooked(dock=Pose(3.8, 1.5, 0.0))), goal)
    senses = types.SimpleNamespace(cleaning=None, look=lambda: None, pose=lambda: None)
    feedback = activity.feedback(senses, MissionStatus())
    assert math.isnan(getattr(feedback, 'distance_remaining', math.nan)) or feedback.distance_remaining == 0.4
    assert activity.state in State


def test_a_resumed_cleaning_has_the_same_mission_and_its_own_time_limit():
    first = activities.Cleaning.of_goal(context(crooked()), CleanGoal(strategy='spiral', time_limit=5.0))
    mission, observation = first.behaviour.behaviour, Observation(0.1, Pose(1.0, 1.0, 0.0))
    first.begin()
    first.behaviour.step(observation)
    mission.charges = 2  # part of the memory
    first.behaviour.stop()
    second = first.resumed(7.0)
    second.begin()
    second.behaviour.step(observation)
    assert second.behaviour.behaviour is mission
    assert (second.strategy, second.behaviour._time_limit, mission.charges) == ('spiral', 7.0, 2)
    with pytest.raises(ConfigError, match='^time_limit is nan: must be a finite number'):
        first.resumed(math.nan)


def test_the_report_tells_distance_and_charges():
    activity = activities.Cleaning.of_goal(context(crooked()), CleanGoal())
    report = activity.report(CleaningStatus(distance=2.0), CleaningStatus(distance=5.0, coverage=0.987))
    assert report == ', 3.0 m, 0 charges'
    assert activity.report(None, CleaningStatus()) == ', 0 charges'


def test_a_target_must_be_finite_but_for_its_heading():
    goal = GoToGoal()
    goal.target.x, goal.target.y, goal.target.theta = 1.0, 1.0, math.nan
    activities.GoingTo(context(crooked()), goal)
    goal.target.theta = math.inf
    with pytest.raises(MapError, match=r'^target \(1\.0, 1\.0, inf\): must be finite numbers$'):
        activities.GoingTo(context(crooked()), goal)
