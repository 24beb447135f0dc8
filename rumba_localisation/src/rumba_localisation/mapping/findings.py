"""What a robot found where the laser saw nothing, or erred: by bumper and cliff sensors, and by having stood there."""

import math
from typing import Callable, Dict, List, Sequence, Tuple

from rumba_localisation.edges import Edges
from rumba_localisation.mapping.grids.grid import Grid
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig

Point = Tuple[float, float]  # [m], map frame

SIDES = {(True, True): 0.0, (True, False): 0.74, (False, True): -0.74}  # [rad] of a contact, by what is pressed
ARC = (-0.7, -0.35, 0.0, 0.35, 0.7)  # [rad] from there: a switch tells no more of the direction
KNOWN = 0.06  # [m] from a wall of the map, a contact is one with that
DEPTH = 0.02  # [m] from the body to the middle of what it touched
SAME = 0.03  # [m] between two points that tell the same
STEP = 0.05  # [m] side of a square of the floor, for which one place tells where the robot stood


class Findings:
    """Points at which the robot touched something that the laser does not see, and at which the floor ends.

    Attributes:
        touched: points of obstacles.
        cliffs: points without floor.
        stood: where it stood, by squares of the floor of STEP.
        radius: of the robot [m].
    """

    def __init__(self, robot: RobotConfig) -> None:
        """Know nothing."""
        self.radius = robot.drive.radius
        self.stood: Dict[Tuple[int, int], Point] = {}
        self._away = robot.drive.radius + DEPTH
        self._edges = Edges(robot)
        self._pressed = (False, False)  # the newest state of the bumper
        self.touched: List[Point] = []
        self.cliffs: List[Point] = []

    @property
    def version(self) -> int:
        """Number of points that were found."""
        return len(self.touched) + len(self.cliffs)

    def note(self, grid: Grid, pose: Pose, bumper: Tuple[bool, bool], cliffs: Sequence[bool]) -> None:
        """Remember what the sensors tell at a pose, unless the grid shows it.

        A switch that stays pressed tells nothing new: a robot that pushes against something is not where its wheels
        have it.

        Args:
            grid: the map.
            pose: of the robot, map frame.
            bumper: whether it is pressed on the left and on the right.
            cliffs: whether there is no floor under each sensor, from left to right.
        """
        self.stood[round(pose.x / STEP), round(pose.y / STEP)] = pose.x, pose.y
        is_new = any(now and not before for now, before in zip(bumper, self._pressed))
        self._pressed = bumper
        if is_new and not self._is_known(grid, pose, bumper):
            _remember(self.touched, _ahead(pose, SIDES[bumper], self._away))
        for edge in self._edges.met(pose, cliffs):
            _remember(self.cliffs, (edge.x, edge.y))

    def _is_known(self, grid: Grid, pose: Pose, bumper: Tuple[bool, bool]) -> bool:
        """Whether walls of the map press what is pressed: one in the direction of the contact, or one at each side."""
        def is_wall(side: float) -> bool:
            return any(grid.distance_at(*_ahead(pose, side + off, self._away)) <= KNOWN for off in ARC)

        return is_wall(SIDES[bumper]) or all(bumper) and is_wall(SIDES[True, False]) and is_wall(SIDES[False, True])

    def move(self, moved: Callable[[Pose], Pose]) -> None:
        """Follow a redrawn map; `moved` tells where on it is what was at a pose before."""
        for points in (self.touched, self.cliffs):
            points[:] = [moved(Pose(x, y, 0.0))[:2] for x, y in points]
        places = [moved(Pose(x, y, 0.0))[:2] for x, y in self.stood.values()]
        self.stood = {(round(x / STEP), round(y / STEP)): (x, y) for x, y in places}


def _ahead(pose: Pose, angle: float, distance: float) -> Point:
    return (pose.x + distance * math.cos(pose.theta + angle), pose.y + distance * math.sin(pose.theta + angle))


def _remember(points: List[Point], found: Point) -> None:
    if all(math.hypot(x - found[0], y - found[1]) > SAME for x, y in points):
        points.append(found)
