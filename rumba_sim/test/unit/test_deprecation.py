"""A deprecated function works on, and says at the line that calls it what to use in its place."""

import warnings

import pytest

from rumba_sim.model.common.deprecation import deprecated


@deprecated('0.2.0', 'new')
def old(value, more=0):
    """The old one."""
    return value + more


def test_it_works_and_warns_where_it_is_called():
    with pytest.warns(DeprecationWarning, match='^old is deprecated since 0.2.0: use new$') as caught:
        assert old(1, more=2) == 3
    assert caught[0].filename == __file__ and old.__doc__ == 'The old one.'


def test_it_warns_only_when_it_is_called():
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        deprecated('0.2.0', 'new')(lambda: None)
