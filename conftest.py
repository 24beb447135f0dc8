"""Leaves out the tests that are marked thorough, of all packages, where `./rumba test` asks for that."""

import os

import pytest

UNKNOWN = {}  # the parameters that the marks of tests except although there are none of that name


def pytest_collection_modifyitems(config, items):
    """Called by pytest once all tests are found."""
    if 'RUMBA_EVERYDAY' in os.environ:
        UNKNOWN.update(unknown_parameters(items))
        config.hook.pytest_deselected(items=[item for item in items if is_left_out(item)])
        items[:] = [item for item in items if not is_left_out(item)]


def pytest_runtest_setup(item):
    """Called by pytest before each test: a mistyped exception would leave out all of a test without a word."""
    unknown = UNKNOWN.get(names(item)[0])
    if unknown:
        pytest.fail(f'its mark thorough excepts parameters that it does not have: {sorted(unknown)}')


def is_left_out(item):
    """Whether a test has the mark, which may except some parameters by what pytest calls them."""
    test, parameters = names(item)
    return item.get_closest_marker('thorough') is not None and parameters not in excepted(item) and not UNKNOWN[test]


def unknown_parameters(items):
    """The parameters that the marks of tests except although there are none of that name, by test."""
    unknown = {names(item)[0]: set(excepted(item)) for item in items}
    for item in items:
        test, parameters = names(item)
        unknown[test].discard(parameters)
    return unknown


def names(item):
    """What pytest calls a test and its parameters."""
    test, _, parameters = item.nodeid.partition('[')
    return test, parameters[:-1]


def excepted(item):
    """The parameters that a test's mark excepts."""
    mark = item.get_closest_marker('thorough')
    return [] if mark is None else mark.kwargs.get('except_for', [])
