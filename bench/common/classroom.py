"""A class that hands in what classes hand in: good submissions, wrong ones, and some that cheat or break things.

Each maker writes one submission into a folder, or beside it as an archive; its name is that of the submission. Hostile
ones do nothing for the task but to cheat, so that each point that they get is a fault.
"""

import shutil

from common import good_homework, hostile_homework, wrong_homework
from common.homework import EXERCISES, GOOD, MAKERS

KINDS = (good_homework, wrong_homework, hostile_homework)  # which have filled MAKERS


def build(folder):
    """Make the class: a folder for each exercise; returns the kind of each submission by exercise and name."""
    kinds = {}
    for kind, makers in MAKERS.items():
        for exercise, maker in makers:
            path = folder / exercise / maker.__name__
            shutil.copytree(EXERCISES / exercise / 'starter', path)
            if kind == GOOD:
                shutil.copytree(EXERCISES / exercise / 'solution', path, dirs_exist_ok=True)
            name = maker(path) or maker.__name__
            kinds[exercise, name] = kind
    return kinds
