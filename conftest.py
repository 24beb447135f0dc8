"""Leaves out the tests that are marked thorough, of all packages, where `./rumba test` asks for that."""

import os


def pytest_collection_modifyitems(config, items):
    """Called by pytest once all tests are found."""
    if 'RUMBA_EVERYDAY' in os.environ:
        config.hook.pytest_deselected(items=[item for item in items if is_thorough(item)])
        items[:] = [item for item in items if not is_thorough(item)]


def is_thorough(item):
    """Whether a test has that mark, which may except some parameters by what pytest calls them."""
    mark = item.get_closest_marker('thorough')
    return mark is not None and not (mark.kwargs and item.callspec.id in mark.kwargs['except_for'])
