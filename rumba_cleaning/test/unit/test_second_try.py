"""Whether a mission that gave up begins again."""

import pytest
from drivers import context_of
from rooms import quiet, room

from rumba_cleaning.mission.second_try import SecondTry
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.sweep import Part
from rumba_sim.model.simulation.world import World

PLAN = room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 1.0), (2.4, 1.9, 2.6, 3.0)], start=Pose(1.0, 1.0, 0.0))


def shut_in():
    """What a robot knows that has swept nothing yet, and met things that shut it in."""
    context = context_of(PLAN, World(PLAN, quiet()))
    context.swept.begin(1.0, 1.0)
    for y in (1.2, 1.45, 1.7):
        context.ground.mark(2.5, y, 0.15, stays=True)
    return context


@pytest.mark.parametrize('met', [False, True])
def test_who_met_obstacles_and_has_much_left_begins_again_but_only_once(met):
    context = shut_in()
    if not met:
        context.forget_obstacles()
    second_try = SecondTry(context)
    assert not second_try.is_worth_it(PLAN.start)
    second_try.give_up()
    assert second_try.is_worth_it(PLAN.start) == met
    second_try.begin()
    second_try.give_up()
    assert not second_try.is_worth_it(PLAN.start)


@pytest.mark.parametrize('share, is_worth', [(0.94, True), (0.98, False)])
def test_who_is_home_and_has_little_left_to_clean_does_not_begin_again(monkeypatch, share, is_worth):
    context = shut_in()
    second_try = SecondTry(context)
    second_try.give_up()
    monkeypatch.setattr(context, 'beside_marks', lambda pose: Part(1.0, share))
    assert second_try.is_worth_it(PLAN.start) == is_worth


def test_a_robot_that_squeezes_past_what_shut_it_in_is_still_shut_in_by_what_it_knows():
    """Otherwise half of a flat behind a door that is nearly closed would not count in the verdict."""
    context = context_of(PLAN, World(PLAN, quiet()))
    context.swept.begin(1.0, 1.0)
    for y in (1.25, 1.65):  # 30 cm are left between them, and 37 cm if they are as small as they can be
        context.ground.mark(2.5, y, 0.05, stays=True)
    assert context.is_shut_in(PLAN.start) and context.is_cut_off(PLAN.start)
    context.ground.squeeze(True)
    assert context.is_shut_in(PLAN.start) and not context.is_cut_off(PLAN.start)
    assert not context.with_target(0.0).is_met_beside_obstacles(PLAN.start)
