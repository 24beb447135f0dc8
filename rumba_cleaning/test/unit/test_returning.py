"""A robot without a dock ends where it began, or at a pose."""

import pytest
from drivers import context_of, run
from rooms import crooked, quiet

from rumba_cleaning.mission.returning import ReturningMission
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.simulation.world import World

START, HOME = Pose(0.5, 0.5, 1.0), Pose(1.0, 0.8, -2.0)


def ended(home=None, start=START, target=0.9):
    """The mission and the pose at its end."""
    plan = crooked()
    world = World(plan, quiet())
    world.spawn('rumba', start, brushes_up=True)
    world.step()
    context = context_of(plan, world)
    context.has_dock, context.end = False, home
    mission = ReturningMission(context, 'boustrophedon', target)
    run(mission, world, seconds=3000.0)
    return mission, world.robots['rumba'].pose


@pytest.mark.parametrize('home, end', [(None, START), (HOME, HOME)])
def test_it_ends_there_facing_as_it_should(home, end):
    mission, pose = ended(home)
    assert mission.outcome is Outcome.SUCCEEDED
    assert hypot(pose.x - end.x, pose.y - end.y) < 0.03
    assert abs(pose.theta - end.theta) < 0.05
    assert mission.message.endswith('% swept')


def test_a_place_in_a_wall_is_told_and_the_floor_is_clean_all_the_same():
    mission, _ = ended(Pose(0.0, 0.0, 0.0))
    assert mission.outcome is Outcome.SUCCEEDED
    assert '; not back: target' in mission.message
