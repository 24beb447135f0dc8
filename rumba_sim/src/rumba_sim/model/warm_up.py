"""Compiles the kernel before its first use; the build runs `python3 -m rumba_sim.model.warm_up`."""

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.devices.light_bumper import light_bumper
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.guided_world import GuidedWorld
from rumba_sim.model.simulation.obstacle import Obstacle, walk
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.worlds import Worlds


def main() -> None:
    """Call every function of the kernel and of the batch that a world, and many of them, call."""
    floor = np.zeros((40, 40), np.int8)
    plan = FloorPlan('a room of 4 m', floor, 0.1, (0.0, 0.0), cliff=floor > 0, dock=Pose(3.0, 2.0, 0.0))
    stands, walks = Pose(1.0, 1.0, 0.0), (Pose(1.0, 3.0, 0.0), Pose(2.0, 3.0, 0.0))
    world = World(plan, obstacles=[
        Obstacle('box', stands, height=1.0, length=0.2, width=0.1),
        Obstacle('disc', walks[0], height=1.0, radius=0.1, stops=walk(walks, 0.5, False, 0.0, 0.0))])
    world.spawn('rumba')
    world.step()
    world.scan('rumba')
    world.infrared('rumba')
    world.cliffs('rumba')
    light_bumper(world, 'rumba')
    worlds = Worlds([world])
    worlds.step()
    worlds.scan()
    worlds.infrared()
    worlds.cliffs()
    worlds.surroundings(4, [0.1])
    guided = GuidedWorld(plan)
    guided.jump(guided.world.start)
    guided.wish()


if __name__ == '__main__':
    main()
