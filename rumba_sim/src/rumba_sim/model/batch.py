"""Steps and sensors of many worlds in one call: the loops over worlds around the kernel.

This is plain Python that `compiled` hands to numba, as the kernel is. No world reads what belongs to another, so that
several threads may each advance a part of them, from world `first` up to world `last`, not included.

Arguments that the functions share. Each row belongs to one world; it may be longer than what the world needs.
    robots: (worlds) records of type ROBOT: each world has one robot.
    constants: (worlds) records `constants.Constants`.
    obstacles: (worlds, any) records of type OBSTACLE, of which the first `counts[world]` are there.
    plans: int64 (worlds), which row of `fields`, `cells` and `skips` belongs to a world; worlds on one plan share it.
    shapes: int64 (worlds, 3), rows and columns of the cells, and the squares of samples along the side of a cell.
    fields, cells, skips, samples, dirt: what the kernel calls so, row by row, in one row of a world or of a plan.
"""

import math
from typing import Tuple

from rumba_sim.model import kernel
from rumba_sim.model.kernel import Array


def advance(first: int, last: int, ticks: Array, spans: Array, robots: Array, constants: Array, obstacles: Array,
            counts: Array, stops: Array, moving: Array, plans: Array, shapes: Array, fields: Array, cells: Array,
            samples: Array, dirt: Array, tallies: Array, noise: Array) -> None:
    """Advance each world by a number of ticks of its own.

    Args, apart from those above:
        ticks: int64 (worlds), the number of the next tick.
        spans: int64 (worlds), how many ticks to simulate.
        stops: float64 (worlds, any, 6), the stops of its movers.
        moving: bool (worlds), whether it has movers.
        tallies: (worlds) records of type TALLY.
        noise: float64 (worlds, 1, any, 2), standard normal, as for the kernel.
    """
    for world in range(first, last):
        rows, columns = shapes[world, 0], shapes[world, 1]
        high, wide = rows * shapes[world, 2], columns * shapes[world, 2]
        field = fields[plans[world], :(rows + 1) * (columns + 1)].reshape((rows + 1, columns + 1))
        floor = cells[plans[world], :rows * columns].reshape((rows, columns))
        sample = samples[world, :high * wide].reshape((high, wide))
        dirty = dirt[world, :rows * columns].reshape((rows, columns))
        robot, k, tally = robots[world:world + 1], constants[world:world + 1], tallies[world:world + 1]
        things = obstacles[world, :counts[world]]
        if not moving[world]:
            kernel.advance(robot, k, things, field, floor, sample, dirty, tally, noise[world], ticks[world],
                           spans[world])
            continue
        for tick in range(ticks[world], ticks[world] + spans[world]):
            kernel.go(things, stops[world], robot, k[0])
            kernel.advance(robot, k, things, field, floor, sample, dirty, tally, noise[world], tick, 1)


def scan(first: int, last: int, robots: Array, constants: Array, obstacles: Array, counts: Array, plans: Array,
         shapes: Array, cells: Array, skips: Array, fan: Array, noise: Array, ranges: Array) -> None:
    """Measure with the laser of each robot.

    Args, apart from those above:
        fan: float64 (beams, 2), as for the kernel.
        noise: float64 (worlds, beams), standard normal.
        ranges: float64 (worlds, beams), receives the measured distances.
    """
    for world in range(first, last):
        floor, skip = floor_of(plans[world], shapes[world], cells, skips)
        kernel.scan(robots[world:world + 1], 0, constants[world], obstacles[world, :counts[world]], skip, floor, fan,
                    noise[world], ranges[world])


def infrared(first: int, last: int, robots: Array, constants: Array, plans: Array, shapes: Array, cells: Array,
             skips: Array, beams: Array) -> None:
    """What the receivers of each robot get from the dock: `beams`, uint8 (worlds, 3), receives omni, left, right."""
    for world in range(first, last):
        floor, skip = floor_of(plans[world], shapes[world], cells, skips)
        beams[world, 0], beams[world, 1], beams[world, 2] = kernel.infrared(robots[world], constants[world], skip,
                                                                            floor)


def cliffs(first: int, last: int, robots: Array, constants: Array, plans: Array, shapes: Array, cells: Array,
           distances: Array, angles: Array, seen: Array) -> None:
    """Whether there is no floor under the cliff sensors of each robot.

    Args, apart from those above:
        distances: float64 (worlds), of the sensors from the centre of the robot [m].
        angles: float64 (worlds, 4), of the sensors from straight ahead [rad].
        seen: bool (worlds, 4), receives the answer.
    """
    for world in range(first, last):
        floor, _ = floor_of(plans[world], shapes[world], cells, cells)
        robot, k = robots[world], constants[world]
        for sensor in range(angles.shape[1]):
            along = robot.theta + angles[world, sensor]
            seen[world, sensor] = k.has_layers and kernel.cell_bits(
                k, floor, robot.x + distances[world] * math.cos(along),
                robot.y + distances[world] * math.sin(along)) & kernel.CLIFF != 0


def floor_of(plan: int, shape: Array, cells: Array, skips: Array) -> Tuple[Array, Array]:
    """The cells of a world, and how many a beam may skip there, in rows and columns."""
    rows, columns = shape[0], shape[1]
    return (cells[plan, :rows * columns].reshape((rows, columns)),
            skips[plan, :rows * columns].reshape((rows, columns)))
