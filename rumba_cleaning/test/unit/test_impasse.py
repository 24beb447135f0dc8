"""Where a robot is stopped again and again, the way ahead of it is closed."""

import math

from drivers import context_of
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviours.impasse import NEAR, OFTEN, Impasse
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

PLAN = room(4.0, 3.0)


def test_stopped_often_at_one_place_a_robot_takes_the_way_ahead_to_be_closed():
    context, impasse = context_of(PLAN, World(PLAN, quiet())), Impasse()
    for turn in range(OFTEN - 1):
        impasse.stop(context, Pose(2.0, 1.5, 0.2 * turn))
    assert not context.ground.has_marks
    impasse.stop(context, Pose(2.0, 1.5, 0.5 * math.pi))
    assert context.ground.clearance[context.ground.node(2.0, 1.5 + RADIUS)] < RADIUS < 1.0
    assert context.ground.clearance[context.ground.node(2.0, 1.5 - RADIUS)] > RADIUS


def test_a_robot_that_gets_on_is_in_no_impasse():
    context, impasse = context_of(PLAN, World(PLAN, quiet())), Impasse()
    for number in range(3 * OFTEN):
        impasse.stop(context, Pose(0.5 + 0.6 * NEAR * number, 1.5, 0.0))
    assert not context.ground.has_marks
