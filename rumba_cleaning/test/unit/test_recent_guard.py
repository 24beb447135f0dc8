"""What a robot without a map remembers of the floor, and what it takes for floor."""

import math

import numpy as np
import pytest
from rooms import quiet

from rumba_cleaning.behaviour import Command, Observation
from rumba_cleaning.behaviours.caution import WITH_MAP, WITHOUT_MAP
from rumba_cleaning.behaviours.departure import is_floor
from rumba_cleaning.behaviours.recent_guard import REMEMBERED, TURN, RecentGuard
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel.geometry import arc
from rumba_sim.model.robot_config import RobotConfig


def knowing_nothing():
    """What a robot without a map knows that was just put down."""
    return Context.without_map(quiet(), CleaningConfig())


def remembered(observations):
    """For how many of the observations after the first, which tells of a cliff, a robot remembers that."""
    knowledge = knowing_nothing()
    guard = RecentGuard(knowledge)
    for count, observation in enumerate(observations):
        guard.step(lambda _: Command(0.1, 0.0), observation)
        if not knowledge.footing.seen:
            return count
    raise AssertionError('it does not forget')


def straight(step, pressed_every=math.inf):
    """What a robot tells each centimetre; in each of so many steps something touches it."""
    is_pressed = step > 0 and step % pressed_every == 0
    return Observation(0.1, Pose(0.01 * step, 0.0, 0.0), bumper=(is_pressed, False),
                       cliffs=(step == 0, False, False, False))


def test_an_edge_is_remembered_for_two_metres_and_forgotten_after_four():
    assert 200 <= remembered(map(straight, range(500))) <= 401
    bounds = knowing_nothing().plan.bounds
    assert bounds.left < -REMEMBERED - 0.5 < REMEMBERED + 0.5 < bounds.right


def test_an_edge_is_forgotten_sooner_by_a_robot_that_touches_things_or_turns_on_the_spot():
    """Then its wheels tell it less well where it is: four contacts count as 0.8 m."""
    usual = remembered(map(straight, range(500)))
    assert remembered(straight(step, 5) for step in range(500)) <= usual / 4
    turns = [Observation(0.1, Pose(0.0, 0.0, 0.1 * step), cliffs=(step == 0, False, False, False))
             for step in range(2000)]
    wear_of_one = 0.1 * TURN * 0.5 * RobotConfig().drive.wheel_base
    assert REMEMBERED <= remembered(turns) * wear_of_one <= 2.0 * REMEMBERED + wear_of_one


def test_as_it_forgets_it_takes_no_floor_for_granted_that_neither_wheels_nor_sensors_passed():
    """Under its body, beside the way of its right wheel: only at its first place a person has put it."""
    knowledge = knowing_nothing()
    guard = RecentGuard(knowledge)

    def known_beside_the_way(end):
        return any(knowledge.footing.are_known(np.array([[0.01 * step, -0.16]]), 0) for step in range(end))
    guard.see(straight(1))
    assert known_beside_the_way(10)
    for step in range(2, 600):
        guard.see(straight(step))
    assert not known_beside_the_way(600)


@pytest.mark.parametrize('away', np.arange(-8.0, 8.1, 0.5))
def test_edges_that_were_seen_far_back_do_not_disturb_a_robot_that_forgets_them(away):
    knowledge = knowing_nothing()
    knowledge.begin_anew(Pose(0.0, 0.0, 0.0))
    knowledge.footing._see(0.5, -0.5)
    knowledge.begin_anew(Pose(away, away, 0.0), Pose(away - 0.1, away, 0.0))
    assert knowledge.footing.seen == []


def test_on_its_way_out_it_keeps_to_floor_that_it_knows_though_it_has_forgotten_the_edge():
    knowledge = knowing_nothing()
    assert is_floor(knowledge.footing, WITH_MAP, np.array([[3.0, 3.0]]))
    assert not is_floor(knowledge.footing, WITHOUT_MAP, np.array([[3.0, 3.0]]))


@pytest.mark.parametrize('w', [0.0, 0.5, 1.5])
def test_over_floor_that_it_has_not_seen_no_wheel_is_fast_in_a_bend_either(w):
    knowledge, pose, fastest = knowing_nothing(), Pose(0.0, 0.0, 0.0), []
    guard = RecentGuard(knowledge)
    for _ in range(15):
        v, turn = guard.step(lambda _: Command(0.3, w), Observation(0.1, pose))[:2]
        fastest.append(v + turn * 0.5 * knowledge.robot.drive.wheel_base)
        pose = Pose(*arc(*pose, 0.1 * v, 0.1 * turn))
    assert np.median(fastest) == pytest.approx(WITHOUT_MAP.safe_speed)
