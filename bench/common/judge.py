"""Judges coverage by other means than the simulator: on a raster of its own, from the poses of the brush.

    tracks = Tracks(trial.world)
    trial.advance = tracks.advance
    ...
    print(tracks.judge(plan, robot, obstacles).coverage)

It has no code in common with the packages, so that an error of theirs shows. A raster half as fine changes what it
measures by less than 0.1 points, on floors of 10 m^2 and more.
"""

import numpy as np
from scipy import ndimage

PITCH = 0.005  # [m] of the raster
SLACK = 0.003  # [m] to spare on each side of a passage, as docs/evaluation.md says
RIM = 0.03  # [m] beyond where there is this slack, in which a robot that fits can stand too
ALL_AROUND = np.ones((3, 3), bool)
CHUNK = 20000  # positions of the brush that are drawn at once


class Judge:
    """A floor, and what of it was swept; all arguments are plain numbers and arrays.

    Attributes:
        reachable: bool (rows, columns), the squares of the raster that a brush can reach.
        swept: bool (rows, columns), those that it has passed over.
    """

    def __init__(self, free, resolution, origin, start, radius, brush, obstacles=()):
        """Find what can be reached.

        Args:
            free: bool (rows, columns), cells with floor and without a wall; row 0 lies at the lowest y.
            resolution: side of a cell [m], at least `PITCH`.
            origin: lower left corner of the cells [m].
            start: x and y from which a robot drives [m].
            radius: of the robot [m].
            brush: width of the brush [m].
            obstacles: that stand there all the time: functions of x and y, arrays [m], that say where they are.
        """
        times = max(round(resolution / PITCH), 1)
        self._pitch, self._origin, self._half = resolution / times, np.array(origin), 0.5 * brush
        free = np.pad(free.repeat(times, 0).repeat(times, 1), 1)
        inside = free[:-1, :-1] & free[:-1, 1:] & free[1:, :-1] & free[1:, 1:]  # corners with floor on all sides
        rows, columns = inside.shape
        x, y = self._origin[0] + self._pitch * np.arange(columns), self._origin[1] + self._pitch * np.arange(rows)
        for is_there in obstacles:
            inside &= ~is_there(x[np.newaxis], y[:, np.newaxis])
        away = ndimage.distance_transform_edt(inside) * self._pitch
        wide, _ = ndimage.label(away >= radius + SLACK, ALL_AROUND)
        row, column = self._squares(np.array([start[:2]]))[0]
        near = wide[max(row - 8, 0):row + 9, max(column - 8, 0):column + 9]
        stands = wide == np.bincount(near[near > 0]).argmax()
        stands = (ndimage.distance_transform_edt(~stands) * self._pitch <= RIM) & (away >= radius)
        off = ndimage.distance_transform_edt(~stands) * self._pitch
        middle = 0.25 * (off[:-1, :-1] + off[:-1, 1:] + off[1:, :-1] + off[1:, 1:])
        self.reachable = inside[:-1, :-1] & inside[1:, 1:] & (middle <= self._half)
        self.swept = np.zeros_like(self.reachable)

    def _squares(self, places):
        """Row and column of the square of the raster in which each place (any, 2) [m] lies."""
        return np.floor((places - self._origin) / self._pitch).astype(int)[:, ::-1]

    def follow(self, poses, is_down):
        """Draw the way of a brush, straight from pose to pose.

        Args:
            poses: x [m], y [m] and theta [rad], float64 (any, 3); neighbours lie a few centimetres apart at most.
            is_down: whether the brush was down on the way to each pose, bool (any).
        """
        steps = np.diff(poses, axis=0)
        steps[:, 2] = np.angle(np.exp(1j * steps[:, 2]))
        longest = np.hypot(steps[:, 0], steps[:, 1]) + self._half * np.abs(steps[:, 2])
        parts = np.where(is_down[1:], np.ceil(2.0 * longest / self._pitch).astype(int) + 1, 0)
        before = np.repeat(np.arange(len(steps)), parts)
        first = np.repeat(np.cumsum(parts) - parts, parts)
        share = (np.arange(len(before)) - first) / np.maximum(parts[before] - 1, 1)
        places = poses[before] + share[:, np.newaxis] * steps[before]
        for begin in range(0, len(places), CHUNK):
            self._draw(places[begin:begin + CHUNK])

    def _draw(self, poses):
        """Draw a brush at poses (any, 3): half a square shorter, since squares that it touches are wider by that."""
        reach = self._half - 0.5 * self._pitch
        along = np.linspace(-reach, reach, int(4.0 * reach / self._pitch) + 2)
        x = poses[:, :1] - along * np.sin(poses[:, 2:])
        y = poses[:, 1:2] + along * np.cos(poses[:, 2:])
        squares = self._squares(np.stack([x.ravel(), y.ravel()], axis=1))
        self.swept[squares[:, 0], squares[:, 1]] = True

    @property
    def coverage(self):
        """Share of what can be reached that was swept [0..1]."""
        return float((self.swept & self.reachable).sum() / self.reachable.sum())


class Tracks:
    """The true ways of all robots of a world, and whether their brushes were down, tick by tick."""

    def __init__(self, world):
        """Take note of where they begin."""
        self._world = world
        self._ways = {name: [self._state(robot)] for name, robot in world.robots.items()}

    def _state(self, robot):
        return (*robot.pose, not robot.brushes_up)

    def advance(self, ticks):
        """Let a number of ticks pass."""
        for _ in range(ticks):
            are_down = {name: self._state(robot)[3] for name, robot in self._world.robots.items()}
            self._world.step()
            for name, robot in self._world.robots.items():
                self._ways[name].append((*robot.pose, are_down[name]))

    def judge(self, plan, robot, obstacles=()):
        """A judge that has followed all of them.

        Args:
            plan: what its walls and cliffs are is read, and nothing that was computed from that.
            robot: what robots are like.
            obstacles: that stand there from the start, and count.
        """
        free = (plan.occupancy == 0) & (True if plan.cliff is None else ~plan.cliff)
        found = Judge(free, plan.resolution, plan.origin, self._world.start[:2], robot.drive.radius, robot.brush.width,
                      [_shape(obstacle) for obstacle in obstacles])
        for way in self._ways.values():
            found.follow(np.array(way)[:, :3], np.array(way)[:, 3] > 0.0)
        return found


def _shape(obstacle):
    """Where an obstacle is that stands there: a function of x and y."""
    (at_x, at_y, theta), half_length, half_width = obstacle.pose, 0.5 * obstacle.length, 0.5 * obstacle.width
    cos, sin = np.cos(theta), np.sin(theta)
    if obstacle.radius > 0.0:
        return lambda x, y: np.hypot(x - at_x, y - at_y) <= obstacle.radius
    return lambda x, y: ((np.abs(cos * (x - at_x) + sin * (y - at_y)) <= half_length)
                         & (np.abs(cos * (y - at_y) - sin * (x - at_x)) <= half_width))
