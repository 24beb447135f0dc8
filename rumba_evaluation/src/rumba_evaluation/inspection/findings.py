"""What a map holds for robots of one kind."""

from typing import List, NamedTuple, Optional, Tuple

import numpy as np

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.outlook import INSIDE, Outlook, outlook
from rumba_evaluation.inspection.barriers import Barrier, barrier
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.dock_place import place_dock
from rumba_sim.model.floors.reachability import SLACK, Parts
from rumba_sim.model.floors.sweep import Sweep
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, FloorPlan
from rumba_sim.model.maps.map_header import Header, read_header
from rumba_sim.model.maps.map_image import Picture
from rumba_sim.model.maps.specks import specks
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

MOST = 3  # closed parts that are described
LEAST = 0.05  # [m^2] that a brush can reach in a closed part: smaller ones are corners beside things


class Sheet(NamedTuple):
    """The files of a map, before it is cropped."""

    header: Header
    rows: int
    columns: int
    format: str
    free: float  # [m^2]


class Closed(NamedTuple):
    """A part of the floor that robots cannot reach from the start."""

    pose: Pose  # with the most space around it
    area: float  # that a brush could reach from there [m^2]
    reached: Array  # bool (rows, columns) of the refined plan
    barrier: Optional[Barrier]


class Findings(NamedTuple):
    """All of it."""

    sheet: Sheet
    plan: FloorPlan
    robot: RobotConfig
    start: Pose
    is_start_chosen: bool  # by Rumba, since the map has neither a start nor a dock
    reached: Array  # bool (rows, columns) of the refined plan
    expected: Outlook
    closed: List[Closed]  # the largest of them, from the largest to the smallest
    smaller: Tuple[int, float]  # how many more there are, and their area [m^2] for the centre of a robot
    specks: Array  # int (rows, columns) of the plan: unknown cells that count as walls, as `specks` numbers them
    dock: Optional[Pose]  # a place for a dock, if the map has none
    gap: float  # [m] that a robot needs


def inspected(path: str, robot: RobotConfig) -> Findings:
    """Read and examine a map.

    Args:
        path: of its YAML file.
        robot: what robots are like.

    Raises:
        RumbaError: the map cannot be used, or no such robot fits at its dock or start.
    """
    header = read_header(path)
    sheet = _sheet(header, map_file.read_image(header))
    plan = map_file.load(path, robot.drive.radius)
    start = World(plan, robot).start
    terrain = plan.refined()
    needed = clearance_needed(robot.drive.radius, terrain.resolution)
    parts = Parts(terrain, needed)
    here = parts.at(*start[:2])
    closed = [_closed(terrain, robot, parts, here, there) for there in _others(parts, here)[:MOST]]
    closed = [each for each in closed if each.area >= LEAST]
    rest = [float(parts.areas[there - 1]) for there in _others(parts, here)[len(closed):]]
    reached, _ = _reached(terrain, robot, start)
    return Findings(
        sheet, plan, robot, start, plan.start is None and plan.dock is None, reached,
        outlook(plan, *start[:2], robot, CleaningConfig()), closed, (len(rest), sum(rest)),
        specks(plan.occupancy, round(map_file.SPECK / plan.resolution ** 2)),
        None if plan.docks else place_dock(plan, robot.drive.radius, start), 2.0 * (needed + SLACK))


def _sheet(header: Header, picture: Picture) -> Sheet:
    rows, columns = picture.levels.shape
    free = np.count_nonzero(map_file.whole_occupancy(header, picture) == FREE) * header.resolution ** 2
    return Sheet(header, rows, columns, picture.format, free)


def _others(parts: Parts, here: int) -> List[int]:
    """The numbers of all parts but one, from the largest to the smallest."""
    return [number for number in range(1, len(parts.areas) + 1) if number != here]


def _closed(terrain: FloorPlan, robot: RobotConfig, parts: Parts, here: int, there: int) -> Closed:
    pose = parts.open_pose(there)
    reached, area = _reached(terrain, robot, pose)
    return Closed(pose, area, reached, barrier(terrain, parts, here, there))


def _reached(terrain: FloorPlan, robot: RobotConfig, start: Pose) -> Tuple[Array, float]:
    """The cells that a brush reaches from a start, and their area [m^2]."""
    sweep = Sweep(terrain, robot)
    sweep.begin(start.x, start.y)
    return sweep.missing_share() >= INSIDE, sweep.reachable_area
