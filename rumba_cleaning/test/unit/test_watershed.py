"""The watershed floods what is low first, and what is equally high in the order in which it is reached."""

import numpy as np
import pytest

from rumba_cleaning.planning.decompose.watershed import NEIGHBOURS, watershed


def flooded(heights, seeds, mask):
    """The same by the definition."""
    labels = np.where(mask, seeds, 0)
    reached = [(heights[node], 0, node) for node in map(tuple, np.argwhere(labels).tolist())]
    age = 0
    while reached:
        first = min(reached)
        reached.remove(first)
        for step in NEIGHBOURS:
            node = tuple((np.array(first[2]) + step).tolist())
            if (0, 0) <= node and min(node) >= 0 and np.less(node, heights.shape).all() and mask[node] and (
                    labels[node] == 0):
                labels[node] = labels[first[2]]
                age += 1
                reached.append((heights[node], age, node))
    return labels


def example(seed, shape, heights):
    """Heights, seeds and mask."""
    random = np.random.default_rng(seed)
    return (random.integers(0, heights, shape) if heights else random.random(shape),
            np.where(random.random(shape) < 0.03, random.integers(1, 9, shape), 0), random.random(shape) < 0.8)


@pytest.mark.parametrize('seed', range(10))
@pytest.mark.parametrize('different', [0, 1, 4])
def test_it_floods_by_the_definition_also_where_heights_are_equal(seed, different):
    heights, seeds, mask = example(seed, (17, 23), different)
    labels = watershed(heights, seeds, mask)
    assert labels.dtype == np.int32 and np.array_equal(labels, flooded(heights, seeds, mask))


def test_without_seeds_nothing_is_labelled():
    assert not watershed(np.ones((5, 4)), np.zeros((5, 4), np.int32), np.ones((5, 4), np.bool_)).any()
