"""The command mark, which needs ROS: it starts rostest, and reads what was recorded; needs no master."""

import sys

from rumba_evaluation.marks import mark


def main() -> None:
    """Run the command line of this process; leaves the process with the exit code."""
    sys.exit(mark.main(sys.argv[1:], '', lambda *_: []))
