"""The watershed floods what is low first, and what is equally high in the order in which it is reached."""

import numpy as np
import pytest
import skimage
from skimage import segmentation

from rumba_cleaning.planning.decompose.watershed import NEIGHBOURS, watershed


def flooded(heights, seeds, mask):
    """The same by the definition, for heights that all differ."""
    labels = np.where(mask, seeds, 0)
    reached = [(heights[node], 0, node) for node in map(tuple, np.argwhere(labels).tolist())]
    while reached:
        first = min(reached)
        reached.remove(first)
        for step in NEIGHBOURS:
            node = tuple((np.array(first[2]) + step).tolist())
            if (0, 0) <= node and min(node) >= 0 and np.less(node, heights.shape).all() and mask[node] and (
                    labels[node] == 0):
                labels[node] = labels[first[2]]
                reached.append((heights[node], len(reached), node))
    return labels


def example(seed, shape, heights):
    """Heights, seeds and mask."""
    random = np.random.default_rng(seed)
    return (random.integers(0, heights, shape) if heights else random.random(shape),
            np.where(random.random(shape) < 0.03, random.integers(1, 9, shape), 0), random.random(shape) < 0.8)


@pytest.mark.parametrize('seed', range(10))
def test_it_floods_by_the_definition(seed):
    heights, seeds, mask = example(seed, (17, 23), 0)
    labels = watershed(heights, seeds, mask)
    assert labels.dtype == np.int32 and np.array_equal(labels, flooded(heights, seeds, mask))


@pytest.mark.skipif(not skimage.__version__.startswith('0.19.'), reason='other versions flood in another order')
@pytest.mark.parametrize('seed', range(10))
@pytest.mark.parametrize('heights', [0, 1, 4])
def test_it_is_that_of_scikit_image_also_where_heights_are_equal(seed, heights):
    case = example(seed, (60, 50), heights)
    expected = segmentation.watershed(case[0], case[1], connectivity=2, mask=case[2])
    assert np.array_equal(watershed(*case), expected)


def test_without_seeds_nothing_is_labelled():
    assert not watershed(np.ones((5, 4)), np.zeros((5, 4), np.int32), np.ones((5, 4), np.bool_)).any()
