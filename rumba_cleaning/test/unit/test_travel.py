"""Along a route, a robot drives on beside edges that the map shows, and backs off from others."""

import math

import numpy as np
import pytest
from drivers import context_of, guarded, with_cliffs
from rooms import quiet, room

from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.control import CONTROL_DT, observe
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

ROOM, EDGE = room(4.0, 2.0, 0.02, start=Pose(0.5, 0.5, 0.0)), (0.0, 1.4, 4.0, 2.0)
START, TURN = Pose(1.0, 1.0, 0.5 * math.pi), (1.0, 1.25)  # there, sensors are over the edge
TO_EDGE = Route(np.array([START[:2], TURN, START[:2], (2.0, 0.9)]), np.full(3, 0.3))


def before_edge(is_shown):
    """A robot that is to drive to an edge, its world, and what it knows."""
    truth = with_cliffs(ROOM, EDGE)
    world = World(truth, quiet())
    robot = world.spawn('rumba', START)
    return robot, world, context_of(truth if is_shown else ROOM, world)


@pytest.mark.parametrize('is_shown, ends', [(True, Going.ARRIVED), (False, Going.BLOCKED)])
def test_only_an_edge_that_the_map_does_not_show_ends_a_travel(is_shown, ends):
    robot, world, context = before_edge(is_shown)
    guard, travel, most = Guard(context), Travel(context, TO_EDGE), 0.0

    def decide(observation):
        nonlocal most
        most = max(most, robot.pose.y if any(observation.cliffs) else 0.0)
        return travel.command(observation, True)
    for _ in guarded(guard, world, decide, seconds=30.0):
        if travel.going is not Going.ON:
            break
    assert most > 1.22 and travel.going is ends and not robot.has_fallen
    assert (robot.pose.x > 1.9) == is_shown


@pytest.mark.parametrize('is_held, is_other_seen', [(False, False), (True, False), (False, True)])
def test_at_an_edge_it_backs_off_if_that_holds_it_or_the_map_does_not_show_all(is_held, is_other_seen):
    _, world, context = before_edge(True)
    if is_other_seen:
        context.cliff_map._see(1.0, 0.5)
    observation = observe(world, 'rumba', CONTROL_DT)._replace(cliffs=(False, True, True, False), is_held=is_held)
    assert (Travel(context, TO_EDGE).command(observation, True).v < 0.0) == (is_held or is_other_seen)


@pytest.mark.parametrize('bumper, side', [((True, False), 1.0), ((False, True), -1.0)])
def test_what_presses_a_switch_is_remembered_on_the_side_of_that_switch(bumper, side):
    _, world, context = before_edge(False)
    pose = Pose(2.0, 1.0, 0.0)
    observation, travel = observe(world, 'rumba', CONTROL_DT)._replace(pose=pose), Travel(context, TO_EDGE)
    travel.command(observation, True)
    assert travel.command(observation._replace(bumper=bumper), True).v < 0.0
    ground = context.ground
    there, opposite = (float(ground.clearance[ground.node(pose.x + 0.13, pose.y + y)])
                       for y in (0.12 * side, -0.12 * side))
    assert there < opposite - 0.05
