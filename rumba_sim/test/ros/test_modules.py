#!/usr/bin/env python3
"""Runs the tests of several modules beside it in one process, so that the libraries of their nodes are loaded once.

Arguments: the package, a name for the results, and the modules.
"""

import os
import sys
import unittest

import rospy
import rostest
from tiers import wanted

PACKAGE, NAME, *MODULES = (argument for argument in sys.argv[1:] if argument[0].isalpha())


def suite():
    """The tests of the modules, in their order."""
    return wanted(unittest.defaultTestLoader.loadTestsFromNames(MODULES))


if __name__ == '__main__':
    sys.path.insert(0, os.path.dirname(sys.argv[0]))  # of the link to this file, if it is one
    rospy.init_node(f'test_{NAME}')
    rostest.rosrun(PACKAGE, NAME, '__main__.suite')
