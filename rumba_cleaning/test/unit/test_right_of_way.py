"""Who gives way: the robot that comes later in the order, and only if the ways of both really meet."""

import math

import numpy as np
import pytest
from rooms import quiet, room

from rumba_cleaning.behaviour import STOP, Observation
from rumba_cleaning.behaviours.right_of_way import PATIENCE, SHUT_IN, RightOfWay
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.mates import Mates, Report, Task
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.route import Ahead, Route
from rumba_sim.model.common.geometry import Pose

PLAN = room(6.0, 4.0)
CORRIDOR = room(6.0, 0.5)
TEAM = ('rumba', 'rumba2')


def along(*points):
    """A way over points [m]."""
    route = Route(np.array(points, float), np.full(len(points) - 1, 0.3))
    return Ahead(route, route.length)


def command(name, pose, ahead, mate, task=Task.SWEEPING, mates_way=None, plan=PLAN, steps=1, bumper=(False, False)):
    """What a robot of the team does while its mate is at a pose; the last of some steps at one place.

    The bumper is pressed in the last one only.
    """
    context = Context(plan, quiet(), CleaningConfig(), mates=Mates(name, TEAM))
    other = TEAM[1 - TEAM.index(name)]
    context.mates.hear(other, Report(mate, True, task, mates_way))
    controller = RightOfWay(context)
    for _ in range(steps - 1):
        controller.command(Observation(0.1, pose), ahead)
    return controller.command(Observation(0.1, pose, bumper), ahead)


HERE, THERE = Pose(2.0, 2.0, 0.0), Pose(2.8, 2.0, math.pi)
MINE, THEIRS = along((2.0, 2.0), (4.0, 2.0)), along((2.8, 2.0), (1.0, 2.0))


def test_a_robot_without_mates_near_it_goes_on():
    assert command('rumba2', HERE, MINE, Pose(5.5, 2.0, math.pi), mates_way=along((5.5, 2.0), (4.6, 2.0))) is None
    context = Context(PLAN, quiet(), CleaningConfig())
    assert RightOfWay(context).command(Observation(0.1, HERE), MINE) is None


def test_of_two_that_drive_toward_each_other_the_second_moves_aside_and_the_first_goes_on():
    aside = command('rumba2', HERE, MINE, THERE, mates_way=THEIRS)
    assert aside is not None and aside.brushes_up and (aside.v, aside.w) != (0.0, 0.0)
    assert command('rumba', HERE, MINE, THERE, mates_way=THEIRS) is None


@pytest.mark.parametrize('x, back', [(2.0, 1.9), (0.4, 0.0)])
def test_in_a_corridor_the_second_turns_to_drive_back_and_stands_at_its_end(x, back):
    pose, mate = Pose(x, 0.25, 0.0), Pose(x + 0.8, 0.25, math.pi)
    mine, theirs = along((x, 0.25), (x + 2.0, 0.25)), along((x + 0.8, 0.25), (x - 0.2, 0.25))
    aside = command('rumba2', pose, mine, mate, mates_way=theirs, plan=CORRIDOR)
    assert (aside.v, abs(aside.w), aside.brushes_up) == (0.0, back, True)


def test_who_crosses_the_way_of_the_first_waits_and_the_first_does_not():
    crossing, mate = along((2.0, 2.0), (2.0, 3.5)), Pose(1.5, 2.5, 0.0)
    way = along((1.5, 2.5), (4.0, 2.5))
    assert command('rumba2', HERE, crossing, mate, mates_way=way) == STOP
    assert command('rumba', HERE, crossing, mate, mates_way=way) is None


def test_nobody_waits_for_a_mate_that_drives_away_or_beside():
    assert command('rumba2', HERE, MINE, Pose(2.5, 2.6, 0.0), mates_way=along((2.5, 2.6), (4.0, 2.6))) is None
    assert command('rumba2', HERE, MINE, Pose(1.5, 2.0, math.pi), mates_way=along((1.5, 2.0), (0.5, 2.0))) is None


def test_the_first_waits_for_a_mate_that_stands_right_before_it():
    assert command('rumba', HERE, MINE, Pose(2.45, 2.0, 0.0), Task.SEEKING) == STOP


@pytest.mark.parametrize('task', [Task.OFF, Task.DOCKED])
def test_a_mate_that_does_not_move_is_an_obstacle_like_any_other(task):
    assert command('rumba2', HERE, MINE, Pose(2.45, 2.0, 0.0), task) is None


def test_even_the_first_gives_way_to_one_that_docks():
    assert command('rumba', HERE, MINE, Pose(2.5, 2.6, 0.0), Task.DOCKING, along((2.5, 2.6), (2.5, 1.5))) == STOP


def test_patience_ends():
    steps = round(PATIENCE / 0.1)
    way = dict(mates_way=along((1.5, 2.5), (4.0, 2.5)))
    crossing = along((2.0, 2.0), (2.0, 3.5))
    assert command('rumba2', HERE, crossing, Pose(1.5, 2.5, 0.0), steps=steps - 1, **way) == STOP
    assert command('rumba2', HERE, crossing, Pose(1.5, 2.5, 0.0), steps=steps + 1, **way) is None


# --- neither gets on -----------------------------------------------------------------------------------------------

def test_a_robot_that_leaves_the_way_of_the_first_goes_on_so_that_the_first_need_not_wait():
    pose, leading_off = Pose(2.2, 2.1, math.pi / 2.0), along((2.2, 2.1), (2.2, 3.5))
    assert command('rumba2', pose, leading_off, THERE, mates_way=THEIRS) is None
    assert command('rumba2', pose, along((2.2, 2.1), (2.2, 2.2)), THERE, mates_way=THEIRS) is not None


@pytest.mark.parametrize('bumper', [(True, False), (False, True)])
def test_who_touches_something_on_the_way_aside_drives_on_instead(bumper):
    assert command('rumba2', HERE, MINE, THERE, mates_way=THEIRS, steps=5) is not None
    assert command('rumba2', HERE, MINE, THERE, mates_way=THEIRS, steps=5, bumper=bumper) is None


def test_of_two_in_a_dead_end_the_second_soon_drives_on_and_the_first_moves_aside():
    pose, mate = Pose(0.4, 0.25, 0.0), Pose(1.2, 0.25, math.pi)
    mine, theirs = along((0.4, 0.25), (2.4, 0.25)), along((1.2, 0.25), (0.2, 0.25))
    soon, late = round(SHUT_IN / 0.1) - 1, round(SHUT_IN / 0.1) + 2
    assert command('rumba2', pose, mine, mate, mates_way=theirs, plan=CORRIDOR, steps=soon) == STOP
    assert command('rumba2', pose, mine, mate, mates_way=theirs, plan=CORRIDOR, steps=late) is None
    waiting = dict(ahead=along((0.85, 0.25), (0.2, 0.25)), mate=pose, mates_way=mine, plan=CORRIDOR)
    assert command('rumba', Pose(0.85, 0.25, math.pi), steps=soon, **waiting) == STOP
    aside = command('rumba', Pose(0.85, 0.25, math.pi), steps=late, **waiting)
    assert aside is not None and aside.brushes_up and (aside.v, aside.w) != (0.0, 0.0)
