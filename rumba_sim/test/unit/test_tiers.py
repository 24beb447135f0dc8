"""In an everyday run, tests with nodes that are marked thorough are left out."""

import unittest

import pytest
from tiers import thorough, wanted


class Some(unittest.TestCase):
    def test_short(self):
        """Called by nobody."""

    @thorough
    def test_long(self):
        """Called by nobody."""


class Other(unittest.TestCase):
    @thorough
    def test_longer(self):
        """Called by nobody."""


@pytest.mark.parametrize('is_everyday, names', [
    (True, ['test_short']), (False, ['test_long', 'test_short', 'test_longer'])])
def test_an_everyday_run_leaves_out_the_thorough_tests_of_all_classes(is_everyday, names, monkeypatch):
    monkeypatch.delenv('RUMBA_EVERYDAY', raising=False)
    if is_everyday:
        monkeypatch.setenv('RUMBA_EVERYDAY', '1')
    load = unittest.defaultTestLoader.loadTestsFromTestCase
    suite = unittest.TestSuite([load(Some), unittest.TestSuite([load(Other)])])
    assert [test.id().rpartition('.')[2] for test in wanted(suite)] == names
