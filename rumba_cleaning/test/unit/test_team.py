"""Robots that share a floor share its work, know what all of them swept, and get home, at one dock or at several."""

import itertools
import math

import numpy as np
import pytest
from pytest import approx
from rooms import RADIUS, quiet, room
from teams import Crew

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.mates import Task
from rumba_cleaning.mission import mission as missions
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.planning.common import effort
from rumba_cleaning.planning.search import improvement
from rumba_cleaning.planning.team import helping
from rumba_cleaning.strategies.boustrophedon import MORE
from rumba_sim.model.common.geometry import Pose

WALL = (3.0, 0.0, 3.1, 2.0)  # with a door of 1 m above it
RIGHT, LEFT = Pose(6.1 - RADIUS - 0.01, 1.2, 0.0), Pose(RADIUS + 0.01, 1.2, math.pi)
TWO_ROOMS = room(6.1, 3.0, boxes=[WALL], dock=RIGHT, further_docks=[LEFT])
ONE_DOCK = room(6.1, 3.0, boxes=[WALL], dock=RIGHT)


@pytest.fixture(scope='module')
def alone():
    crew = Crew(TWO_ROOMS, quiet(), 1)
    return crew.run()


@pytest.fixture(scope='module')
def pair():
    crew = Crew(TWO_ROOMS, quiet())
    return crew, crew.run()


def test_two_robots_need_little_more_than_half_the_time_of_one(alone, pair):
    crew, seconds = pair
    assert [mission.outcome for mission in crew.missions.values()] == [Outcome.SUCCEEDED] * 2
    assert seconds < 0.65 * alone


def test_each_goes_home_to_the_dock_where_it_began(pair):
    crew, _ = pair
    for robot, dock in zip(crew.world.robots.values(), TWO_ROOMS.docks):
        assert robot.is_docked and math.hypot(robot.pose.x - dock.x, robot.pose.y - dock.y) < 0.1


def test_each_robot_knows_what_both_have_swept(pair):
    crew, _ = pair
    coverage = crew.world.floor.coverage
    assert coverage >= 0.98
    assert [context.swept.coverage for context in crew.contexts.values()] == approx([coverage] * 2, abs=2e-4)


@pytest.mark.thorough
def test_a_team_repeats_bit_for_bit(pair):
    crew, _ = pair
    again = Crew(TWO_ROOMS, quiet())
    again.run()
    assert again.world.digest() == crew.world.digest()


def middle(path):
    """The centre of mass of a path [m]."""
    return np.average(0.5 * (path[:-1] + path[1:]), axis=0, weights=np.hypot(*np.diff(path, axis=0).T))


def test_each_takes_a_share_of_the_floor_and_nobody_plans_what_another_does():
    crew = Crew(TWO_ROOMS, quiet())
    times = crew.plan('rumba', 'rumba2')
    assert max(times) < 1.4 * min(times)
    middles = [middle(mission.plan_ahead().route.waypoints) for mission in crew.missions.values()]
    assert np.hypot(*(middles[0] - middles[1])) > 1.5


@pytest.mark.parametrize('mate, left, right', [(0.5, 1.6, 6.0), (5.5, 0.0, 4.4)])
def test_a_robot_leaves_to_a_mate_what_is_near_it(mate, left, right):
    walls = [(x, y, x + 0.1, y + 0.8) for x in (1.9, 4.0) for y in (0.0, 1.6)]
    rooms = room(6.0, 2.4, 0.05, walls)
    crew = Crew(rooms, quiet(), poses=[Pose(3.0, 1.2, 0.0), Pose(mate, 1.2, 0.0)])
    crew.plan('rumba')
    x = crew.missions['rumba'].plan_ahead().route.waypoints[:, 0]
    assert left < x.min() and x.max() < right


def test_the_first_of_three_takes_somewhat_more_than_a_third():
    crew = Crew(TWO_ROOMS, quiet(), 3, poses=[Pose(0.6, 0.6, 0.0), Pose(2.4, 2.4, 0.0), Pose(5.5, 2.4, 0.0)])
    times = crew.plan('rumba', 'rumba2', 'rumba3')
    whole, = Crew(TWO_ROOMS, quiet(), 1, poses=[Pose(0.6, 0.6, 0.0)]).plan('rumba')
    assert times[0] == approx(MORE / 3.0 * whole, rel=0.1) and max(times) < 1.6 * min(times)


@pytest.mark.thorough
def test_a_robot_helps_a_mate_although_the_target_is_met_but_for_what_poses_may_be_off(monkeypatch):
    monkeypatch.setattr(missions, 'EXACT', 0.5)  # nobody is ever sure to have met the target
    monkeypatch.setattr(improvement, 'MARGIN', 0.45)  # their plans lead over almost all of the floor
    crew = Crew(TWO_ROOMS, quiet(), target=0.5)
    crew.plan('rumba', 'rumba2')
    crew.silent.add('rumba2')
    while crew.world.time < 60.0:
        crew.step()
    crew.silent.clear()
    first = crew.missions['rumba']
    number = first.plan_ahead().plan
    while first.state is State.CLEANING and (first.plan_ahead() is None or first.plan_ahead().plan == number):
        crew.step()
    assert crew.contexts['rumba'].swept.coverage > 0.5
    assert first.state is State.CLEANING and first.plan_ahead().relief.mate == 'rumba2'


@pytest.mark.thorough
def test_who_waits_on_its_dock_for_mates_that_find_nothing_more_ends_there(monkeypatch):
    monkeypatch.setattr(missions, 'EXACT', 0.5)  # nobody is ever sure to have met the target
    monkeypatch.setattr(helping, 'LEAST', math.inf)  # and who comes late finds no work, ...
    monkeypatch.setattr(effort, 'WORK', 0.0)  # ... nor corners that a mate will leave
    crew = Crew(TWO_ROOMS, quiet())
    crew.silent.add('rumba2')
    crew.plan('rumba')
    crew.silent.clear()
    states = []
    while crew.missions['rumba2'].status is Status.RUNNING:
        crew.step()
        states.append(crew.missions['rumba2'].state)
    assert crew.missions['rumba2'].outcome is Outcome.SUCCEEDED
    assert [state for state, _ in itertools.groupby(states)] == [
        State.IDLE, State.UNDOCKING, State.CLEANING, State.RETURNING, State.DOCKING, State.CHARGING, State.RETURNING,
        State.IDLE]


def test_what_a_robot_leaves_that_falls_silent_is_cleaned_by_its_mate():
    crew = Crew(TWO_ROOMS, quiet())
    while crew.world.floor.coverage < 0.3:
        crew.step()
    crew.silent.add('rumba2')
    mate = crew.missions['rumba2'].report()._replace(task=Task.OFF, ahead=None)
    crew.contexts['rumba'].hear('rumba2', mate)
    crew.world.robots['rumba2'].command(0.0, 0.0, crew.world.tick)
    crew.run()
    assert crew.missions['rumba'].outcome in (Outcome.SUCCEEDED, Outcome.INCOMPLETE)
    assert crew.world.floor.coverage > 0.9


@pytest.mark.thorough
def test_who_comes_late_takes_over_about_half_of_what_its_mate_has_left():
    crew = Crew(TWO_ROOMS, quiet())
    crew.silent.add('rumba2')
    while crew.world.time < 60.0:
        crew.step()
    crew.silent.clear()
    first, second = crew.missions.values()
    while second.plan_ahead() is None or second.plan_ahead().relief is None:
        crew.step()
    before = first.plan_ahead()
    assert second.plan_ahead().relief[:2] == ('rumba', before.plan)
    crew.step()
    left, taken = first.plan_ahead().rest().times()[-1], second.plan_ahead().route.times()[-1]
    assert left == approx(taken, rel=0.25) and left + taken == approx(before.rest().times()[-1], rel=0.15)
    assert first.plan_ahead().plan != before.plan
    crew.run()
    assert [mission.outcome for mission in crew.missions.values()] == [Outcome.SUCCEEDED] * 2


def test_robots_meet_in_a_doorway_and_both_get_through():
    narrow = room(6.1, 3.0, boxes=[(3.0, 0.0, 3.1, 1.2), (3.0, 1.8, 3.1, 3.0)], dock=RIGHT, further_docks=[LEFT])
    crew = Crew(narrow, quiet(), poses=[Pose(1.0, 1.5, 0.0), Pose(5.0, 1.5, math.pi)])  # each far from its own dock
    crew.run()
    assert [mission.outcome for mission in crew.missions.values()] == [Outcome.SUCCEEDED] * 2
    assert all(robot.is_docked for robot in crew.world.robots.values())


# --- one dock for two ----------------------------------------------------------------------------------------------

def test_at_the_only_dock_the_second_robot_waits_apart_and_says_who_is_there():
    crew = Crew(ONE_DOCK, quiet())
    crew.run()
    ends = sorted(mission.message for mission in crew.missions.values())
    assert [mission.outcome for mission in crew.missions.values()] == [Outcome.SUCCEEDED] * 2
    assert sum(robot.is_docked for robot in crew.world.robots.values()) == 1
    assert any('the dock is taken by rumba' in end for end in ends)
    one, other = (robot.pose for robot in crew.world.robots.values())
    assert math.hypot(one.x - other.x, one.y - other.y) > 0.5


@pytest.mark.thorough
def test_robots_charge_one_after_the_other_at_the_only_dock():
    crew = Crew(ONE_DOCK, quiet(battery={'drain': 50.0}))
    states = {name: [] for name in crew.missions}
    while any(mission.status is Status.RUNNING for mission in crew.missions.values()):
        assert crew.world.time < 4000.0, {name: mission.message for name, mission in crew.missions.items()}
        crew.step()
        for name, mission in crew.missions.items():
            states[name].append(mission.state)
    assert [mission.outcome for mission in crew.missions.values()] == [Outcome.SUCCEEDED] * 2
    for name in crew.missions:
        assert State.CHARGING in [state for state, _ in itertools.groupby(states[name])]


def test_a_mate_that_only_passes_a_dock_does_not_occupy_it():
    plan = room(6.1, 3.0, dock=RIGHT, further_docks=[LEFT])
    crew = Crew(plan, quiet(), target=0.5)
    while not any(mission.state is State.RETURNING for mission in crew.missions.values()):
        crew.step()
    passing = crew.missions['rumba2'].report()._replace(pose=RIGHT, task=Task.RETURNING, ahead=None)
    crew.silent.add('rumba2')
    crew.contexts['rumba'].hear('rumba2', passing)
    crew.step()
    assert 'waiting for the dock' not in crew.missions['rumba'].message
    crew.contexts['rumba'].hear('rumba2', passing._replace(task=Task.DOCKED))
    crew.contexts['rumba'].hear('rumba3', passing._replace(pose=LEFT, task=Task.DOCKED))
    crew.step()
    assert crew.missions['rumba'].message == 'waiting for the dock, where rumba2 is'
