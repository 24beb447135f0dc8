"""Runs a command, and ends all that it has started, wherever it went: `python3 keeper.py COMMAND ARGUMENT...`.

SIGTERM, or the death of the process that started this one, ends everything.
"""

import os
import signal
import subprocess
import sys

from rumba_evaluation.submissions import processes


def main() -> int:
    """Run the command of the command line; returns its exit code."""
    processes.adopt_orphans()
    signal.signal(signal.SIGTERM, lambda *_: processes.end_all(os.getpid()))
    processes.end_with_parent(signal.SIGTERM)
    command = subprocess.Popen(sys.argv[1:], start_new_session=True)
    try:
        return command.wait()
    finally:
        processes.end_all(os.getpid())


if __name__ == '__main__':
    sys.exit(main())
