"""The search for paths on the grid of the ground, compiled by numba."""

import heapq
import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

STEPS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))  # rows, columns
NONE = -1  # the step to a node that was not reached
LESS = 1e-9  # [nodes] a shorter path: more than rounding errors


class Costs(NamedTuple):
    """What a path costs at each node, per unit of its length: 1 in the open, more near to what stands there."""

    clearance: Array  # float64 (rows, columns) [m]
    is_free: Array  # bool (rows, columns), the nodes over which a path may lead
    touching: float  # [m] the clearance of a robot that touches what stands there, ...
    beyond: float  # [m] ... so far beyond which a path costs more, ...
    most: float  # ... and up to how much more than 1


class Lattice(NamedTuple):
    """The nodes over which a path is searched for: in a rectangle, each so many from the next."""

    row: int  # of the first of them
    column: int
    rows: int  # how many there are
    columns: int
    spacing: int  # [nodes]


@compiled
def cost_at(costs: Costs, lattice: Lattice, row: int, column: int) -> float:
    """What a path costs at a node of a lattice; inf if it is not free."""
    at = lattice.row + row * lattice.spacing, lattice.column + column * lattice.spacing
    if not costs.is_free[at]:
        return np.inf
    near = 1.0 - (float(costs.clearance[at]) - costs.touching) / costs.beyond
    return 1.0 + costs.most * min(max(near, 0.0), 1.0)


@compiled
def cheapest(costs: Costs, lattice: Lattice, first: Tuple[int, int], last: Tuple[int, int]) -> Array:
    """The cheapest path between two nodes of a lattice (A*, P. Hart and others, A Formal Basis for the Heuristic
    Determination of Minimum Cost Paths, 1968).

    Args:
        costs: of the path.
        lattice: over which it leads.
        first, last: row and column in the lattice; both are free.

    Returns:
        int (any, 2), neighbouring nodes of the lattice; (0, 2) if there is no path.
    """
    costs, lattice = Costs(*costs), Lattice(*lattice)
    shape = lattice.rows, lattice.columns
    reached = np.empty(shape)  # of the nodes that were; most of a large floor is not: to write to all of it takes long
    before = np.full(shape, NONE, np.int8)  # the step that led to a node
    is_left = np.zeros(shape, np.bool_)
    reached[first], before[first] = 0.0, 0
    queue = [(0.0, first[0], first[1])]
    while len(queue) > 0:
        _, row, column = heapq.heappop(queue)
        if row == last[0] and column == last[1]:
            return walked_back(before, first, last)
        if is_left[row, column]:
            continue
        is_left[row, column] = True
        here, cost_here = reached[row, column], cost_at(costs, lattice, row, column)
        for step in range(8):
            down, right = STEPS[step]
            to_row, to_column = row + down, column + right
            if not (0 <= to_row < lattice.rows and 0 <= to_column < lattice.columns):
                continue
            length = math.sqrt(float(down * down + right * right))
            cost = here + 0.5 * length * (cost_here + cost_at(costs, lattice, to_row, to_column))
            least = np.inf if before[to_row, to_column] == NONE else reached[to_row, to_column] - LESS
            if cost < least:
                reached[to_row, to_column] = cost
                before[to_row, to_column] = step
                heapq.heappush(queue, (cost + ahead(last[0] - to_row, last[1] - to_column), to_row, to_column))
    return np.empty((0, 2), np.int64)


@compiled
def ahead(rows: int, columns: int) -> float:
    """Length of the shortest path over so many rows and columns, by steps to any of the eight nodes around one."""
    down, right = abs(rows), abs(columns)
    return max(down, right) + (math.sqrt(2.0) - 1.0) * min(down, right)


@compiled
def path_lengths(is_free: Array, row: int, column: int) -> Array:
    """Length of the shortest path from each node to one of them (E. W. Dijkstra, A Note on Two Problems in Connexion
    with Graphs, 1959).

    Args:
        is_free: bool (rows, columns), the nodes over which a path may lead.
        row, column: the node to which all paths lead; it is free.

    Returns:
        float64 (rows, columns) [nodes]; inf at nodes from which no path leads there.
    """
    rows, columns = is_free.shape
    lengths = np.full(is_free.shape, np.inf)
    lengths[row, column] = 0.0
    queue = [(0.0, row, column)]
    while len(queue) > 0:
        length, row, column = heapq.heappop(queue)
        if length > lengths[row, column]:
            continue
        for step in range(8):
            down, right = STEPS[step]
            to_row, to_column = row + down, column + right
            if 0 <= to_row < rows and 0 <= to_column < columns and is_free[to_row, to_column]:
                longer = length + math.sqrt(float(down * down + right * right))
                if longer < lengths[to_row, to_column]:
                    lengths[to_row, to_column] = longer
                    heapq.heappush(queue, (longer, to_row, to_column))
    return lengths


@compiled
def is_clear(values: Array, origin: Tuple[float, float], resolution: float, start: Tuple[float, float],
             end: Tuple[float, float], least: float) -> bool:
    """Whether no node along a straight line, from point to point [m], has too small a value.

    Args:
        values: of the nodes (rows, columns): of a clearance, or whether they are free.
        origin: position of the first node [m].
        resolution: from node to node [m].
        start, end: of the line [m].
        least: the smallest value that is not too small.
    """
    steps = int(math.hypot(end[0] - start[0], end[1] - start[1]) / (0.5 * resolution)) + 1
    step = 1.0 / steps
    rows, columns = values.shape
    for count in range(steps + 1):
        share = 1.0 if count == steps else count * step
        x, y = start[0] * (1.0 - share) + end[0] * share, start[1] * (1.0 - share) + end[1] * share
        row, column = int(np.rint((y - origin[1]) / resolution)), int(np.rint((x - origin[0]) / resolution))
        if values[min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)] < least:
            return False
    return True


@compiled
def walked_back(before: Array, first: Tuple[int, int], last: Tuple[int, int]) -> Array:
    """The path to `last`, if `before` holds for each node the step that led to it."""
    count, row, column = 1, last[0], last[1]
    while row != first[0] or column != first[1]:
        down, right = STEPS[before[row, column]]
        row, column, count = row - down, column - right, count + 1
    path = np.empty((count, 2), np.int64)
    row, column = last[0], last[1]
    for index in range(count - 1, -1, -1):
        path[index, 0], path[index, 1] = row, column
        if index:
            down, right = STEPS[before[row, column]]
            row, column = row - down, column - right
    return path
