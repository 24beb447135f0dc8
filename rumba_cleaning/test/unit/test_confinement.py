"""A robot that does not get out of a small area gives up, and does not go on for ever."""

import math

import pytest
from drivers import context_of
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import Status
from rumba_cleaning.control import steps
from rumba_cleaning.mission import confinement
from rumba_cleaning.mission.confinement import AREA, CLEANING, RETURNING, Confinement
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

HERE = Pose(2.0, 1.5, 0.0)
PLAN = room(4.0, 3.0, dock=Pose(4.0 - RADIUS - 0.01, 1.5, 0.0))
PERIOD = 0.5  # [s]


def watched(poses, seconds):
    """What has watched a robot that is at some poses in turn."""
    found = Confinement()
    for number in range(int(seconds / PERIOD)):
        found.watch(poses[number % len(poses)], PERIOD)
    return found


def test_who_drives_to_and_fro_in_a_small_area_is_confined_and_who_gets_farther_is_not():
    near, far = [HERE, HERE._replace(x=HERE.x + 0.9 * AREA)], [HERE, HERE._replace(y=HERE.y + 1.1 * AREA)]
    assert not watched(near, CLEANING).is_hopeless
    assert watched(near, CLEANING + 1.0).is_hopeless
    assert not watched(far, 2.0 * CLEANING).is_hopeless


def test_who_was_given_up_has_less_time_to_get_home_unless_it_gets_away():
    found = watched([HERE], CLEANING + 1.0)
    found.rest()
    found.is_known = True
    for _ in range(int(RETURNING / PERIOD) + 1):
        found.watch(HERE, PERIOD)
    assert found.is_hopeless
    found.watch(HERE._replace(x=HERE.x + 2.0 * AREA), PERIOD)
    assert not found.is_hopeless and not found.is_known


@pytest.mark.parametrize('radius', [0.3, 0.55])
@pytest.mark.parametrize('strategy', ['boustrophedon', 'bounce'])
def test_the_mission_of_a_robot_in_a_cage_ends(radius, strategy):
    world = World(PLAN, quiet())
    world.spawn('rumba', HERE, brushes_up=True)
    for number in range(20):
        angle = 0.1 * math.pi * number
        world.add_obstacle(Obstacle(f'bar{number}', Pose(HERE.x + radius * math.cos(angle),
                                                         HERE.y + radius * math.sin(angle), 0.0), 0.3, 0.04))
    world.step()
    mission = Mission(context_of(PLAN, world), strategy, 0.99)
    for _ in steps(mission, world, seconds=CLEANING + RETURNING + 30.0):
        pass
    assert (mission.status, mission.outcome) == (Status.FAILED, Outcome.BLOCKED)
    assert mission.message.endswith(f'% swept: {confinement.REASON}')
