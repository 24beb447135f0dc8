"""Steps and sensors of many worlds in one call: the loops over worlds around the kernel.

This is plain Python that `compiled` hands to numba, as the kernel is. No world reads what belongs to another, so that
several threads may each take a part of them.

Arguments that the functions share. Each row belongs to one world; it may be longer than what the world needs.
    first, last: the part of `order` that the call is about, `last` not included.
    order: int64 (any), the numbers of worlds. Worlds on one floor plan are best side by side, since the plan then stays
        in the cache of the processor.
    rows: int64 (any), for each of them the row of the arrays that receive what its sensors measure.
    robots: (worlds) records of type ROBOT: each world has one robot.
    constants: (worlds) records `constants.Constants`.
    obstacles: (worlds, any) records of type OBSTACLE, of which the first `counts[world]` are there.
    plans: int64 (worlds), which row of what belongs to a floor plan belongs to a world; worlds on one plan share it.
    docks: float64 (plans, any, 3), of which the first `dock_counts[plan]` are there.
    shapes: int64 (worlds, 3), rows and columns of the cells, and the squares of samples along the side of a cell.
    fields, cells, skips, samples, dirt: what the kernel calls so, row by row, in one row of a world or of a plan.
"""

import math
from typing import Tuple

import numpy as np

from rumba_sim.model.kernel import Array, Record, ground
from rumba_sim.model.kernel.ground import BLOCKED, CLIFF
from rumba_sim.model.kernel.motion import PUSH
from rumba_sim.model.kernel.sensors import dock, laser
from rumba_sim.model.kernel.sweeping.brush import STRIDE
from rumba_sim.model.kernel.sweeping.samples import REACHABLE, SWEEPABLE
from rumba_sim.model.kernel.ticking import movers, tick

NO_FLOOR, WHOLE = 255, 254  # of a cell: there is no floor; all of its floor is left to be swept
WITHOUT_FLOOR = BLOCKED | CLIFF  # bits of a cell
ANY_BUT_SWEEPABLE = 0xFF - SWEEPABLE  # bits of a sample: REACHABLE and the passes


def advance(first: int, last: int, order: Array, ticks: Array, spans: Array, robots: Array, constants: Array,
            obstacles: Array, counts: Array, stops: Array, moving: Array, plans: Array, docks: Array,
            dock_counts: Array, shapes: Array, fields: Array, cells: Array, samples: Array, dirt: Array, tallies: Array,
            noise: Array) -> None:
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
        stations = docks[plans[world], :dock_counts[plans[world]]]
        if not moving[world]:
            tick.advance(robot, k, things, stations, field, floor, sample, dirty, tally, noise[world], ticks[world],
                         spans[world])
            continue
        for now in range(ticks[world], ticks[world] + spans[world]):
            movers.go(things, stops[world], robot, k[0])
            tick.advance(robot, k, things, stations, field, floor, sample, dirty, tally, noise[world], now, 1)


def scan(first: int, last: int, order: Array, rows: Array, robots: Array, constants: Array, obstacles: Array,
         counts: Array, plans: Array, shapes: Array, skips: Array, fans: Array, noise: Array, biases: Array,
         ranges: Array) -> None:
    """Measure with the laser of each robot.

    Args, apart from those above:
        fans: float64 (1 or 3, beams, 2), as for the kernel.
        noise: float64 (any, 1 or 2, beams), as for the kernel.
        biases: float64 (any), systematic errors of the lasers, in their standard deviations.
        ranges: float64 (any, beams), receives the measured distances.
    """
    for index in range(first, last):
        world, row = order[index], rows[index]
        alone = slice(world, world + 1)
        laser.scan(robots[alone], 0, constants[alone], obstacles[world, :counts[world]],
                   floor_of(skips[plans[world]], shapes[world]), fans, noise[row], biases[row], ranges[row])


def infrared(first: int, last: int, order: Array, rows: Array, robots: Array, constants: Array, plans: Array,
             docks: Array, dock_counts: Array, shapes: Array, skips: Array, beams: Array) -> None:
    """What the receivers of each robot get from the docks: `beams`, uint8 (any, 3), receives omni, left, right."""
    for index in range(first, last):
        world, row = order[index], rows[index]
        beams[row, 0], beams[row, 1], beams[row, 2] = dock.infrared(
            robots, world, constants[world:world + 1], docks[plans[world], :dock_counts[plans[world]]],
            floor_of(skips[plans[world]], shapes[world]))


def cliffs(first: int, last: int, order: Array, rows: Array, robots: Array, constants: Array, plans: Array,
           shapes: Array, cells: Array, seen: Array) -> None:
    """Whether the cliff sensors of each robot see a cliff, or hold one that they saw.

    Args, apart from those above:
        seen: bool (any, 4), receives the answer.
    """
    for index in range(first, last):
        world, row = order[index], rows[index]
        floor = floor_of(cells[plans[world]], shapes[world])
        ground.cliffs(robots, world, constants[world:world + 1], floor, seen[row])


def surroundings(first: int, last: int, order: Array, rows: Array, robots: Array, constants: Array, plans: Array,
                 shapes: Array, cells: Array, samples: Array, left: Array, known: Array, pitches: Array, points: Array,
                 maps: Array) -> None:
    """Draw the floor around each robot, which looks up in the middle of its maps.

    Args, apart from those above:
        left: uint8 (worlds, any), what is left to be swept of each cell of a world, as `look` counts it; up to date
            except where the robot has been since.
        known: float64 (worlds, 3), x, y and driven distance [m] of the robot at that time; NaN if `left` is not known.
        pitches: float64 (scales), side of a pixel [m].
        points: int64 (scales), a pixel is the mean of so many points along each of its sides.
        maps: uint8 (any, scales, 2, size, size), receives 255 times the share of each pixel that is no floor, and that
            of floor that the brush can reach and has not passed over yet. Row 0 is ahead, column 0 is to the left.
    """
    for index in range(first, last):
        world, row = order[index], rows[index]
        squares = shapes[world, 2]
        high, wide = shapes[world, 0] * squares, shapes[world, 1] * squares
        floor, dirty = floor_of(cells[plans[world]], shapes[world]), floor_of(left[world], shapes[world])
        sample = samples[world, :high * wide].reshape((high, wide))
        look(robots[world], constants[world], squares, floor, sample, dirty, known[world])
        for scale in range(len(pitches)):
            draw(robots[world], constants[world], dirty, pitches[scale], points[scale], maps[row, scale])


def look(robot: Record, k: Record, squares: int, cells: Array, samples: Array, left: Array, known: Array) -> None:
    """Bring `left` up to date: NO_FLOOR, or the share of the cell that can be reached and is not swept, 0 to WHOLE.

    The robot can have swept only what is near the way that it drove since the last time.
    """
    from_row, from_column, to_row, to_column = 0, 0, left.shape[0], left.shape[1]
    driven = robot.distance - known[2]
    if math.hypot(robot.x - known[0], robot.y - known[1]) <= driven + PUSH:  # false if it is NaN
        near = driven + 0.5 * k.brush_width + 2.0 * STRIDE
        from_row = max(int((known[1] - near - k.origin_y) / k.resolution), 0)
        from_column = max(int((known[0] - near - k.origin_x) / k.resolution), 0)
        to_row = min(int((known[1] + near - k.origin_y) / k.resolution) + 1, to_row)
        to_column = min(int((known[0] + near - k.origin_x) / k.resolution) + 1, to_column)
    share = WHOLE / (squares * squares)
    for row in range(from_row, to_row):
        for column in range(from_column, to_column):
            count = 0
            for i in range(row * squares, (row + 1) * squares):
                for j in range(column * squares, (column + 1) * squares):
                    count += samples[i, j] & ANY_BUT_SWEEPABLE == REACHABLE
            left[row, column] = NO_FLOOR if cells[row, column] & WITHOUT_FLOOR else np.uint8(count * share + 0.5)
    known[0], known[1], known[2] = robot.x, robot.y, robot.distance


def draw(robot: Record, k: Record, left: Array, pitch: float, points: int, picture: Array) -> None:
    """Draw one of the maps of `surroundings`: `picture`, uint8 (2, size, size)."""
    size, share, part = picture.shape[1], 255.0 / (points * points), 255.0 / (points * points * WHOLE)
    step = pitch / points / k.resolution  # from point to point [cells]
    along_u, along_v = math.cos(robot.theta) * step, math.sin(robot.theta) * step
    first = 0.5 * size * points - 0.5
    first_u = (robot.x - k.origin_x) / k.resolution + first * along_u - first * along_v
    first_v = (robot.y - k.origin_y) / k.resolution + first * along_v + first * along_u
    floor, dirty = np.empty(size * points, np.int32), np.empty(size * points, np.int32)
    for row in range(size):
        floor[:], dirty[:] = 0, 0
        for back in range(row * points, (row + 1) * points):
            see_line(left, first_u - back * along_u, first_v - back * along_v, along_v, -along_u, floor, dirty)
        for column in range(size):
            blocked, total = points * points, 0
            for point in range(column * points, (column + 1) * points):
                blocked -= floor[point]
                total += dirty[point]
            picture[0, row, column] = np.uint8(blocked * share + 0.5)
            picture[1, row, column] = np.uint8(total * part + 0.5)


def see_line(left: Array, u: float, v: float, step_u: float, step_v: float, floor: Array, dirty: Array) -> None:
    """Look at points from (u, v) on, by steps [cells]: add 1 to `floor` where there is some, and to `dirty` its `left`.

    `floor` and `dirty` are int32 (points).
    """
    first, last = within(u, step_u, left.shape[1], 0, len(floor))
    first, last = within(v, step_v, left.shape[0], first, last)
    for point in range(first, last):
        seen = int(left[np.uint32(v + point * step_v), np.uint32(u + point * step_u)])
        is_floor = int(seen != NO_FLOOR)
        floor[point] += is_floor
        dirty[point] += is_floor * seen


def within(start: float, step: float, limit: int, first: int, last: int) -> Tuple[int, int]:
    """Which of the whole numbers n from `first` on and below `last` have 0 <= start + n * step < limit: from, to."""
    if step != 0.0:
        enter, leave = -start / step, (limit - start) / step
        low, high = min(enter, leave), max(enter, leave)
        first, last = (int(math.ceil(min(max(low, float(first)), float(last)))),
                       int(math.floor(min(max(high, first - 1.0), last - 1.0))) + 1)
    while first < last and not 0.0 <= start + first * step < limit:
        first += 1
    while first < last and not 0.0 <= start + (last - 1) * step < limit:
        last -= 1
    return first, last


def floor_of(row: Array, shape: Array) -> Array:
    """A row of an array such as `cells`, in the rows and columns of the floor."""
    return row[:shape[0] * shape[1]].reshape((shape[0], shape[1]))
