"""Hypothesis tries the same examples in every run, has no time limit, and writes no files; plans are made quickly."""

import signal

import hypothesis
import pytest

from rumba_cleaning.planning.common import effort

hypothesis.settings.register_profile('rumba', derandomize=True, database=None, deadline=None)
hypothesis.settings.load_profile('rumba')

# If a shell runs the tests in the background, they and the processes that they start would ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)

ABOUT_PLANS = ('test_planner', 'test_improvement', 'test_sharing', 'test_bounds')  # modules, also of evaluation


@pytest.fixture(autouse=True, scope='module')
def quick_plans(request):
    """Do not rehearse routes: only tests of plans look at how short these are."""
    usual = effort.WORK
    if request.module.__name__ not in ABOUT_PLANS:
        effort.WORK = 0.0
    yield
    effort.WORK = usual
