"""Whether a mission that gave up begins again."""

import pytest
from drivers import context_of
from rooms import quiet, room

from rumba_cleaning.mission.second_try import SecondTry
from rumba_sim.model.geometry import Pose
from rumba_sim.model.world import World

PLAN = room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 1.0), (2.4, 1.9, 2.6, 3.0)], start=Pose(1.0, 1.0, 0.0))


@pytest.mark.parametrize('met', [False, True])
def test_who_met_obstacles_and_has_much_left_begins_again_but_only_once(met):
    context = context_of(PLAN, World(PLAN, quiet()))
    context.swept.begin(1.0, 1.0)
    second_try = SecondTry(context)
    assert not second_try.is_worth_it
    for y in (1.2, 1.45, 1.7) if met else ():
        context.ground.mark(2.5, y, 0.15, stays=True)
    second_try.give_up(PLAN.start)
    assert second_try.is_worth_it == met
    second_try.begin()
    second_try.give_up(PLAN.start)
    assert not second_try.is_worth_it
