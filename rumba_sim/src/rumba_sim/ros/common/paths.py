"""Paths of files that a user gives to a node."""

import os


def absolute(path: str) -> str:
    """A path as an absolute one.

    A relative path begins at the working folder. roslaunch runs nodes in ~/.ros: a file that is not there is looked for
    in the folder in which roslaunch was started, which the environment variable PWD names.
    """
    here = os.path.abspath(path)
    return here if os.path.exists(here) else os.path.abspath(os.path.join(os.environ.get('PWD', ''), path))
