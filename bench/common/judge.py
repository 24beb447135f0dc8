"""Judges coverage by other means than the simulator: by exact distances, and triangles over what the brush passes.

    tracks = Tracks(trial.world)
    trial.advance = tracks.advance
    ...
    print(tracks.judge(plan, robot, obstacles).coverage)

It has no code in common with the packages, so that an error of theirs shows. The simulator asks the clearance,
interpolated between the nodes of its cells; the judge measures distances on a lattice.
"""

import math

import numpy as np
from scipy import ndimage

LATTICE = 0.01  # [m] between two points, at most ...
FINE = 0.005  # [m] ... and where obstacles stand that no cells show
SLACK = 0.003  # [m] on each side of a robot that drives through a passage
LEVEL = 0.0005  # [m] steps in which positions beside the points of the lattice are looked for
FINEST = 0.02  # [rad] of a turn in one triangle
CHUNK = 20_000  # triangles at a time
ALL_AROUND = np.ones((3, 3))
ROUNDING = 1e-9  # [m]
RIM = 0.4  # [steps]


class Judge:
    """What a robot can reach of a floor, and how much of that its brush has passed.

    Attributes:
        area: what the brush can reach [m^2].
    """

    def __init__(self, free, resolution, origin, start, radius, brush, obstacles=()):
        """Find what can be reached.

        Args:
            free: bool (rows, columns), cells with floor and without a wall; row 0 lies at the lowest y.
            resolution: side of a cell [m].
            origin: lower left corner of the cells [m].
            start: x and y from which a robot drives [m]; None: from anywhere in the largest part.
            radius: of the robot [m].
            brush: width of the brush [m].
            obstacles: that stand there all the time: functions of x and y, arrays [m], that say where they are.
        """
        self._origin, self._brush = np.array(origin, float), brush
        # An even number: the middle of each gap is a point.
        count = 2 * math.ceil(0.5 * resolution / (FINE if obstacles else LATTICE) - 1e-6)
        self._step = resolution / count
        free = np.asarray(free, bool).repeat(count, 0).repeat(count, 1)
        away = self._distances(free, obstacles)
        labels, number = ndimage.label(away >= radius + SLACK - ROUNDING, ALL_AROUND)
        sizes = np.bincount(labels.ravel(), minlength=number + 1)[1:]
        part = int(np.argmax(sizes)) + 1 if start is None else self._part_at(labels, start)
        self._place_samples(free, self._nearness(away, labels == part, radius), obstacles)

    @property
    def coverage(self):
        """Share of what can be reached that was passed [0..1]."""
        return np.count_nonzero(self._passed & self._inside) / max(np.count_nonzero(self._inside), 1)

    def follow(self, poses, is_down):
        """Have the brush pass along the way of a robot.

        Args:
            poses: x [m], y [m] and theta [rad], float64 (any, 3); neighbours lie a few centimetres apart at most.
            is_down: whether the brush was down on the way to each pose, bool (any).
        """
        edges = np.flatnonzero(np.diff(np.concatenate([[False], is_down[1:], [False]]).astype(int)))
        for begin, end in edges.reshape(-1, 2):
            self._sweep(np.array(poses[begin:end + 1], float))

    def _sweep(self, poses):
        """Have the brush pass along poses, float64 (any, 3) [m, m, rad], which are changed."""
        poses[:, 2] = np.unwrap(poses[:, 2])
        poses = _refined(poses[np.concatenate([[True], np.any(poses[1:] != poses[:-1], axis=1)])])
        across = 0.5 * self._brush * np.stack([-np.sin(poses[:, 2]), np.cos(poses[:, 2])], axis=1)
        for side in (across, -across):
            centres, tips = poses[:, :2], poses[:, :2] + side
            self._lay(np.stack([centres[:-1], tips[:-1], tips[1:]], axis=1))
            self._lay(np.stack([centres[:-1], tips[1:], centres[1:]], axis=1))

    # --- what can be reached ------------------------------------------------------------------------------------------

    def _distances(self, free, obstacles):
        """Distance of each point of the lattice to the nearest obstacle [m]; beyond the map, all is one.

        It is exact beside cells, since the nearest point of a square is a point of the lattice; obstacles end about RIM
        beyond their outermost points.
        """
        free = np.pad(free, 1, mode='constant')
        inside = free[:-1, :-1] & free[:-1, 1:] & free[1:, :-1] & free[1:, 1:]
        rows, columns = inside.shape
        x, y = self._origin[0] + self._step * np.arange(columns), self._origin[1] + self._step * np.arange(rows)
        away = self._step * ndimage.distance_transform_edt(inside)
        for is_there in obstacles:
            free = ~is_there(x[np.newaxis], y[:, np.newaxis])
            if not free.all():
                away = np.minimum(away, self._step * (ndimage.distance_transform_edt(free) - RIM))
        return np.maximum(away, 0.0)

    def _part_at(self, labels, start):
        """The label nearest to a start."""
        column, row = np.rint((np.array(start, float) - self._origin) / self._step).astype(int)
        _, (rows, columns) = ndimage.distance_transform_edt(labels == 0, return_indices=True)
        return labels[rows[row, column], columns[row, column]]

    def _nearness(self, away, part, radius):
        """Distance of each point to the nearest position of the robot in a part [m].

        Positions between the points are as far from a point beside them as that lacks clearance.
        """
        near = ndimage.binary_dilation(part, ALL_AROUND, 2)
        found = np.full(away.shape, np.inf)
        for lack in np.arange(0.0, self._step, LEVEL):
            stands = near & (away >= radius - lack - ROUNDING)
            found = np.minimum(found, self._step * ndimage.distance_transform_edt(~stands) + lack)
        return found

    def _place_samples(self, free, nearness, obstacles):
        """One sample in each square of the lattice, at a random place; those that the brush can reach are inside."""
        generator = np.random.default_rng(1)
        up, right = generator.random((2, *free.shape), np.float32)
        below = (1.0 - right) * nearness[:-1, :-1] + right * nearness[:-1, 1:]
        above = (1.0 - right) * nearness[1:, :-1] + right * nearness[1:, 1:]
        self._inside = free & ((1.0 - up) * below + up * above <= 0.5 * self._brush)
        for is_there in obstacles:
            rows, columns = np.indices(free.shape, sparse=True)
            self._inside &= ~is_there(self._origin[0] + self._step * (columns + right),
                                      self._origin[1] + self._step * (rows + up))
        self._up, self._right = up, right
        self._passed = np.zeros(free.shape, bool)
        self.area = np.count_nonzero(self._inside) * self._step ** 2

    # --- what was passed ----------------------------------------------------------------------------------------------

    def _lay(self, triangles):
        """Mark the samples in triangles, float64 (any, 3, 2) [m]."""
        triangles = (triangles - self._origin) / self._step
        for begin in range(0, len(triangles), CHUNK):
            self._lay_some(triangles[begin:begin + CHUNK])

    def _lay_some(self, triangles):
        corner = np.floor(triangles.min(axis=1)).astype(int)
        reach = int((np.ceil(triangles.max(axis=1)).astype(int) - corner).max())
        shape = np.array(self._passed.shape)
        for up in range(reach):
            for right in range(reach):
                columns, rows = (corner + (right, up)).T
                on_map = (rows >= 0) & (columns >= 0) & (rows < shape[0]) & (columns < shape[1])
                rows, columns, those = rows[on_map], columns[on_map], triangles[on_map]
                x, y = columns + self._right[rows, columns], rows + self._up[rows, columns]
                inside = _holds(those, x, y)
                self._passed[rows[inside], columns[inside]] = True


def _refined(poses):
    """Poses with others between them where the robot turns."""
    counts = np.maximum(np.ceil(np.abs(np.diff(poses[:, 2])) / FINEST).astype(int), 1)
    places = np.concatenate([np.arange(count) / count + index for index, count in enumerate(counts)] or [[]])
    places = np.append(places, len(poses) - 1)
    return np.stack([np.interp(places, np.arange(len(poses)), values) for values in poses.T], axis=1)


def _holds(triangles, x, y):
    """Whether each triangle holds the point with its number."""
    sides = []
    for one, other in ((0, 1), (1, 2), (2, 0)):
        (from_x, from_y), (to_x, to_y) = triangles[:, one].T, triangles[:, other].T
        sides.append((to_x - from_x) * (y - from_y) - (to_y - from_y) * (x - from_x))
    return (np.min(sides, axis=0) >= 0.0) | (np.max(sides, axis=0) <= 0.0)


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
        keeps = float(self._world.constants[0]['reach'])  # [m] from walls
        found = Judge(free, plan.resolution, plan.origin, self._world.start[:2], keeps, robot.brush.width,
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
