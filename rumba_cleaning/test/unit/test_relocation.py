"""A robot that is lost drives about with care, and goes on once it knows its place."""

import math

import pytest
from rooms import crooked

from rumba_cleaning.behaviour import CERTAIN, STOP, UNKNOWN, Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours import relocation
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.relocation import Relocation
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import CONTROL_TICKS, STEP_RATE, act
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.pose_source import Belief, truth
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

HERE = Pose(2.0, 1.3, 0.0)
LOST = ((0.25, 0.0, 0.0), (0.0, 0.25, 0.0), (0.0, 0.0, 0.07))


def context_of(plan):
    """What a robot of the usual kind knows."""
    return Context(plan, RobotConfig(), CleaningConfig(), seed=5)


@pytest.mark.parametrize('covariance, is_lost', [
    (CERTAIN, False), (((0.08, 0.0, 0.0), (0.0, 0.08, 0.0), (0.0, 0.0, 0.2)), False),
    (((0.1, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), True),
    (((0.0, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.0)), True),
    (((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.3)), True), (UNKNOWN, True),
    (((math.nan, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), True),
    (((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, math.nan)), True)])
def test_a_pose_that_is_too_uncertain_means_lost(covariance, is_lost):
    assert Observation(0.1, HERE, covariance=covariance).is_lost is is_lost


def test_it_goes_slowly_ahead_with_the_brushes_up_and_backs_off_from_what_it_meets():
    lost = Relocation(context_of(crooked()))
    ahead = Observation(0.1, HERE, covariance=LOST)
    assert lost.command(ahead) == Command(relocation.SPEED, 0.0, brushes_up=True)
    assert lost.command(ahead._replace(bumper=(True, False))).v < 0.0
    assert lost.command(ahead._replace(cliffs=(False, True, False, False))).v < 0.0


def test_it_leaves_the_dock_backward():
    lost = Relocation(context_of(crooked()))
    docked = Observation(0.1, HERE, is_docked=True, covariance=LOST)
    assert lost.command(docked) == Command(-relocation.SPEED, 0.0, brushes_up=True)
    commands = [lost.command(docked._replace(is_docked=False)) for _ in range(40)]
    steps = 10.0 * relocation.BACK / relocation.SPEED
    assert sum(command.v < 0.0 for command in commands) == pytest.approx(steps, abs=1)


def test_without_any_pose_it_stands_still():
    assert Relocation(context_of(crooked())).command(Observation(0.1, HERE, covariance=UNKNOWN)) == STOP


@pytest.mark.parametrize('deviation, turned, silence, is_lost', [
    (0.2, 0.4, 0.9, False), (0.2, 0.0, 1.1, True), (0.0, 0.4, 1.1, True), (0.05, 0.2, 60.0, False)])
def test_a_pose_must_be_better_while_the_laser_is_silent(deviation, turned, silence, is_lost):
    covariance = (deviation ** 2, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, turned ** 2)
    assert Observation(0.1, HERE, covariance=covariance, silence=silence).is_lost is is_lost


def test_while_the_laser_is_silent_it_waits_and_says_for_how_long():
    lost = Relocation(context_of(crooked()))
    for number in range(40):
        silence = 3.0 + 0.1 * number
        assert lost.command(Observation(0.1, HERE, is_docked=number == 3, covariance=LOST, silence=silence)) == STOP
        assert lost.message == f'the laser has been silent for {silence:.0f} s: waits for it'
    assert lost.command(Observation(0.1, HERE, covariance=LOST)).v == relocation.SPEED
    assert lost.message == relocation.MESSAGE


class Ahead(Behaviour):
    """Goes ahead with the brushes down, and counts what it notes meanwhile."""

    noted = 0

    def update(self, observation):
        """Ahead."""
        return Command(0.3, 0.0)

    def take_note(self, observation):
        """Count."""
        self.noted += 1


def test_a_behaviour_stands_by_while_the_robot_is_lost():
    behaviour = Bounded(Ahead(), 1000.0, context_of(crooked()))
    known = Observation(0.1, HERE)
    assert behaviour.step(known) == Command(0.3, 0.0)
    for _ in range(5):
        assert behaviour.step(known._replace(covariance=LOST)).brushes_up
    assert (behaviour.behaviour.noted, behaviour.message) == (5, relocation.MESSAGE)
    assert behaviour.step(known) == Command(0.3, 0.0)


def test_a_behaviour_goes_on_by_odometry_while_that_is_certain_and_says_that_the_laser_is_silent():
    behaviour = Bounded(Ahead(), 100.0, context_of(crooked()))
    assert behaviour.step(Observation(0.1, HERE, silence=2.0)) == Command(0.3, 0.0)
    assert behaviour.message == 'the laser has been silent for 2 s'
    assert behaviour.step(Observation(0.1, HERE)) == Command(0.3, 0.0) and behaviour.message == ''


@pytest.mark.parametrize('covariance, end', [(CERTAIN, ''), (LOST, ': waits for it')])
def test_a_mission_says_once_that_the_laser_is_silent(covariance, end):
    context = context_of(crooked())
    behaviour = Bounded(Mission(context, 'boustrophedon', 0.9), 1000.0)  # as the cleaner has it
    for _ in range(5):
        behaviour.step(Observation(0.1, HERE, covariance=covariance, silence=2.0))
    assert behaviour.message.count('silent') == 1
    assert behaviour.message.endswith('the laser has been silent for 2 s' + end)


def test_a_robot_that_stays_lost_gives_up():
    behaviour = Bounded(Ahead(), 1000.0, context_of(crooked()))
    steps = 0
    while behaviour.status is Status.RUNNING:
        behaviour.step(Observation(0.1, HERE, covariance=LOST))
        steps += 1
    assert (behaviour.outcome, behaviour.message) == (Outcome.LOST, relocation.GIVEN_UP)
    assert steps == pytest.approx(10 * relocation.PATIENCE, abs=2)


def run_mission(is_lost_at, seconds=400.0):
    """A mission of a robot that does not know its place at some times; returns it, and the world."""
    plan = crooked(0.05, dock=Pose(3.7, 1.2, 0.0))
    world = World(plan, RobotConfig(), STEP_RATE, seed=2)
    world.spawn('rumba', brushes_up=True)
    world.step()
    mission = Mission(context_of(plan), 'boustrophedon', 0.9)

    def source(world, name):
        belief = truth(world, name)
        return Belief(Pose(0.5, 0.5, 0.0), LOST) if is_lost_at(world.time) else belief

    while mission.status is Status.RUNNING and world.time < seconds:
        _, command = act(mission, world, 'rumba', CONTROL_TICKS / STEP_RATE, source)
        assert command.brushes_up or not is_lost_at(world.time)
        world.step(CONTROL_TICKS)
    return mission, world


def test_a_mission_goes_on_after_the_robot_was_lost_and_keeps_its_coverage():
    mission, world = run_mission(lambda time: 20.0 < time < 35.0 or 50.0 < time < 52.0)
    assert mission.status is Status.SUCCEEDED and world.floor.coverage >= 0.9
    assert world.robots['rumba'].is_docked


def test_a_mission_of_a_robot_that_stays_lost_ends_with_a_reason():
    mission, world = run_mission(lambda time: time > 20.0)
    assert (mission.outcome, mission.message, mission.state) == (Outcome.LOST, relocation.GIVEN_UP, State.STRANDED)
    assert world.time == pytest.approx(20.0 + relocation.PATIENCE, abs=1.0)
