"""Groups of stretches: one if there are few, by region if there are more, and in parts if a region has many."""

import numpy as np

from rumba_cleaning.planning.common.stretches import Stretch, pair
from rumba_cleaning.planning.order.route import MANY, MOST, groups

PAIRS = 5  # of variants of each stretch


def scattered(count, region, width, height, seed=1):
    """Short stretches all over a rectangle from (0, 0) [m]."""
    places = np.random.default_rng(seed).uniform((0.0, 0.0), (width, height), (count, 2))
    return [Stretch(PAIRS * pair([np.array([place, place + (0.1, 0.0)])]), region, 0.1) for place in places]


def names(stretches):
    """What tells stretches apart."""
    return [id(stretch) for stretch in stretches]


def test_few_stretches_are_one_group_whatever_their_regions_if_a_tour_may_lead_across_them():
    found = [*scattered(20, 1, 5.0, 5.0), *scattered(20, 7, 5.0, 5.0)]
    assert [names(group) for group in groups(found)] == [names(found[:20]), names(found[20:])]
    group, = groups(found, across=True)
    assert names(group) == names(found)


def test_of_more_stretches_those_of_a_region_are_a_group_in_their_order():
    count = MANY // (4 * PAIRS) + 1
    one, other = scattered(count, 1, 5.0, 5.0), scattered(count, 7, 5.0, 5.0)
    found = groups([stretch for both in zip(other, one) for stretch in both], across=True)
    assert [names(group) for group in found] == [names(other), names(one)]


def test_many_stretches_are_parted_side_by_side_along_their_longer_side():
    few, many = scattered(20, 1, 60.0, 5.0), scattered(MANY // (2 * PAIRS) + 1, 2, 60.0, 5.0)
    first, *parts = groups([*few, *many])
    assert names(first) == names(few) and {stretch.region for part in parts for stretch in part} == {2}
    assert sorted(name for part in parts for name in names(part)) == sorted(names(many))
    sizes = [sum(len(stretch.variants) for stretch in part) for part in parts]
    assert max(sizes) <= MOST and len(parts) == 8
    spans = [(min(entries), max(entries)) for entries in
             ([stretch.variants[0].ends()[0][0] for stretch in part] for part in parts)]
    assert all(end <= start for (_, end), (start, _) in zip(spans, spans[1:]))


def test_as_many_as_a_group_may_have_are_not_parted():
    assert len(groups(scattered(MANY // (2 * PAIRS), 1, 20.0, 5.0))) == 1


def test_a_stretch_with_too_many_variants_is_a_group_of_its_own():
    large = [Stretch((MANY // 2) * pair([np.array([[x, 0.0], [x, 1.0]])]), 1, 0.1) for x in (3.0, 1.0)]
    assert [len(group) for group in groups(large)] == [1, 1]
