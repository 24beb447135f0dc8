"""`./rumba mutate`: arguments, progress, and what survived."""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
from typing import Iterator, List

from mutation.judges import JUDGED, Judged
from mutation.session import Fault, Session, tests

ROOT = pathlib.Path(__file__).resolve().parents[1]
LEAST = 0.9  # share of the faults that the tests shall find; our choice
DRAWN = 25  # faults of each module
PERIOD = 8.0  # [s] between two lines of progress


def main() -> None:
    """Plant faults and judge; ends with exit code 1 if too many survive, 2 if the arguments are wrong."""
    arguments = _arguments()
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / 'rumba'
        # With what was compiled of it, which else would take a minute.
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns('.git', '.ws', '.*_cache'))
        shares = [_judge(JUDGED[name], copy, arguments) for name in arguments.modules or JUDGED]
    sys.exit(0 if min(shares) >= LEAST else 1)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        './rumba mutate', description='Plants small faults in a copy of modules, one after another, by cosmic-ray, and '
        'asks the unit tests of each: which faults do they find? Fails if they find less than 90 %.')
    parser.add_argument('modules', nargs='*', choices=[[], *JUDGED], metavar='MODULE',
                        help='all, if none is given: ' + ', '.join(JUDGED))
    parser.add_argument('--draw', type=int, default=DRAWN, metavar='N', help=f'faults of each module; default: {DRAWN}')
    parser.add_argument('--seed', type=int, default=0, metavar='N', help='by which they are drawn; default: 0')
    parser.add_argument('--tools', type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    return parser.parse_args()


def _judge(judged: Judged, copy: pathlib.Path, arguments: argparse.Namespace) -> float:
    """Plant the faults of a module, and say how it goes; returns the share that the tests found."""
    usual = _usual_time(judged, copy)
    session = Session(judged, copy, arguments.tools)
    session.draw(arguments.draw, arguments.seed, usual)
    drawn = len(session.faults())
    for tried in _progress(session):
        survivors = [fault for fault in tried if not fault.is_found]
        print(f'{judged.name}: {len(tried)} of {drawn} faults tried, {len(survivors)} survived', flush=True)
    for fault in survivors:
        print(f'{judged.path}:{fault.line}: {fault.operator} survived', *_changed(fault), sep='\n    ', flush=True)
    share = 1.0 - len(survivors) / len(tried)
    print(f'{judged.name}: the tests find {100.0 * share:.0f} %', flush=True)
    return share


def _usual_time(judged: Judged, copy: pathlib.Path) -> float:
    """Seconds that the tests of a module take without a fault, once what they compile is compiled."""
    for _ in range(2):
        begin = time.monotonic()
        done = subprocess.run(tests(judged, copy), cwd=copy, stdout=subprocess.PIPE, universal_newlines=True)
        if done.returncode:
            sys.exit(f'{judged.name}: its tests fail without a fault:\n{done.stdout}')
    return time.monotonic() - begin


def _progress(session: Session) -> Iterator[List[Fault]]:
    """The faults that are tried, every few seconds until all are."""
    process = session.start()
    try:
        while process.poll() is None:
            try:
                process.wait(PERIOD)
            except subprocess.TimeoutExpired:
                yield [fault for fault in session.faults() if fault.is_found is not None]
        yield [fault for fault in session.faults() if fault.is_found is not None]
    finally:
        process.terminate()
        process.wait()


def _changed(fault: Fault) -> List[str]:
    """The lines that a fault takes and puts."""
    return [line for line in fault.change.splitlines() if line[:1] in ('-', '+') and line[:3] not in ('---', '+++')]


if __name__ == '__main__':
    main()
