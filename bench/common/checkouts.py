"""Another checkout, against which this one is measured in turn, since the speed of a machine changes with the hour."""

import os
import pathlib
import statistics

from common import figures

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAIRS = 3


def add_arguments(parser):
    """The arguments of a bench that can compare."""
    parser.add_argument('--against', type=pathlib.Path, metavar='CHECKOUT',
                        help='another checkout with the same messages and modules, which need not be built: measure '
                             'both in turn, and print ratios; the first pair, for which code may be compiled, is left '
                             'out')
    parser.add_argument('--pairs', type=int, default=PAIRS, help='with --against: how often to measure both')


def command(checkout, arguments):
    """What runs a command in this workspace, with the sources of another checkout unless that is None."""
    sources = sorted((ROOT if checkout is None else checkout.resolve()).glob('rumba_*/src'))
    return ['env', 'PYTHONPATH=' + os.pathsep.join([*map(str, sources), os.environ.get('PYTHONPATH', '')]), *arguments]


def compare(measure, checkout, pairs):
    """Measure this checkout and another one in turn.

    Args:
        measure: a function of a checkout, None for this one, that gives figures by their names.
        checkout: the other one.
        pairs: how often, after a first pair that does not count.

    Returns:
        dict of names and pairs of lists: the figures of this checkout, and those of the other one.
    """
    found = {}
    for number in range(pairs + 1):
        here, there = measure(None), measure(checkout)
        for name in here if number else ():
            mine, theirs = found.setdefault(name, ([], []))
            mine.append(here[name])
            theirs.append(there[name])
    return found


def rows(found, at_least):
    """Print the medians of what `compare` gives, and the median of the ratios within the pairs, with its bound."""
    for name, (here, there) in found.items():
        figures.row(f'{name}: here', statistics.median(here))
        figures.row(f'{" " * len(name)}  there', statistics.median(there))
        figures.row(f'{" " * len(name)}  here / there', statistics.median(
            mine / theirs for mine, theirs in zip(here, there)), at_least=at_least)
