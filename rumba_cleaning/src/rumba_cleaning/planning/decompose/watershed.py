"""The watershed of values on a grid (P. Soille, Morphological Image Analysis, 1999), by flooding from seeds, compiled.

That of scikit-image labels nodes of equal height otherwise in each version, and a plan must be the same everywhere.
"""

import heapq
from typing import Any

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

# Rows and columns to the neighbours of a node, the nearest first.
NEIGHBOURS = np.array([(-1, 0), (0, -1), (0, 1), (1, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)])


@compiled
def watershed(heights: Array, seeds: Array, mask: Array) -> Array:
    """The label of each node, int32 (rows, columns); 0 where nothing flows.

    Args:
        heights: what is low is flooded first, and of what is equally high what was reached first; float64 (rows,
            columns).
        seeds: labels of nodes where water comes from, int (rows, columns); 0: none.
        mask: nodes that can be flooded, bool (rows, columns).
    """
    rows, columns = heights.shape
    labels = np.where(mask, seeds, 0).astype(np.int32)
    heap = [(heights[row, column], 0, row, column) for row in range(rows) for column in range(columns)
            if labels[row, column] != 0]
    heapq.heapify(heap)
    age = 0
    while len(heap) > 0:
        _, _, row, column = heapq.heappop(heap)
        for index in range(len(NEIGHBOURS)):
            to_row, to_column = row + NEIGHBOURS[index, 0], column + NEIGHBOURS[index, 1]
            if 0 <= to_row < rows and 0 <= to_column < columns and mask[to_row, to_column] and (
                    labels[to_row, to_column] == 0):
                age += 1
                labels[to_row, to_column] = labels[row, column]
                heapq.heappush(heap, (heights[to_row, to_column], age, to_row, to_column))
    return labels
