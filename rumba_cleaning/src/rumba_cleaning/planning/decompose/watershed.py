"""The watershed of values on a grid (P. Soille, Morphological Image Analysis, 1999), by flooding from seeds, compiled.

The same labels as those of skimage.segmentation.watershed 0.19 with connectivity 2, also where values are equal.
Importing that module, with all that it imports, took a tenth of the time for the first plan of a node.
"""

from typing import Any

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

# Rows and columns to the neighbours of a node, the nearest first.
NEIGHBOURS = np.array([(-1, 0), (0, -1), (0, 1), (1, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)])


def watershed(heights: Array, seeds: Array, mask: Array) -> Array:
    """The label of each node, int32 (rows, columns); 0 where nothing flows.

    Args:
        heights: what is low is flooded first, float (rows, columns).
        seeds: labels of nodes where water comes from, int (rows, columns); 0: none.
        mask: nodes that can be flooded, bool (rows, columns).
    """
    rim = ((1, 1), (1, 1))  # outside of the mask
    labels = np.pad(np.where(mask, seeds, 0).astype(np.int32), rim)
    flood(np.pad(heights.astype(np.float64), rim), np.pad(mask, rim), labels)
    return labels[1:-1, 1:-1].copy()


@compiled
def flood(heights: Array, mask: Array, labels: Array) -> None:
    """Label what can be flooded, in the order of heights, and at equal heights what was reached first.

    Args:
        heights: float64 (rows, columns); mask: bool, False all along the rim.
        labels: int32, those of the seeds; receives those of all others.
    """
    rows, columns = labels.shape
    nodes, ages = np.empty(rows * columns, np.int64), np.empty(rows * columns, np.int64)  # the heap
    flat = heights.copy().reshape(-1)
    size = 0
    for row in range(rows):
        for column in range(columns):
            if labels[row, column] != 0:
                push(nodes, ages, size, flat, row * columns + column, 0)
                size += 1
    age = 0
    while size > 0:
        row, column = nodes[0] // columns, nodes[0] % columns
        size -= 1
        pop(nodes, ages, size, flat)
        for index in range(len(NEIGHBOURS)):
            to_row, to_column = row + NEIGHBOURS[index, 0], column + NEIGHBOURS[index, 1]
            if mask[to_row, to_column] and labels[to_row, to_column] == 0:
                age += 1
                labels[to_row, to_column] = labels[row, column]
                push(nodes, ages, size, flat, to_row * columns + to_column, age)
                size += 1


@compiled
def push(nodes: Array, ages: Array, size: int, heights: Array, node: int, age: int) -> None:
    """Add a node of an age to a heap of so many."""
    place = size
    nodes[place], ages[place] = node, age
    while place > 0 and is_before(nodes, ages, heights, place, (place - 1) // 2):
        swap(nodes, ages, place, (place - 1) // 2)
        place = (place - 1) // 2


@compiled
def pop(nodes: Array, ages: Array, size: int, heights: Array) -> None:
    """Take the first one from a heap, of which so many are left."""
    nodes[0], ages[0] = nodes[size], ages[size]
    place = 0
    while True:
        first = place
        for child in (2 * place + 1, 2 * place + 2):
            if child < size and is_before(nodes, ages, heights, child, first):
                first = child
        if first == place:
            return
        swap(nodes, ages, place, first)
        place = first


@compiled
def is_before(nodes: Array, ages: Array, heights: Array, one: int, other: int) -> bool:
    """Whether the node at one place of a heap is flooded before that at another."""
    mine, theirs = heights[nodes[one]], heights[nodes[other]]
    return bool(mine < theirs or mine == theirs and ages[one] < ages[other])


@compiled
def swap(nodes: Array, ages: Array, one: int, other: int) -> None:
    """Exchange two places of a heap."""
    nodes[one], nodes[other] = nodes[other], nodes[one]
    ages[one], ages[other] = ages[other], ages[one]
