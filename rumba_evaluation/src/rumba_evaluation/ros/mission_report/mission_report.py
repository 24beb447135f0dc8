"""mission_report: makes an HTML page about a mission from a bag; needs no master.

The page needs no other file and no network, fits a phone, and can be printed. docs/mission_report.md describes which
topics to record, and where each figure comes from.
"""

import argparse
import inspect
import io
import os
import sys
from typing import Callable, List, NoReturn, Optional

from rumba_evaluation.report.mission_record import MissionRecord, clock
from rumba_evaluation.report.mission_summary import summary
from rumba_evaluation.ros.mission_report import mission_bag
from rumba_evaluation.ros.mission_report.mission_bag import ReportError
from rumba_sim.model.common.errors import ConfigError, RumbaError
from rumba_sim.ros.running.node import BAD_INPUT


class _Parser(argparse.ArgumentParser):
    """Reports an error as an exception."""

    def error(self, message: str) -> NoReturn:
        """Raise ConfigError."""
        raise ConfigError(f'{message}; see --help')


def main(arguments: Optional[List[str]] = None) -> None:
    """Write the report; leaves the process with exit code 2 if the input is bad."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors='backslashreplace')  # names of files can have bytes that are not text
    try:
        given = _parser().parse_args(arguments)
        report(given.bag, given.output or f'{os.path.splitext(given.bag)[0]}.html', given.robot, given.target)
    except RumbaError as error:
        print('mission_report:', *str(error).split(), file=sys.stderr)
        sys.exit(BAD_INPUT)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog='mission_report', description=inspect.getdoc(sys.modules[__name__]),
                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('bag', metavar='FILE.bag', help='the recording')
    parser.add_argument('--output', metavar='FILE.html', default='', help='the page (default: beside the bag)')
    parser.add_argument('--robot', metavar='NAME', default='',
                        help='the robot, with its namespace if two have the same name (default: the only one, '
                             'or the one named rumba)')
    parser.add_argument('--target', metavar='SHARE', type=_share, default=0.0,
                        help='the share of the floor that was to be swept, above 0, at most 1 (default: that of the '
                             "recorded clean/goal, else the cleaner's default)")
    return parser


def _share(text: str) -> float:
    try:
        share = float(text)
    except ValueError:
        share = 0.0
    if not 0.0 < share <= 1.0:
        raise argparse.ArgumentTypeError(f'{text!r}: must be a number above 0, at most 1')
    return share


def report(bag: str, output: str, robot: str, target: float) -> None:
    """Write the report of a bag, and print a summary; a target of 0 is that of the recording.

    Raises:
        ReportError: the bag cannot be read or lacks needed topics, matplotlib is missing, or the page cannot be
            written.
    """
    page = _page_maker()
    record = mission_bag.read(bag, robot, target)
    if os.path.exists(output) and os.path.samefile(bag, output):
        raise ReportError(f'{output}: is the bag itself: choose another --output')
    try:
        with open(output, 'w', encoding='utf-8', errors='replace') as file:
            file.write(page(record))
    except OSError as error:
        raise ReportError(f'{output}: {error.strerror}') from error
    print(output, *_lines(record), sep='\n')


def _page_maker() -> Callable[[MissionRecord], str]:
    try:
        from rumba_evaluation.report.report_page import page
    except ImportError as error:
        raise ReportError(f'the figures need matplotlib ({error}): install the package python3-matplotlib') from error
    return page


def _lines(record: MissionRecord) -> List[str]:
    """A summary: of each robot, if there are several."""
    return [line for one in (record, *record.mates) for line in _lines_of(one)]


def _lines_of(record: MissionRecord) -> List[str]:
    totals = summary(record)
    coverage = f'{100.0 * totals.coverage:.1f} % swept' if totals.coverage is not None else 'coverage not recorded'
    dirt = f', {100.0 * record.dirt:.1f} % of the dirt left' if record.dirt is not None else ''
    speed = f' at {totals.mean_speed:.2f} m/s' if totals.mean_speed is not None else ''
    bumps = f', bumps: {totals.bumps}' if totals.bumps is not None else ''
    return [
        ' '.join(totals.outcome.split()) or 'How the mission ended was not recorded (mission_status).',
        f'{record.robot}: {coverage}{dirt}, {totals.distance:.1f} m driven{speed}{bumps}',
        f'battery: {totals.charge[0]:.0f} % to {totals.charge[1]:.0f} %, lowest {totals.charge[2]:.0f} %, '
        f'charges during the mission: {totals.charges}, on the charger for {clock(totals.charging_time)} in all']
