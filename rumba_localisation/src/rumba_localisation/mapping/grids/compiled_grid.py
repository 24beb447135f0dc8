"""What scans tell of the cells of a grid: plain functions over arrays, compiled by numba.

Arguments that functions share:
    odds: float32 (rows, columns), logarithm of the odds that a cell is occupied; 0 if nothing is known.
    hits: float32 (rows, columns, 5), for each cell the means over the beams that ended in it: of x and y [cells from
        the corner of the grid], and of the x and y of the directions toward the laser; and the weight of all beams
        that ended in it. Noise scatters hits around a wall, also where beams pass: none is forgotten, or walls would
        be drawn behind where they are.
    field: float32 (rows + 1, columns + 1), signed distance from each node to the nearest wall [m].
"""

import math
from typing import Any, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray
Box = Tuple[int, int, int, int]  # first row, first column, and the row and the column after the last

HIT, MISS = 0.9, -0.5  # logarithms of odds: what more than a third of the beams hit is a wall; our choice
MOST = 4.0  # the largest, so that what has changed is believed after some scans
BESIDE = 3  # [cells] around a cell to which a line is fitted
STRAIGHT, THIN = 1.0, 0.2  # [cells^2] variance along a line, at least, and that across in units of it, at most
ENOUGH = 20.0  # weight of the beams over which the means in a cell are taken, at most: after that they do not drift


@compiled
def add_beams(odds: Array, hits: Array, x: float, y: float, ends: Array, weights: Array, has_echo: bool) -> Box:
    """Take beams into account: the cells that they pass are free, those in which they end are occupied.

    Args, apart from those above:
        x, y: of the laser [cells from the corner of the grid].
        ends: float64 (beams, 2), where they end, on the grid [cells from its corner].
        weights: float64 (beams), 1 for a beam that is as exact as any, less for one that errs more.
        has_echo: whether they end at something.

    Returns:
        The box of the cells that became occupied, or are no longer; empty if its rows are none.
    """
    rows, columns = odds.shape
    top, left, bottom, right = rows, columns, 0, 0
    for beam in range(len(ends)):
        to_x, to_y = ends[beam, 0], ends[beam, 1]
        column, row = int(math.floor(x)), int(math.floor(y))
        last_column, last_row = int(math.floor(to_x)), int(math.floor(to_y))
        by_x, by_y = to_x - x, to_y - y
        step_column, step_row = 1 if by_x > 0.0 else -1, 1 if by_y > 0.0 else -1
        # The share of the beam at which it crosses the next border, and from border to border (Amanatides, Woo 1987).
        each_x = abs(1.0 / by_x) if by_x != 0.0 else math.inf
        each_y = abs(1.0 / by_y) if by_y != 0.0 else math.inf
        next_x = each_x * ((column + 1 - x) if by_x > 0.0 else (x - column)) if by_x != 0.0 else math.inf
        next_y = each_y * ((row + 1 - y) if by_y > 0.0 else (y - row)) if by_y != 0.0 else math.inf
        for _ in range(abs(last_column - column) + abs(last_row - row)):
            before = odds[row, column]
            odds[row, column] = max(before + MISS, -MOST)
            if before > 0.0 and odds[row, column] <= 0.0:
                top, left = min(top, row), min(left, column)
                bottom, right = max(bottom, row + 1), max(right, column + 1)
            if row == last_row or column != last_column and next_x < next_y:
                column, next_x = column + step_column, next_x + each_x
            else:
                row, next_y = row + step_row, next_y + each_y
        if not has_echo:
            continue
        row, column = last_row, last_column
        before = odds[row, column]
        odds[row, column] = min(before + HIT, MOST)
        if before <= 0.0 and odds[row, column] > 0.0:
            top, left = min(top, row), min(left, column)
            bottom, right = max(bottom, row + 1), max(right, column + 1)
        cell = hits[row, column]
        cell[4] += weights[beam]
        if cell[4] < ENOUGH:
            length = math.hypot(by_x, by_y)
            share = weights[beam] / cell[4]
            cell[0] += (to_x - cell[0]) * share
            cell[1] += (to_y - cell[1]) * share
            cell[2] += (-by_x / length - cell[2]) * share
            cell[3] += (-by_y / length - cell[3]) * share
    return top, left, bottom, right


@compiled
def measure(odds: Array, hits: Array, field: Array, box: Box, reach: int, resolution: float) -> None:
    """Measure the signed distances anew, from each node to the wall in the nearest occupied cell.

    They are positive on free floor, and negative behind a wall, so that they cross it smoothly. The nearest cell is
    handed from node to node in two passes (P.-E. Danielsson, Euclidean Distance Mapping, 1980).

    Args, apart from those above:
        box: of the cells that have changed.
        reach: [cells] up to which distances are known; beyond, all are as far.
        resolution: [m]
    """
    rows, columns = odds.shape
    top, left = max(box[0] - reach, 0), max(box[1] - reach, 0)
    bottom, right = min(box[2] + reach, rows), min(box[3] + reach, columns)
    first_row, first_column = max(top - reach, 0), max(left - reach, 0)
    height, width = min(bottom + reach, rows) - first_row, min(right + reach, columns) - first_column
    occupied = np.count_nonzero(odds[first_row:first_row + height, first_column:first_column + width] > 0.0)
    walls = np.empty((occupied, 7))
    nearest = np.full((height + 1, width + 1), -1, np.int32)  # the number of a wall
    squares = np.full((height + 1, width + 1), float(reach * reach))
    count = 0
    for row in range(height):
        for column in range(width):
            if odds[first_row + row, first_column + column] > 0.0:
                fit_line(odds, hits, first_row + row, first_column + column, walls[count])
                walls[count, 0] -= first_column
                walls[count, 1] -= first_row
                walls[count, 2] -= first_column
                walls[count, 3] -= first_row
                for corner in range(4):
                    offer(walls, nearest, squares, row + corner // 2, column + corner % 2, count)
                count += 1
    for row in range(height + 1):
        for column in range(width + 1):
            hand_on(walls, nearest, squares, row, column, -1)
        for column in range(width, -1, -1):
            hand_on(walls, nearest, squares, row, column, 0)
    for row in range(height, -1, -1):
        for column in range(width, -1, -1):
            hand_on(walls, nearest, squares, row, column, 1)
        for column in range(width + 1):
            hand_on(walls, nearest, squares, row, column, 0)
    for row in range(top - first_row, bottom - first_row + 1):
        for column in range(left - first_column, right - first_column + 1):
            distance = math.sqrt(squares[row, column])
            if nearest[row, column] >= 0:
                is_free = touches_free(odds, first_row + row, first_column + column)
                distance = signed_distance(walls[nearest[row, column]], float(column), float(row), distance, is_free)
            field[first_row + row, first_column + column] = distance * resolution


@compiled
def fit_line(odds: Array, hits: Array, row: int, column: int, wall: Array) -> None:
    """Fit a line to the hits in the occupied cells around one: the eigenvectors of their covariance.

    Args, apart from those above:
        wall: float64 (7), receives the mean of the hits in the cell itself, a point of the line, its normal toward the
            laser, and whether the hits lie on a line.
    """
    rows, columns = odds.shape
    cell = hits[row, column]
    weight, x, y, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for near_row in range(max(row - BESIDE, 0), min(row + BESIDE + 1, rows)):
        for near_column in range(max(column - BESIDE, 0), min(column + BESIDE + 1, columns)):
            if hits[near_row, near_column, 4] > 0.0:
                near = hits[near_row, near_column]
                along, across = near[0] - cell[0], near[1] - cell[1]
                weight += near[4]
                x += near[4] * along
                y += near[4] * across
                xx += near[4] * along * along
                xy += near[4] * along * across
                yy += near[4] * across * across
    wall[0], wall[1] = cell[0], cell[1]
    x, y = x / weight, y / weight
    xx, xy, yy = xx / weight - x * x, xy / weight - x * y, yy / weight - y * y
    half = math.hypot(0.5 * (xx - yy), xy)
    large, small = 0.5 * (xx + yy) + half, 0.5 * (xx + yy) - half
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    across_x, across_y = -math.sin(angle), math.cos(angle)
    if across_x * cell[2] + across_y * cell[3] < 0.0:
        across_x, across_y = -across_x, -across_y
    wall[2], wall[3], wall[4], wall[5] = cell[0] + x, cell[1] + y, across_x, across_y
    wall[6] = 1.0 if large > STRAIGHT and small < THIN * large else 0.0


@compiled
def hidden(odds: Array, hits: Array, reach: int, found: Array) -> None:
    """Find occupied cells that no beam could have met: on its way stands another one.

    The noise of a laser scatters hits behind a wall, where no beam passes that would tell otherwise.

    Args, apart from those above:
        reach: [cells] before a cell, in which another one is looked for.
        found: bool (rows, columns), receives whether each cell is one.
    """
    rows, columns = odds.shape
    wall = np.empty(7)
    for row in range(rows):
        for column in range(columns):
            found[row, column] = False
            if odds[row, column] <= 0.0:
                continue
            fit_line(odds, hits, row, column, wall)
            x, y = wall[4], wall[5]
            if wall[6] == 0.0:
                length = max(math.hypot(hits[row, column, 2], hits[row, column, 3]), 1e-9)
                x, y = hits[row, column, 2] / length, hits[row, column, 3] / length
            for step in range(2, reach + 1):
                near_row = int(math.floor(row + 0.5 + step * y))
                near_column = int(math.floor(column + 0.5 + step * x))
                if 0 <= near_row < rows and 0 <= near_column < columns and odds[near_row, near_column] > 0.0:
                    found[row, column] = True


@compiled
def signed_distance(wall: Array, x: float, y: float, distance: float, is_free: bool) -> float:
    """Distance from a point to a wall [cells], negative behind it.

    Args:
        wall: float64 (7), as from `fit_line`.
        x, y: the point.
        distance: from it to the mean of the hits.
        is_free: whether it is on free floor, as far as is known.
    """
    by_x, by_y = x - wall[2], y - wall[3]
    off: float = by_x * wall[4] + by_y * wall[5]
    if wall[6] > 0.0:
        aside = abs((x - wall[0]) * wall[5] - (y - wall[1]) * wall[4]) - 1.0
        if aside <= 0.0:
            return off
        distance = math.hypot(off, aside)
    return distance if is_free or off > 0.0 else -distance


@compiled
def touches_free(odds: Array, row: int, column: int) -> bool:
    """Whether any of the four cells around a node is free."""
    rows, columns = odds.shape
    for corner in range(4):
        near_row, near_column = row - corner // 2, column - corner % 2
        if 0 <= near_row < rows and 0 <= near_column < columns and odds[near_row, near_column] < 0.0:
            return True
    return False


@compiled
def offer(walls: Array, nearest: Array, squares: Array, row: int, column: int, number: int) -> None:
    """Let a node know a wall, by its number, if it is nearer than the one that it knows."""
    square = (column - walls[number, 0]) ** 2 + (row - walls[number, 1]) ** 2
    if square < squares[row, column]:
        squares[row, column], nearest[row, column] = square, number


@compiled
def hand_on(walls: Array, nearest: Array, squares: Array, row: int, column: int, step: int) -> None:
    """Let a node know what its neighbours know: those of the row `step` away, or, for 0, those beside it."""
    rows, columns = nearest.shape
    other = row + step
    if not 0 <= other < rows:
        return
    for beside in range(max(column - 1, 0), min(column + 2, columns)):
        number = nearest[other, beside]
        if number >= 0 and number != nearest[row, column]:
            offer(walls, nearest, squares, row, column, number)
