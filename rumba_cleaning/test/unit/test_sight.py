"""What the laser sees and the map does not show: where it is, what is in the way, and what has gone again."""

import numpy as np
import pytest
from rooms import quiet, room

from rumba_cleaning.belief.met import SEEN
from rumba_cleaning.belief.sight import CELL, MATE, STAYS, Sight
from rumba_cleaning.pose_source import seeing, truth
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

PLAN = room(4.0, 3.0, 0.02)
BOX = Obstacle('box', Pose(2.0, 1.5, 0.0), 0.3, length=0.4, width=0.2)
HERE = Pose(0.8, 1.5, 0.0)
REACH = 0.18


def world_with(*obstacles, config=None):
    """A world with a robot in front of obstacles."""
    world = World(PLAN, config or quiet(), 50, 1, obstacles)
    world.spawn('rumba', HERE)
    return world


def look(sight, world, count=5, dt=0.2, mates=()):
    """Have the robot look a number of times."""
    for _ in range(count):
        belief = seeing(truth)(world, 'rumba')
        sight.look(belief.pose, belief.scan, mates, dt)
    return sight.seen()


def off_box(points):
    """Distances of points from the box [m]."""
    beyond = np.abs(points - (2.0, 1.5)) - (0.2, 0.1)
    return np.hypot(*np.maximum(beyond, 0.0).T)


def test_it_sees_a_box_where_it_is_and_nothing_else():
    seen = look(Sight(PLAN), world_with(BOX))
    assert len(seen.passing) >= 5 and off_box(seen.passing).max() < CELL
    assert (seen.passing[:, 0] < 1.8 + CELL).all()  # its front: the rest is hidden
    assert np.ptp(seen.passing[:, 1]) > 0.2 - 2 * CELL


@pytest.mark.parametrize('config', [quiet(), RobotConfig()], ids=['exact', 'with errors'])
def test_walls_are_nothing_new(config):
    world, sight = world_with(config=config), Sight(PLAN)
    assert not len(look(sight, world, count=100).passing)
    assert not len(sight.in_way(HERE, np.array([[3.9, 1.5]]), REACH))


def test_what_is_lower_than_the_laser_is_not_seen():
    assert not len(look(Sight(PLAN), world_with(BOX._replace(height=0.05))).passing)


def test_a_mate_is_no_obstacle():
    sight, world = Sight(PLAN), world_with(BOX)
    assert not len(look(sight, world, mates=[Pose(2.0, 1.5, 0.0)]).passing)
    assert len(look(sight, world, mates=[Pose(2.0, 1.5 + MATE + 0.3, 0.0)]).passing)


def test_what_moved_on_is_gone_as_soon_as_the_laser_sees_through():
    sight, world = Sight(PLAN), world_with(BOX)
    look(sight, world, count=50)
    world.remove_obstacle('box')
    seen = look(sight, world, count=15)
    assert not len(seen.passing) and not len(seen.staying)


def test_what_is_seen_for_a_minute_stays_and_stays_at_once_when_it_is_seen_again():
    sight, world = Sight(PLAN), world_with(BOX)
    passing = look(sight, world).passing
    seen = look(sight, world, count=int(STAYS / 0.2) - 10)
    assert len(seen.passing) and not len(seen.staying)
    seen = look(sight, world, count=20)
    assert not len(seen.passing) and len(seen.staying) >= len(passing)
    sight.forget(seen.staying[1:])
    assert sight.seen().staying.tolist() == seen.staying[:1].tolist()
    assert len(look(sight, world).staying)


def test_what_passes_is_forgotten_until_it_is_seen_again():
    sight, world = Sight(PLAN), world_with(BOX)
    sight.forget(look(sight, world).passing)
    assert not len(sight.seen().passing) and len(look(sight, world).passing)


@pytest.mark.parametrize('end, is_in_way', [
    ((1.7, 1.5), True), ((1.7, 1.72), True), ((1.7, 1.85), False), ((1.5, 1.5), False), ((0.4, 1.5), False)])
def test_something_is_in_the_way_if_the_body_would_touch_it(end, is_in_way):
    sight = Sight(PLAN)
    look(sight, world_with(BOX))
    here = Pose(1.3, end[1], 0.0)
    ahead = np.linspace(here[:2], end, 10)
    assert bool(len(sight.in_way(here, ahead, REACH))) == is_in_way


def test_what_the_body_touches_already_is_not_in_its_way_unless_it_drives_against_it():
    sight = Sight(PLAN)
    look(sight, world_with(BOX))
    here = Pose(1.65, 1.5, 0.0)
    assert not len(sight.in_way(here, np.linspace((1.65, 1.5), (1.2, 1.5), 10), REACH))
    assert len(sight.in_way(here, np.linspace((1.65, 1.5), (1.75, 1.5), 10), REACH))


def test_it_knows_whether_something_is_seen_at_a_point():
    sight = Sight(PLAN)
    assert not sight.is_seen(1.8, 1.5, 0.1)
    look(sight, world_with(BOX))
    assert sight.is_seen(1.75, 1.5, 0.1) and not sight.is_seen(1.6, 1.5, 0.1) and not sight.is_seen(0.0, 0.0, 0.1)


def test_another_plan_begins_anew():
    sight = Sight(PLAN)
    look(sight, world_with(BOX))
    sight.learn(PLAN)
    assert not len(sight.seen().passing) and SEEN == CELL / 2


def test_what_is_not_seen_for_a_moment_was_there_all_the_time():
    """A beam that grazes it passes by now and then."""
    sight, world = Sight(PLAN), world_with(BOX)
    look(sight, world)
    look(sight, world, count=round(0.8 * STAYS / 0.2))
    world.remove_obstacle('box')
    assert not len(look(sight, world, count=3).passing)
    world.add_obstacle(BOX)
    seen = look(sight, world, count=round(0.3 * STAYS / 0.2))
    assert len(seen.staying) and not len(seen.passing)
