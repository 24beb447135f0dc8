"""A lull: coverage that has hardly risen for a while."""

import pytest

from rumba_cleaning.behaviours.lull import LITTLE, SHARE, SHORTEST, Lull


def after(*parts):
    """A lull after parts of a run: so many seconds, in which coverage rises by so much each second."""
    lull, coverage = Lull(), 0.0
    for seconds, rate in parts:
        for _ in range(seconds):
            coverage += rate
            lull.watch(coverage, 1.0)
    return lull


@pytest.mark.parametrize('seconds', [100, 2000])
def test_it_is_long_after_a_share_of_the_time_so_far_but_not_at_once(seconds):
    rising, longest = (seconds, 2.0 * LITTLE), max(SHARE * seconds, SHORTEST)
    assert not after(rising).is_long
    assert not after(rising, (int(0.9 * longest), 0.0)).is_long
    assert after(rising, (int(1.2 * longest), 0.0)).is_long
    assert not after(rising, (int(1.2 * longest), 0.0), (1, 2.0 * LITTLE)).is_long


def test_crumbs_that_add_up_end_it():
    assert not after((100, 2.0 * LITTLE), (100, 0.1 * LITTLE)).is_long
    assert after((100, 2.0 * LITTLE), (100, 0.001 * LITTLE)).is_long
