"""The arrays in which a world is: what the kernel reads and changes."""

from typing import Dict, NamedTuple

from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.records import OBSTACLE, ROBOT


class WorldArrays(NamedTuple):
    """Arrays as `kernel` describes them; those of a floor plan, which never change, are not among them."""

    robots: Array
    constants: Array
    obstacles: Array
    stops: Array
    noise: Array
    cells: Array
    samples: Array
    dirt: Array
    tally: Array

    def changing(self) -> Dict[str, Array]:
        """Those that ticks change, by name; records field by field, since bytes between fields are undefined.

        `alone_until` is none of them: it only saves time, and 0 is as good as what was computed.
        """
        robots = {f'robots/{name}': self.robots[name] for name in ROBOT.names or () if name != 'alone_until'}
        floor = {'noise': self.noise, 'dirt': self.dirt, 'samples': self.samples, 'tally': self.tally}
        if len(self.obstacles) == 0:
            return {**robots, **floor}
        obstacles = {f'obstacles/{name}': self.obstacles[name] for name in OBSTACLE.names or ()}
        return {**robots, **floor, **obstacles, 'stops': self.stops}
