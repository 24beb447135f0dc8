"""From lane to lane by paths that the robot can drive, and all lanes in each variant."""

import numpy as np
import pytest
from floors import along, ground, length
from rooms import distances, room

from rumba_cleaning.planning.swaths.lanes import block_variants, through

PLAN = room(4.0, 3.0)
FLOOR = ground(PLAN)
LANE = 0.17  # [m] from lane to lane


def lanes(*ends, step=LANE, bottom=1.0):
    """Lanes along x, one above the other, each from the first to the second of its ends [m]."""
    return [np.array([[left, bottom + step * index], [right, bottom + step * index]])
            for index, (left, right) in enumerate(ends)]


def between(floor, one, other):
    """Waypoints from one lane to the other, in the variant that begins at the first end of the first lane."""
    path = through(floor, [one, other], 0)
    assert (path[0] == one[0]).all() and (path[-1] == other[0]).all()
    return path[1:-1]


def are_joined_without_bend(path, one, other):
    """Whether a path from lane to lane leads from end to end."""
    return path[0].tolist() == one[1].tolist() and path[-1].tolist() == other[1].tolist()


def test_lanes_side_by_side_are_joined_by_a_straight_line():
    for one, other in (lanes((1.0, 2.5), (1.0, 2.5)), lanes((1.0, 2.0), (1.0, 2.4)), lanes((1.0, 3.7), (1.0, 3.6))):
        path = between(FLOOR, one, other)
        assert len(path) == 2 and are_joined_without_bend(path, one, other)


def test_if_an_obstacle_was_met_between_lanes_the_path_leads_around_it():
    floor = ground(PLAN)
    one, other = lanes((1.0, 2.5), (1.0, 2.5), step=0.5)
    assert len(between(floor, one, other)) == 2
    floor.mark(2.5, 1.25, 0.05)
    path = between(floor, one, other)
    assert len(path) > 2 and length(path) > 0.6


def test_a_path_from_lane_to_lane_leads_around_an_obstacle_between_them():
    plan = room(4.0, 3.0, boxes=[(1.0, 1.3, 3.0, 1.5)])
    floor = ground(plan)
    one, other = np.array([[0.7, 1.0], [2.5, 1.0]]), np.array([[0.7, 1.8], [2.5, 1.8]])
    path = between(floor, one, other)
    assert len(path) >= 4 and min(distances(plan, along(path))) >= floor.reach
    assert 1.6 < length(path) < 2.2


def test_lanes_that_no_path_joins_still_follow_each_other():
    floor = ground(room(4.0, 2.0, boxes=[(1.9, 0.0, 2.1, 2.0)]))
    one, other = np.array([[0.5, 0.5], [0.5, 1.5]]), np.array([[3.0, 0.5], [3.0, 1.5]])
    path = between(floor, one, other)
    assert len(path) == 2 and are_joined_without_bend(path, one, other)


ENDS = ((1.0, 2.5), (1.1, 2.6), (1.0, 2.4), (0.9, 2.5))


@pytest.mark.parametrize('count', [1, 2, 3, 4])
def test_each_variant_drives_all_lanes_to_and_fro_from_another_corner_and_the_next_one_leads_back(count):
    block = lanes(*ENDS[:count])
    variants = [variant.path() for variant in block_variants(FLOOR, block, through(FLOOR, block, 0))]
    assert len(variants) == (4 if count > 1 else 2)
    assert all((one == other[::-1]).all() for one, other in zip(variants[::2], variants[1::2]))
    for variant, (order, first) in zip(variants, [(block, 0), (block[::-1], count % 2), (block, 1),
                                                  (block[::-1], (1 + count) % 2)]):
        assert (variant[0] == order[0][first]).all()
        assert (variant[-1] == order[-1][(first + count) % 2]).all()
        driven = []
        for index, lane in enumerate(order):
            begin, end = lane[::1 if (index + first) % 2 == 0 else -1, 0]
            along_lane, = np.flatnonzero((np.abs(variant[1:] - variant[:-1])[:, 1] < 1e-9) & (
                np.abs(variant[1:, 1] - lane[0, 1]) < 1e-9) & (
                    np.sign(end - begin) * np.diff(variant[:, 0]) > abs(end - begin) - 1e-9))
            driven.append(int(along_lane))
        assert driven == sorted(driven) and driven[0] == 0 and driven[-1] == len(variant) - 2
    corners = {tuple(variant[0]) for variant in variants}
    assert len(corners) == len(variants)
    assert min(distances(PLAN, along(variants[0]))) >= FLOOR.reach
