"""The command evaluate, which reads paths from bags too; needs no master."""

import sys

from rumba_evaluation.scoring.drawn_path import DrawnPath
from rumba_evaluation.trials import evaluate
from rumba_sim.ros.participants.maps import map_path


def main() -> None:
    """Run the command line of this process; leaves the process with the exit code."""
    sys.exit(evaluate.main(sys.argv[1:], map_path, read_bag))


def read_bag(path: str, topic: str) -> DrawnPath:
    """As `path_bag.read`, which is imported here, since most evaluations read no bag and rosbag loads slowly."""
    from rumba_evaluation.ros import path_bag
    return path_bag.read(path, topic)
