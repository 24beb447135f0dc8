"""Which tests with nodes `./rumba test` leaves out, since they take seconds of CPU.

Those of pytest have the mark of this name. Results of rosunit do not know tests that were skipped: these are not run.
"""

import os
import unittest


def thorough(method):
    """Mark a test."""
    method.is_thorough = True
    return method


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
    return hasattr(getattr(test, test._testMethodName), 'is_thorough')
