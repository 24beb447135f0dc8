"""A judge of coverage that shares no code with the simulator: by NumPy and SciPy alone, from cells and poses.

The simulator asks the clearance, interpolated between the nodes of its cells; the judge measures exact distances on a
lattice of about 1 cm, and lays triangles over what the brush passes.
"""

import math

import numpy as np
from scipy import ndimage

LATTICE = 0.01  # [m] between two points, at most
SLACK = 0.003  # [m] on each side of a robot that drives through a passage
LEVEL = 0.0005  # [m] steps in which positions beside the points of the lattice are looked for
FINEST = 0.02  # [rad] of a turn in one triangle
CHUNK = 20_000  # triangles at a time
ALL_AROUND = np.ones((3, 3))


class Judge:
    """What a robot can reach of a floor, and how much of that its brush has passed.

    Attributes:
        area: what the brush can reach [m^2].
        parts: the areas of positions of all parts between which the robot cannot drive, the largest first [m^2].
    """

    def __init__(self, free, resolution, origin, radius, brush, start=None):
        """Find what can be reached.

        Args:
            free: bool (rows, columns), row 0 at the bottom: floor without obstacles.
            resolution: side of a cell [m].
            origin: (x, y) of the lower left corner [m].
            radius: of the robot [m].
            brush: width of the brush [m].
            start: (x, y) in the part that counts [m]; None for the largest part.
        """
        self._origin, self._brush = np.array(origin, float), brush
        count = math.ceil(resolution / LATTICE - 1e-6)
        self._step = resolution / count
        away = self._distances(np.asarray(free, bool), count)
        labels, number = ndimage.label(away >= radius + SLACK - 1e-9, ALL_AROUND)
        sizes = np.bincount(labels.ravel(), minlength=number + 1)[1:]
        self.parts = np.sort(sizes)[::-1] * self._step ** 2
        part = int(np.argmax(sizes)) + 1 if start is None else self._part_at(labels, start)
        self._place_samples(free.repeat(count, 0).repeat(count, 1), self._nearness(away, labels == part, radius))

    @property
    def coverage(self):
        """Share of what can be reached that was passed [0..1]."""
        return np.count_nonzero(self._passed & self._inside) / max(np.count_nonzero(self._inside), 1)

    def sweep(self, poses):
        """Have the brush pass along poses, float64 (any, 3) [m, m, rad], near to each other."""
        poses = np.array(poses, float)
        poses[:, 2] = np.unwrap(poses[:, 2])
        moved = np.concatenate([[True], np.any(poses[1:] != poses[:-1], axis=1)])
        poses = _refined(poses[moved])
        across = 0.5 * self._brush * np.stack([-np.sin(poses[:, 2]), np.cos(poses[:, 2])], axis=1)
        for side in (across, -across):
            centres, tips = poses[:, :2], poses[:, :2] + side
            self._lay(np.stack([centres[:-1], tips[:-1], tips[1:]], axis=1))
            self._lay(np.stack([centres[:-1], tips[1:], centres[1:]], axis=1))

    # --- what can be reached ------------------------------------------------------------------------------------------

    @staticmethod
    def _unit(free, count):
        """Points of the lattice that belong to no obstacle; the nearest point of a square is a point of the lattice."""
        solid = ~np.pad(free.repeat(count, 0).repeat(count, 1), 1, mode='constant')
        return ~(solid[:-1, :-1] | solid[:-1, 1:] | solid[1:, :-1] | solid[1:, 1:])

    def _distances(self, free, count):
        """Distance of each point of the lattice to the nearest obstacle [m]; the map is one beyond its rim."""
        return self._step * ndimage.distance_transform_edt(self._unit(free, count))

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
            stands = near & (away >= radius - lack - 1e-9)
            found = np.minimum(found, self._step * ndimage.distance_transform_edt(~stands) + lack)
        return found

    def _place_samples(self, free, nearness):
        """One sample in each square of the lattice, at a random place; those that the brush can reach are inside."""
        generator = np.random.default_rng(1)
        up, right = generator.random((2, *free.shape), np.float32)
        below = (1.0 - right) * nearness[:-1, :-1] + right * nearness[:-1, 1:]
        above = (1.0 - right) * nearness[1:, :-1] + right * nearness[1:, 1:]
        self._inside = free & ((1.0 - up) * below + up * above <= 0.5 * self._brush)
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
