"""evaluate: finds the maps of the package for `rumba_sim.evaluation`, which knows no ROS; needs no master."""

import sys

from rumba_sim.evaluation import evaluate
from rumba_sim.ros.maps import map_path


def main() -> None:
    """Run what the command line says; leaves the process with its exit code."""
    sys.exit(evaluate.main(sys.argv[1:], map_path))
