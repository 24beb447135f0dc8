"""The command mark, which needs ROS: it starts rostest, and reads what was recorded; needs no master."""

import sys
from typing import List

from rumba_evaluation.marks import mark
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.marking import Ros
from rumba_evaluation.submissions import processes


def main() -> None:
    """Run the command line of this process; leaves the process with the exit code."""
    from rumba_evaluation.ros import exam_recording, launches

    def examine(bag: str, test: HiddenTest) -> List[str]:
        return [f'{test.name}: {finding}' for finding in exam_recording.findings(bag)]
    processes.adopt_orphans()
    sys.exit(mark.main(sys.argv[1:], Ros(examine, launches.load, launches.visible)))
