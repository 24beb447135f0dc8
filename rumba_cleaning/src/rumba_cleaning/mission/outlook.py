"""What a mission will take, before it begins: time and charges, by the floor that can be reached."""

import math
from typing import List, NamedTuple

import numpy as np

from rumba_cleaning.cleaning_config import CleaningConfig, attainable
from rumba_cleaning.mission.duration import TAPER
from rumba_sim.model.floors.sweep import Sweep
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

HOUR = 3600.0  # [s]
INSIDE = 0.25  # of a cell that can be reached, at least, for the cell to be inside the edges; along straight walls,
#                cells have about half, and some of them a little more
HOME = 0.03  # of the charge that the way to the dock takes, about


class Outlook(NamedTuple):
    """What one robot needs for a floor, about."""

    area: float  # that its brush can reach [m^2]
    working: float  # [s]
    charges: int  # on the way: a full battery is there at the start
    charging: float  # [s]

    @property
    def hours(self) -> float:
        """From the start to the end [h]."""
        return (self.working + self.charging) / HOUR


def outlook(plan: FloorPlan, x: float, y: float, robot: RobotConfig, config: CleaningConfig) -> Outlook:
    """What the floor around (x, y) [m] takes by boustrophedon.

    It takes the time for the floor without any overlap, and for one more pass along all edges;
    bench/people_maps.py prints by how much missions take longer.

    Args:
        plan: the floor plan.
        x, y: where the robot starts, map frame [m].
        robot: what it is like.
        config: its speeds and thresholds.

    Raises:
        MapError: the robot does not fit there.
    """
    terrain = plan.refined()
    sweep = Sweep(terrain, robot)
    sweep.begin(x, y)
    area, inside = sweep.reachable_area, sweep.missing_share() >= INSIDE
    edges = terrain.resolution * (
        np.count_nonzero(inside[1:] != inside[:-1]) + np.count_nonzero(inside[:, 1:] != inside[:, :-1]))
    working = (area / robot.brush.width + edges) / attainable(config, robot).speed
    battery = robot.battery
    used = working * battery.discharge_rate(battery.cleaning_current)  # in full batteries
    span = max(config.charge_to - config.reserve - HOME, HOME)
    charges = max(math.ceil((used - (1.0 - config.reserve - HOME)) / span), 0)
    charging = charges * span * TAPER / battery.discharge_rate(battery.charge_current) if charges else 0.0
    return Outlook(area, working, charges, charging)


def remarks(plan: FloorPlan, x: float, y: float, robot: RobotConfig, config: CleaningConfig) -> List[str]:
    """What people should know before a mission begins: a line if the battery will not last, or speeds are too high.

    Args:
        plan, x, y, robot, config: as for `outlook`.

    Raises:
        MapError: the robot does not fit there.
    """
    found = []
    expected = None if plan.docks else outlook(plan, x, y, robot, config)
    if expected is not None and expected.charges:
        found.append(f'{plan.name}: the map has no dock, and {expected.area:.0f} m² take about {expected.charges} '
                     f'charge{"s" if expected.charges > 1 else ""}: add a dock (rosrun rumba_sim place_dock finds a '
                     'place), or set drain to 0')
    fastest = robot.drive.max_speed
    if config.speed > fastest:
        found.append(f'the cleaning speed is {config.speed:g} m/s, and drive/max_speed {fastest:g}: the robot cleans '
                     f'at {fastest:g} m/s')
    return found
