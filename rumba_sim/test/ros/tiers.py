"""Which tests with nodes take long, and guard what shorter ones guard too: `./rumba test` leaves them out."""

import os
import unittest


def thorough(test):
    """Mark a test, or a class of tests."""
    test.is_thorough = True
    return test


def wanted(tests):
    """A suite of the tests in another one that are to run."""
    is_everyday = 'RUMBA_EVERYDAY' in os.environ
    return unittest.TestSuite(test for test in _flat(tests) if not (is_everyday and _is_thorough(test)))


def _flat(tests):
    for test in tests:
        if isinstance(test, unittest.TestSuite):
            yield from _flat(test)
        else:
            yield test


def _is_thorough(test):
    method = getattr(test, test._testMethodName)
    return getattr(method, 'is_thorough', getattr(test, 'is_thorough', False))
