"""evaluate: finds the maps of the package for `rumba_evaluation`, which knows no ROS; needs no master."""

import sys

from rumba_evaluation.trials import evaluate
from rumba_sim.ros.common.maps import map_path


def main() -> None:
    """Run what the command line says; leaves the process with its exit code."""
    sys.exit(evaluate.main(sys.argv[1:], map_path))
