"""A robot that seeks its dock on its own comes to the contacts: from in front of the dock, and from another place."""

import numpy as np
import pytest

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.devices.seek_dock import RATE, Reading, SeekDock
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.simulation.world import World

LONGEST = 900  # [s]


def reading_of(world):
    """What the robot of a world knows."""
    robot = world.robots['rumba']
    return Reading(robot.odometry, world.infrared('rumba'), robot.is_docked, robot.bumper, world.cliffs('rumba'))


def seconds_to_dock(world):
    """The time until the robot stands on its dock [s]; None if it does not come there."""
    seek = SeekDock()
    for step in range(LONGEST * RATE):
        if world.robots['rumba'].is_docked:
            return step / RATE
        world.robots['rumba'].command(*seek.step(reading_of(world)), world.tick)
        world.step(int(world.step_rate) // RATE)
    return None


def world_with_robot_at(name, pose, seed=1):
    """A world of a named map with a robot at a pose, which must be free."""
    world = World(map_file.load(named_maps.path(name)), seed=seed)
    world.spawn('rumba', pose)
    return world


def starts(name, count):
    """Poses at random on a named map where a robot fits."""
    world = World(map_file.load(named_maps.path(name)), seed=1)
    random = np.random.default_rng(7)
    found = []
    while len(found) < count:
        x, y, theta = random.uniform((0.2, 0.2, -3.1), (6.0, 5.0, 3.1))
        try:
            found.append(world.check(Pose(x, y, theta)))
        except WorldError:
            continue
    return found


@pytest.mark.parametrize('pose', starts('studio', 12), ids=str)
def test_it_comes_to_the_contacts_from_anywhere_in_a_room(pose):
    assert seconds_to_dock(world_with_robot_at('studio', pose)) is not None


def test_on_the_dock_it_stands_still():
    world = World(map_file.load(named_maps.path('studio')), seed=1)
    world.spawn('rumba')
    world.step()
    assert reading_of(world).is_docked
    assert SeekDock().step(reading_of(world)) == (0.0, 0.0)


def test_it_backs_off_a_cliff():
    world = World(map_file.load(named_maps.path('studio')), seed=1)
    world.spawn('rumba')
    world.step()
    seek, reading = SeekDock(), reading_of(world)._replace(is_docked=False, infrared=(0, 0, 0))
    reading = reading._replace(infrared=world.infrared('rumba')._replace(omni=0, left=0, right=0))
    assert seek.step(reading).v > 0.0
    assert seek.step(reading._replace(cliffs=[False, True, False, False])).v < 0.0
