"""A robot that cannot move, whatever it tries, gives up."""

import pytest
from drivers import context_of
from rooms import quiet, room

from rumba_cleaning.behaviour import Observation, Status
from rumba_cleaning.behaviours.standstill import LONGEST, NEAR, Standstill
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.strategies.boustrophedon import Boustrophedon
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

HERE = Pose(1.0, 1.0, 0.3)


def test_time_at_a_place_begins_again_at_the_next_one():
    standstill = Standstill()
    for number in range(5):
        standstill.watch(HERE._replace(x=1.0 + 0.2 * NEAR * number), 0.5)
    assert standstill.time == pytest.approx(2.0)
    standstill.watch(HERE._replace(x=1.0 + 1.1 * NEAR), 0.5)
    assert standstill.time == 0.0


def test_a_robot_that_is_jammed_gives_up_cleaning():
    """Its route goes on each time that it has turned in vain, and no bumper tells of anything."""
    plan = room(4.0, 3.0)
    context = context_of(plan, World(plan, quiet()))
    context.swept.begin(HERE.x, HERE.y)
    behaviour, steps = Boustrophedon(context), 0
    while behaviour.status is Status.RUNNING and steps < 20 * LONGEST:
        behaviour.step(Observation(0.1, HERE))
        steps += 1
    assert (behaviour.status, behaviour.outcome) == (Status.FAILED, Outcome.BLOCKED)
    assert behaviour.message == 'stuck: has not got away from one place for 300 s'
    assert steps == pytest.approx(10 * LONGEST, abs=5)
