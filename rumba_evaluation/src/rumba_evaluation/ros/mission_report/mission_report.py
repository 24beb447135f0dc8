"""mission_report: one HTML page that tells a mission, out of a bag; needs no master.

The page stands alone: it opens without a network, on a phone, and prints. docs/mission_report.md tells what has to be
recorded, and where each figure comes from.
"""

import argparse
import inspect
import os
import sys
from typing import List, Optional

from rumba_evaluation.report.mission_record import MissionRecord, summary
from rumba_evaluation.report.report_page import clock, page
from rumba_evaluation.ros.mission_report import mission_bag
from rumba_evaluation.ros.mission_report.mission_bag import ReportError
from rumba_sim.model.errors import ConfigError, RumbaError
from rumba_sim.ros.common.node import BAD_INPUT


class _Parser(argparse.ArgumentParser):
    """Says in one line what is wrong."""

    def error(self, message: str) -> None:
        raise ConfigError(f'{message}; --help tells more')


def main(arguments: Optional[List[str]] = None) -> None:
    """Write the report; leaves the process with exit code 2 where the input is bad."""
    sys.stdout.reconfigure(errors='backslashreplace')  # the name of a file need not be text
    try:
        given = _parser().parse_args(arguments)
        report(given.bag, given.output or f'{os.path.splitext(given.bag)[0]}.html', given.robot)
    except RumbaError as error:
        print('mission_report:', *str(error).split(), file=sys.stderr)
        sys.exit(BAD_INPUT)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog='mission_report', description=inspect.getdoc(sys.modules[__name__]),
                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('bag', metavar='FILE.bag', help='what rosbag recorded')
    parser.add_argument('--output', metavar='FILE.html', default='', help='the page (default: beside the bag)')
    parser.add_argument('--robot', metavar='NAME', default='',
                        help='which robot, with its namespace where two have the same name (default: the only one, '
                             'or the one named rumba)')
    return parser


def report(bag: str, output: str, robot: str) -> None:
    """Write the report of a bag, and say in a few lines what it tells.

    Raises:
        ReportError: the bag cannot be read or lacks what is needed, or the page cannot be written.
    """
    record = mission_bag.read(bag, robot)
    if os.path.exists(output) and os.path.samefile(bag, output):
        raise ReportError(f'{output}: is the bag itself: give another --output')
    try:
        with open(output, 'w', encoding='utf-8', errors='replace') as file:
            file.write(page(record))
    except OSError as error:
        raise ReportError(f'{output}: {error.strerror}') from error
    print(output, *_lines(record), sep='\n')


def _lines(record: MissionRecord) -> List[str]:
    told = summary(record)
    coverage = f'{100.0 * told.coverage:.1f} % swept' if told.coverage is not None else 'coverage not recorded'
    speed = f' at {told.mean_speed:.2f} m/s' if told.mean_speed is not None else ''
    bumps = f', bumps: {told.bumps}' if told.bumps is not None else ''
    return [
        f'{record.robot}: {coverage} in {clock(told.duration)}, {told.distance:.1f} m driven{speed}{bumps}',
        f'battery: {told.charge[0]:.0f} % to {told.charge[1]:.0f} %, least {told.charge[2]:.0f} %, '
        f'charges: {told.charges}, {clock(told.charging_time)} in all',
        f'outcome: {" ".join(told.outcome.split()) or "no mission_status recorded"}']
