"""Where robots can stand: clear of walls, cliffs, obstacles and each other."""

import math
from typing import Mapping

import numpy as np

from rumba_sim.model.common.errors import MapError, WorldError
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.floors.reachability import most_open_pose, stands
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.obstacles import Obstacles

APART, TOUCHING = 0.5, 0.0  # radii between a robot that is added and the others, if there is room, and if not


class FreeSpace:
    """Where robots can stand on a floor plan, with the obstacles of a world as they are now.

    `others` are the poses of robots by name.

    Attributes:
        start: pose of the first robot if none is given: the start of the plan, else the dock, else the position with
            the largest clearance in the largest part of the floor.
    """

    def __init__(self, terrain: FloorPlan, reachable: FloorPlan, obstacles: Obstacles, radius: float,
                 reach: float) -> None:
        """Find the start.

        Args:
            terrain: the floor plan.
            reachable: the same, its safe clearance also that to obstacles which stood there from the start.
            obstacles: of the world.
            radius: of the robots [m].
            reach: clearance that they need [m].

        Raises:
            MapError: a robot does not fit at the dock or at the start of the plan.
            WorldError: an obstacle stands there.
        """
        self._terrain, self._reachable, self._obstacles = terrain, reachable, obstacles
        self._radius, self._reach = radius, reach
        self.start = terrain.start or terrain.dock or most_open_pose(reachable, reach)
        for what, pose in [*(('dock', dock) for dock in terrain.docks), ('start', self.start)]:
            self._check_plan(what, pose)

    def _check_plan(self, what: str, pose: Pose) -> None:
        self._terrain.check_pose(pose, self._reach, f'{self._terrain.name}: {what}')
        # The clearance is interpolated, and smaller than the distance near a corner of an obstacle.
        is_free = self._reachable.safe_clearance_at(pose.x, pose.y) >= self._reach
        name = self._obstacles.near(pose.x, pose.y, self._reach + (0.0 if is_free else self._terrain.resolution))
        if name:
            raise WorldError(f'{name!r} stands at the {what}, ({pose.x:.2f}, {pose.y:.2f}) m: no robot fits there')

    def check(self, pose: Pose, others: Mapping[str, Pose]) -> Pose:
        """Check that a robot can stand at a pose [m, rad], map frame, beside others.

        Returns:
            The pose with its heading in (-pi, pi].

        Raises:
            WorldError: a number is not finite, or the robot does not fit beside walls, cliffs, obstacles and robots.
        """
        if not all(map(math.isfinite, pose)):
            raise WorldError(f'pose ({pose.x}, {pose.y}, {pose.theta}): must be finite numbers')
        try:
            self._terrain.check_pose(pose, self._reach, f'{self._terrain.name}: pose')
        except MapError as error:
            raise WorldError(str(error)) from None
        for name, other in others.items():
            if hypot(other.x - pose.x, other.y - pose.y) - 2.0 * self._radius < 0.0:
                raise WorldError(f'({pose.x:.2f}, {pose.y:.2f}) m: {name!r} stands there')
        obstacle = self._obstacles.near(pose.x, pose.y, self._radius)
        if obstacle:
            raise WorldError(f'({pose.x:.2f}, {pose.y:.2f}) m: the obstacle {obstacle!r} stands there')
        return Pose(pose.x, pose.y, wrap_angle(pose.theta))

    def nearest(self, others: Mapping[str, Pose]) -> Pose:
        """The start, or a dock if that is one, or the free position nearest to it that a robot can drive to from there.

        The free position is a little apart from other robots.

        Raises:
            WorldError: there is no room.
        """
        docks = self._terrain.further_docks if self._terrain.start is None else ()
        for place in (self.start, *docks):
            gaps = [hypot(pose.x - place.x, pose.y - place.y) - 2.0 * self._radius for pose in others.values()]
            if min(gaps, default=0.0) >= 0.0 and not self._obstacles.near(*place[:2], self._radius):
                return self.check(place, others)
        points = self._points()
        for gap in (APART, TOUCHING):
            free = np.ones(len(points), np.bool_)
            for pose in others.values():
                free &= np.hypot(*(points - pose[:2]).T) >= (2.0 + gap) * self._radius
            for x, y in map(np.ndarray.tolist, points[free]):  # as a rule the first will do
                if not self._obstacles.near(x, y, self._radius):
                    return self.check(Pose(x, y, self.start.theta), others)
        raise WorldError(f'{self._terrain.name}: no room for another robot')

    def _points(self) -> Array:
        """Where a robot that comes from the start can stand, the nearest first: float64 (any, 2) [m]."""
        where = np.argwhere(stands(self._reachable, self._reach, self.start.x, self.start.y))
        points = 0.5 * self._terrain.resolution * where[:, ::-1] + self._terrain.origin
        return points[np.argsort(np.hypot(*(points - self.start[:2]).T), kind='stable')]
