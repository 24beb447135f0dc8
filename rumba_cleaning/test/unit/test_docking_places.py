"""A robot docks at the places that are offered for docks."""

import pytest
from drivers import context_of, run
from rooms import RADIUS, crooked, legs, quiet, room

from rumba_cleaning.behaviours.dock import Dock
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.dock_place import place_dock
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.world import World


@pytest.mark.parametrize('plan', [crooked(0.02), crooked(0.05), legs(0.05), room(2.0, 1.8), room(8.0, 1.7)],
                         ids=['crooked, fine', 'crooked', 'legs', 'small', 'narrow'])
def test_a_robot_docks_there_from_elsewhere(plan):
    start = World(plan, quiet()).start
    dock = place_dock(plan, RADIUS, start)
    world = World(FloorPlan('docked', plan.occupancy, plan.resolution, plan.origin, dock=dock, start=start), quiet())
    for heading in (0.0, 2.0, 4.0):
        world.spawn('rumba', Pose(start.x, start.y, heading))
        world.step()
        behaviour = Dock(context_of(world.plan, world))
        run(behaviour, world)
        assert (behaviour.message, world.robots['rumba'].is_docked) == ('docked', True)
        world.kill('rumba')
