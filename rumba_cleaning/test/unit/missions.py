"""Missions on a small floor, and what they say."""

import itertools
import re

from drivers import context_of
from rooms import RADIUS, crooked, quiet

from rumba_cleaning.control import steps
from rumba_cleaning.mission.mission import Mission
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

DOCK = Pose(4.0 - RADIUS - 0.01, 1.2, 0.0)
PLAN = crooked(dock=DOCK)


def mission(plan=PLAN, truth=None, start=None, charge=1.0, strategy='boustrophedon', target=0.98, **battery):
    """A world after its first tick, and a robot that begins a mission."""
    world = World(truth or plan, quiet(battery=battery))
    world.spawn('rumba', start, charge, brushes_up=True)
    world.step()
    return world, Mission(context_of(plan, world), strategy, target)


def states(behaviour, world, seconds=4000.0):
    """The states of a mission, one after the other."""
    return [state for state, _ in itertools.groupby(
        behaviour.state for _ in steps(behaviour, world, seconds=seconds))]


def until(behaviour, world, share):
    """Step a mission until so much of the floor is clean."""
    for _ in steps(behaviour, world, seconds=4000.0):
        if world.floor.coverage >= share:
            return
    raise AssertionError(f'{world.floor.coverage} of the floor is clean at the end')


def percent_swept(behaviour):
    """What the message of a mission says."""
    return float(re.match(r'(.*?) % swept', behaviour.message).group(1))
