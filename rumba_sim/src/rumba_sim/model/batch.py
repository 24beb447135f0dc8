"""Steps and sensors of many worlds in one call: the loops over worlds around the kernel.

This is plain Python that `compiled` hands to numba, as the kernel is. No world reads what belongs to another, so that
several threads may each take a part of them.

Arguments that the functions share. Each row belongs to one world; it may be longer than what the world needs.
    first, last: the part of `order` that the call is about, `last` not included.
    order: int64 (any), the numbers of worlds. What sensors receive is in this order.
    robots: (worlds) records of type ROBOT: each world has one robot.
    constants: (worlds) records `constants.Constants`.
    obstacles: (worlds, any) records of type OBSTACLE, of which the first `counts[world]` are there.
    plans: int64 (worlds), which row of `fields`, `cells` and `skips` belongs to a world; worlds on one plan share it.
    shapes: int64 (worlds, 3), rows and columns of the cells, and the squares of samples along the side of a cell.
    fields, cells, skips, samples, dirt: what the kernel calls so, row by row, in one row of a world or of a plan.
"""

import math
from typing import Tuple

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.kernel import Array, Record

NO_FLOOR = kernel.BLOCKED | kernel.CLIFF
ANY_BUT_SWEEPABLE = 0xFF - kernel.SWEEPABLE  # bits of a sample; only REACHABLE is left if it can be reached and is unswept


def advance(first: int, last: int, order: Array, ticks: Array, spans: Array, robots: Array, constants: Array,
            obstacles: Array, counts: Array, stops: Array, moving: Array, plans: Array, shapes: Array, fields: Array, cells: Array,
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
    for world in order[first:last]:
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


def scan(first: int, last: int, order: Array, robots: Array, constants: Array, obstacles: Array, counts: Array,
         plans: Array, shapes: Array, cells: Array, skips: Array, fan: Array, noise: Array, ranges: Array) -> None:
    """Measure with the laser of each robot.

    Args, apart from those above:
        fan: float64 (beams, 2), as for the kernel.
        noise: float64 (any, beams), standard normal.
        ranges: float64 (any, beams), receives the measured distances.
    """
    for index in range(first, last):
        world = order[index]
        floor, skip = floor_of(plans[world], shapes[world], cells, skips)
        kernel.scan(robots[world:world + 1], 0, constants[world], obstacles[world, :counts[world]], skip, floor, fan,
                    noise[index], ranges[index])


def infrared(first: int, last: int, order: Array, robots: Array, constants: Array, plans: Array, shapes: Array,
             cells: Array, skips: Array, beams: Array) -> None:
    """What the receivers of each robot get from the dock: `beams`, uint8 (any, 3), receives omni, left, right."""
    for index in range(first, last):
        world = order[index]
        floor, skip = floor_of(plans[world], shapes[world], cells, skips)
        beams[index, 0], beams[index, 1], beams[index, 2] = kernel.infrared(robots[world], constants[world], skip,
                                                                            floor)


def cliffs(first: int, last: int, order: Array, robots: Array, constants: Array, plans: Array, shapes: Array,
           cells: Array, distances: Array, angles: Array, seen: Array) -> None:
    """Whether there is no floor under the cliff sensors of each robot.

    Args, apart from those above:
        distances: float64 (worlds), of the sensors from the centre of the robot [m].
        angles: float64 (worlds, 4), of the sensors from straight ahead [rad].
        seen: bool (any, 4), receives the answer.
    """
    for index in range(first, last):
        world = order[index]
        floor, _ = floor_of(plans[world], shapes[world], cells, cells)
        robot, k = robots[world], constants[world]
        for sensor in range(angles.shape[1]):
            along = robot.theta + angles[world, sensor]
            seen[index, sensor] = k.has_layers and kernel.cell_bits(
                k, floor, robot.x + distances[world] * math.cos(along),
                robot.y + distances[world] * math.sin(along)) & kernel.CLIFF != 0


def surroundings(first: int, last: int, order: Array, robots: Array, constants: Array, plans: Array, shapes: Array,
                 cells: Array, samples: Array, pitches: Array, points: Array, maps: Array) -> None:
    """Draw the floor around each robot, which looks up in the middle of its maps.

    Args, apart from those above:
        pitches: float64 (scales), side of a pixel [m].
        points: int64 (scales), a pixel is the mean of so many points along each of its sides.
        maps: uint8 (any, scales, 2, size, size), receives 255 times the share of each pixel that is no floor, and that
            of floor that the brush can reach and has not passed over yet. Row 0 is ahead, column 0 is to the left.
    """
    for index in range(first, last):
        world = order[index]
        high, wide = shapes[world, 0] * shapes[world, 2], shapes[world, 1] * shapes[world, 2]
        floor, _ = floor_of(plans[world], shapes[world], cells, cells)
        sample = samples[world, :high * wide].reshape((high, wide))
        for scale in range(len(pitches)):
            draw(robots[world], constants[world], shapes[world, 2], floor, sample, pitches[scale], points[scale],
                 maps[index, scale])


def draw(robot: Record, k: Record, squares: int, cells: Array, samples: Array, pitch: float, points: int,
         picture: Array) -> None:
    """Draw one of the maps of `surroundings`: `picture`, uint8 (2, size, size)."""
    size, share = picture.shape[1], 255.0 / (points * points)
    step = pitch / points / k.resolution  # from point to point [cells]
    along_u, along_v = math.cos(robot.theta) * step, math.sin(robot.theta) * step
    first = 0.5 * size * points - 0.5
    first_u = (robot.x - k.origin_x) / k.resolution + first * along_u - first * along_v
    first_v = (robot.y - k.origin_y) / k.resolution + first * along_v + first * along_u
    for row in range(size):
        for column in range(size):
            blocked, unswept = 0, 0
            for back in range(row * points, (row + 1) * points):
                for right in range(column * points, (column + 1) * points):
                    u = first_u - back * along_u + right * along_v
                    v = first_v - back * along_v - right * along_u
                    if 0.0 <= u < cells.shape[1] and 0.0 <= v < cells.shape[0] and not (
                            cells[np.uint32(v), np.uint32(u)] & NO_FLOOR):
                        sample = samples[np.uint32(v * squares), np.uint32(u * squares)]
                        unswept += sample & ANY_BUT_SWEEPABLE == kernel.REACHABLE
                    else:
                        blocked += 1
            picture[0, row, column] = np.uint8(blocked * share + 0.5)
            picture[1, row, column] = np.uint8(unswept * share + 0.5)


def floor_of(plan: int, shape: Array, cells: Array, skips: Array) -> Tuple[Array, Array]:
    """The cells of a world, and how many a beam may skip there, in rows and columns."""
    rows, columns = shape[0], shape[1]
    return (cells[plan, :rows * columns].reshape((rows, columns)),
            skips[plan, :rows * columns].reshape((rows, columns)))
