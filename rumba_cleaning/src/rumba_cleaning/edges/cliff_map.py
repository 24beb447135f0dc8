"""Where there is floor under the wheels: by the map, by what the cliff sensors saw, and by where the robot has been."""

import collections
import math
import operator
from typing import Deque, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.edges import compiled_cliff_map
from rumba_localisation.edges import JUMP, Edges
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

FAR = 1.0  # [m] what is farther from a cliff than this is far enough for everything that a robot does
SEEN = 0.015  # [m] radius that is assumed for an edge that a sensor saw: half of what a robot drives between readings
SPARE = 0.02  # [m] from a wheel to an edge: a cell of a fine map; an edge that was seen is known no better
SAME = 0.02  # [m] from a cliff of the map, a sensor sees that one
INSIDE = 0.003  # [m] from a cliff that a sensor saw, another edge tells nothing new
CELL = 0.01  # [m] side of the cells in which floor is remembered
STEP = 0.008  # [m] between points that are remembered: less than a cell, so that no cell is left out
LAG = 0.045  # [m] a corner of 90 degrees that begins between two sensors is under one of them when they are so far on
CLOSE = 0.01  # [rad] between two sensors: those that are nearer see the same
HOLE = 0.006  # [m^2] of floor that no sensor passed, within floor that they saw: smaller than any cliff; our choice
AROUND = 0.35  # [m] from the middle of the robot: to what its sensors pass, and once more
BEHIND_DOCK = 0.45  # [m] of floor that a dock needs before it, as it is put up by a person: more than undocking takes


class Between(NamedTuple):
    """What the sensors passed on both sides."""

    way: float  # [m] that the sensors had come on by then
    start: Pose
    change: Tuple[float, float, float]  # of that pose
    poses: int  # that count
    lines: Tuple[bool, ...]  # between which neighbours there was floor on both sides


class CliffMap:
    """The floor and its edges as one robot knows them. It sees a cliff only if it is nearly there, so it remembers.

    Attributes:
        seen: points (x, y) [m], map frame, at which the sensors saw cliffs that the map does not show.
    """

    def __init__(self, plan: FloorPlan, robot: RobotConfig) -> None:
        """Know the cliffs of a plan."""
        self._robot = robot
        self._far = robot.cliff.distance
        # [rad] Sensors that only turn see no corner that begins between two of them until one is where the other was.
        angles = robot.cliff.angles
        self._spacing = max(CLOSE, *(left - right for left, right in zip(angles, angles[1:])))
        half, radius, sensors = 0.5 * robot.drive.wheel_base, robot.drive.radius, robot.cliff
        self._sensors = np.array([(sensors.distance * math.cos(angle), sensors.distance * math.sin(angle))
                                  for angle in sensors.angles])
        self._wheels = np.array([(0.0, half), (0.0, -half)])
        self._between = [_line(start, end) for start, end in zip(self._sensors, self._sensors[1:])]
        self._all_between = np.concatenate(self._between)
        side = np.arange(-radius, radius + STEP, STEP)
        square = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
        self._body = square[np.hypot(*square.T) <= radius]
        self._before_dock = np.concatenate([self._body - (back, 0.0) for back in np.arange(0.0, BEHIND_DOCK, STEP)])
        self._know(plan)
        self.forget()

    def forget(self) -> None:
        """Know no more than the plan."""
        self.seen: List[Tuple[float, float]] = []
        self._edges: Optional[Array] = None if self._mapped is None else self._mapped.copy()
        left, bottom, right, top = self._plan.bounds
        self._origin: Tuple[float, float] = (left, bottom)  # of what follows [m]
        self._floor: Array = np.zeros((int((top - bottom) / CELL) + 1, int((right - left) / CELL) + 1), np.uint8)
        self._noted: Optional[Tuple[Pose, Tuple[bool, ...], bool]] = None  # the last that was
        self._way = 0.0  # [m] that the sensors have come on; turning counts less
        self._unsure: Deque[Between] = collections.deque()
        self._readings = Edges(self._robot)

    def learn(self, plan: FloorPlan) -> None:
        """Go on with a newer plan of the same floor, and with what was seen of it."""
        (old_left, old_bottom), (left, bottom, right, top) = self._origin, plan.bounds
        self._know(plan)
        self._edges = None if self._mapped is None else self._mapped.copy()
        before = [max(math.ceil(by / CELL), 0) for by in (old_bottom - bottom, old_left - left)]
        self._origin = (old_left - before[1] * CELL, old_bottom - before[0] * CELL)
        needed = int((top - self._origin[1]) / CELL) + 1, int((right - self._origin[0]) / CELL) + 1
        after = [max(cells - low - size, 0) for cells, low, size in zip(needed, before, self._floor.shape)]
        self._floor = np.pad(self._floor, list(zip(before, after)))
        seen, self.seen = self.seen, []
        for x, y in seen:
            self._see(x, y)
        self.seen = seen  # although the plan may show some of them: it need not show all cliffs

    def near_walls(self, points: Array) -> Array:
        """Distance of points (any, 2) [m] from the nearest walls of the plan [m]: float64 (any)."""
        return np.asarray(fast.interpolated_at(self._plan.clearance, *self._plan.origin, self._plan.resolution, points))

    def _know(self, plan: FloorPlan) -> None:
        """Measure the distances to the cliffs of a plan."""
        self._plan = plan
        self._mapped: Optional[Array] = None if plan.cliff is None else _distances_to(plan.cliff) * plan.resolution

    def note(self, pose: Pose, cliffs: Sequence[bool], is_docked: bool) -> None:
        """Remember what the cliff sensors see at a pose, and that there is floor under the wheels."""
        noted = (pose, tuple(cliffs), is_docked)
        if noted == self._noted:
            return  # a robot that stands, as while it charges, learns nothing new
        last = None if self._noted is None else self._noted[0]
        self._noted = noted
        for edge in self._readings.met(pose, cliffs):
            if self._clearance(self._mapped, *edge.beyond) > 0.0:  # if not, the sensor is over a cliff of the map
                self._see(edge.x, edge.y)
        if is_docked:
            self._stamp(self._before_dock, pose)
        if last is None or hypot(pose.x - last.x, pose.y - last.y) > JUMP:
            self._stamp(self._body, pose)
            self._unsure.clear()
            last = pose
        turn = wrap_angle(pose.theta - last.theta)
        change = pose.x - last.x, pose.y - last.y, turn
        count = int((hypot(change[0], change[1]) + self._far * abs(turn)) / STEP) + 1
        self._stamp(self._wheels, last, change, count, compiled_cliff_map.DRIVEN)
        if not any(cliffs):
            self._stamp(self._sensors, last, change, count)
        self._pass(pose, last, change, count, cliffs)

    def _pass(self, pose: Pose, last: Pose, change: Tuple[float, float, float], count: int,
              cliffs: Sequence[bool]) -> None:
        """Remember floor between the sensors, once they are so far on that they would have seen an edge in it."""
        ahead = change[0] * math.cos(pose.theta) + change[1] * math.sin(pose.theta)
        if ahead < 0.0:
            self._unsure.clear()
        self._way += max(ahead, 0.0) + LAG * abs(change[2]) / self._spacing
        lines = tuple(not (one or other) for one, other in zip(cliffs, cliffs[1:]))
        if not all(lines):
            self._unsure = collections.deque(
                each._replace(lines=tuple(map(operator.and_, each.lines, lines))) for each in self._unsure)
        self._unsure.append(Between(self._way, last, change, count, lines))
        while self._unsure[0].way + LAG <= self._way:
            passed = self._unsure.popleft()
            sure = [line for line, is_floor in zip(self._between, passed.lines) if is_floor]
            for line in [self._all_between] if all(passed.lines) else sure:
                self._stamp(line, passed.start, passed.change, passed.poses)

    def _stamp(self, points: Array, pose: Pose, change: Tuple[float, float, float] = (0.0, 0.0, 0.0),
               count: int = 1, mark: int = compiled_cliff_map.SEEN) -> None:
        """Remember floor under points of a robot that moves.

        Args:
            points: float64 (any, 2) [m], in the frame of the robot.
            pose: where it began.
            change: of its pose.
            count: poses that count: the last one, and others at equal distances after the first.
            mark: how the floor is known.
        """
        compiled_cliff_map.stamp(self._floor, *self._origin, CELL, pose, change, count, points, mark)

    def close_holes(self, x: float, y: float) -> None:
        """Take holes in the floor that the sensors saw around a point [m] for floor: no cliff is as small."""
        reach = int(AROUND / CELL)
        column, row = int((x - self._origin[0]) / CELL), int((y - self._origin[1]) / CELL)
        window = self._floor[max(row - reach, 0):row + reach + 1, max(column - reach, 0):column + reach + 1]
        holes, count = ndimage.label(window != compiled_cliff_map.SEEN)
        rim = np.unique(np.concatenate([holes[0], holes[-1], holes[:, 0], holes[:, -1]]))
        sizes = np.bincount(holes.ravel(), minlength=count + 1)
        is_small = sizes * CELL ** 2 <= HOLE
        is_small[rim] = is_small[0] = False
        window[is_small[holes]] = compiled_cliff_map.SEEN

    def _see(self, x: float, y: float) -> None:
        """Remember a cliff, unless it is a known one."""
        if self._clearance(self._mapped, x, y) < SAME or self.clearance_at(x, y) < INSIDE:
            return
        self.seen.append((x, y))
        rows, columns = self._plan.rows + 1, self._plan.columns + 1
        if self._edges is None:
            self._edges = np.full((rows, columns), FAR)
        res, (left, bottom) = self._plan.resolution, self._plan.origin
        column, row, size = int((x - left) / res), int((y - bottom) / res), int(FAR / res) + 1
        top, first = max(row - size, 0), max(column - size, 0)
        near_y, near_x = np.ogrid[top:min(row + size + 1, rows), first:min(column + size + 1, columns)]
        distance = np.hypot(near_x * res + left - x, near_y * res + bottom - y) - SEEN
        window = self._edges[top:row + size + 1, first:column + size + 1]
        np.minimum(window, np.maximum(distance, 0.0), out=window)

    def clearance_at(self, x: float, y: float) -> float:
        """Distance from a point [m] to the nearest known cliff [m], interpolated; FAR or more if none is near."""
        return self._clearance(self._edges, x, y)

    def _clearance(self, distances: Optional[Array], x: float, y: float) -> float:
        if distances is None:
            return FAR
        left, bottom = self._plan.origin
        value: float = fast.interpolated(distances, (x - left) / self._plan.resolution,
                                         (y - bottom) / self._plan.resolution)[0]
        return value

    def clearances(self, points: Array) -> Array:
        """As `clearance_at`, for many points (any, 2) [m]: float64 (any)."""
        if self._edges is None:
            return np.full(len(points), FAR)
        return np.asarray(fast.interpolated_at(self._edges, *self._plan.origin, self._plan.resolution, points))

    def are_known(self, points: Array, cells: int, is_wary: bool = False) -> bool:
        """Whether wheels or sensors found floor at all points (any, 2) [m], or so many cells beside them.

        To a wary robot, floor that only a wheel was on tells nothing of what is beside: cell by cell, it would creep on
        over an edge.
        """
        least = compiled_cliff_map.SEEN if is_wary else compiled_cliff_map.DRIVEN
        return bool(compiled_cliff_map.are_marked(self._floor, *self._origin, CELL, points, cells, least))


def _line(start: Tuple[float, float], end: Tuple[float, float]) -> Array:
    """Points on a line: float64 (any, 2) [m]."""
    return np.linspace(start, end, int(hypot(end[0] - start[0], end[1] - start[1]) / STEP) + 2)


def _distances_to(cliff: Array) -> Array:
    """Distance [cells] of each node to the nearest cell that is a cliff, from node to node as in `FloorPlan`."""
    padded = np.pad(~cliff, 1, mode='constant', constant_values=True)
    away = padded[:-1, :-1] & padded[:-1, 1:] & padded[1:, :-1] & padded[1:, 1:]
    if away.all():
        return np.full(away.shape, math.inf)
    return np.ascontiguousarray(ndimage.distance_transform_edt(away), dtype=np.float64)
