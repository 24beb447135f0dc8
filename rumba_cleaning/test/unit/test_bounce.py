"""bounce goes ahead, backs off from what it touches, turns away from it, and so gets about a room."""

import math

import numpy as np
import pytest
from drivers import run
from rooms import quiet, room

from rumba_cleaning.behaviour import Command, Observation
from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

HERE = Pose(0.0, 0.0, 0.0)
LEFT, RIGHT, BOTH = (True, False), (False, True), (True, True)
DT = 0.1


def answers(bounce, count, **observed):
    """What it commands at each of so many observations."""
    return [bounce.step(Observation(DT, HERE, **observed)) for _ in range(count)]


def turn_after(bumper=(False, False), cliffs=(False,) * 4, seed=1):
    """The turn rates that it commands after one contact or cliff, until it goes ahead again."""
    bounce = Bounce(np.random.default_rng(seed))
    assert bounce.step(Observation(DT, HERE, bumper=bumper, cliffs=cliffs)).v < 0.0
    rates = []
    for command in answers(bounce, 100):
        if command.v > 0.0:
            return rates
        rates.append(command.w)
    raise AssertionError('it never goes ahead again')


def test_it_goes_straight_ahead_with_brushes_down_while_nothing_is_in_the_way():
    assert answers(Bounce(np.random.default_rng(1)), 50) == [Command(0.3, 0.0, False)] * 50


@pytest.mark.parametrize('contact, sign', [
    (dict(bumper=LEFT), -1.0), (dict(bumper=RIGHT), 1.0),
    (dict(cliffs=(True, False, False, False)), -1.0), (dict(cliffs=(False, False, True, False)), 1.0)])
def test_it_turns_away_from_the_side_of_the_contact(contact, sign):
    turning = [rate for rate in turn_after(**contact) if rate]
    assert turning == [sign * Bounce.TURN_RATE] * len(turning)
    assert Bounce.TURNS[0] - 0.2 <= len(turning) * DT * Bounce.TURN_RATE <= Bounce.TURNS[1] + 0.2


def test_straight_ahead_it_turns_to_either_side_at_random():
    assert {np.sign(sum(turn_after(bumper=BOTH, seed=seed))) for seed in range(20)} == {-1.0, 1.0}


def test_restarted_it_goes_ahead():
    bounce = Bounce(np.random.default_rng(1))
    answers(bounce, 1, bumper=BOTH)
    bounce.restart()
    assert answers(bounce, 1)[0].v == 0.3


def test_in_ten_minutes_it_cleans_most_of_an_empty_room():
    world = World(room(4.0, 3.0, 0.05), seed=3)
    robot = world.spawn('rumba')
    bounce = Bounce(np.random.default_rng(3))
    run(bounce, world)
    assert world.floor.coverage > 0.8 and robot.bumps > 50


def test_it_turns_away_from_stairs_of_the_plan_before_the_sensors_see_them():
    plan = room(4.0, 3.0, 0.02, cliff=(0.0, 2.0, 4.0, 3.0), start=Pose(1.0, 1.0, 0.0))
    ground = Ground(plan, quiet())
    for theta, sign in ((0.4, -1.0), (math.pi - 0.4, 1.0)):
        bounce = Bounce(np.random.default_rng(1), ground=ground)
        assert bounce.step(Observation(DT, Pose(2.0, 1.7, theta))).v > 0.0
        near = Observation(DT, Pose(2.0, 1.77, theta))
        assert bounce.step(near).v < 0.0
        turns = [command.w for command in (bounce.step(near) for _ in range(15)) if command.w]
        assert turns and all(turn * sign > 0.0 for turn in turns)
    away = Bounce(np.random.default_rng(1), ground=ground)
    assert away.step(Observation(DT, Pose(2.0, 1.77, -0.4))).v > 0.0
