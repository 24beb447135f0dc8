"""What is wrong with a submission, in sentences for those who handed it in: what, where, and what to do.

The most important is first, none comes twice, and what is quoted can safely be shown: `quotations.printable`.
"""

import pathlib
from typing import Iterable, List, NamedTuple, Sequence

from rumba_evaluation.submissions.diagnosis import (
    installed_packages, mistakes_of_builds, mistakes_of_packages, mistakes_of_runs, mistakes_of_scripts,
    submitted_files)

MOST = 20  # sentences


class Wanted(NamedTuple):
    """A node of the submission that a test starts."""

    package: str
    type: str


def of_submission(folder: pathlib.Path, wanted: Sequence[Wanted]) -> List[str]:
    """What can be seen in the files of a submission, as they were handed in.

    Args:
        folder: of the submission.
        wanted: the nodes that tests start.
    """
    paths = submitted_files.files(folder)
    found = submitted_files.packages(paths)
    told = mistakes_of_packages.of_folder(paths, found, folder)
    told += mistakes_of_packages.of_names((each.package for each in wanted), found, folder)
    packages = {package.name: package for package in found if package.name}
    for each in wanted:
        if each.package in packages:
            told += mistakes_of_scripts.of_node(packages[each.package], each.type, folder)
    for package in packages.values():
        told += mistakes_of_packages.of_messages(package, folder)
    installed = installed_packages.names().union(packages) if packages else set()
    for package in packages.values():
        told += mistakes_of_packages.of_dependencies(package, installed, folder)
    return _once(told)


def of_build(output: str) -> List[str]:
    """What stopped a build, by all that catkin_make printed."""
    return _once(mistakes_of_builds.of_output(output))


def of_run(output: str) -> List[str]:
    """What went wrong in the nodes of a submission during a test.

    Args:
        output: what rostest and the nodes printed, and what rostest wrote into its log, rostest-*.log: only that tells
            how processes ended.
    """
    return _once(mistakes_of_runs.of_output(output))


def _once(sentences: Iterable[str]) -> List[str]:
    return list(dict.fromkeys(sentences))[:MOST]
