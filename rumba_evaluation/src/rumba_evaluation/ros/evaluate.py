"""The command evaluate with the maps of the installed package rumba_sim, which are found by rospkg; needs no master."""

import sys

from rumba_evaluation.trials import evaluate
from rumba_sim.ros.common.maps import map_path


def main() -> None:
    """Run the command line of this process; leaves the process with the exit code."""
    sys.exit(evaluate.main(sys.argv[1:], map_path))
