"""Another checkout, against which this one is measured in turn, since the speed of a machine changes with the hour."""

import pathlib
import statistics

from common import figures

PAIRS = 3


def add_arguments(parser):
    """The arguments of a bench that can compare."""
    parser.add_argument('--against', type=pathlib.Path, metavar='CHECKOUT',
                        help='another checkout, which ./rumba build has built: measure both in turn, and print ratios')
    parser.add_argument('--pairs', type=int, default=PAIRS, help='with --against: how often to measure both')


def command(checkout, arguments):
    """What runs a command in the workspace of a checkout; None: in this one."""
    return arguments if checkout is None else [str(checkout.resolve() / 'rumba'), 'shell', *arguments]


def compare(measure, checkout, pairs):
    """Measure this checkout and another one in turn.

    Args:
        measure: a function of a checkout, None for this one, that gives figures by their names.
        checkout: the other one.
        pairs: how often.

    Returns:
        dict of names and pairs of lists: the figures of this checkout, and those of the other one.
    """
    found = {}
    for _ in range(pairs):
        for name, figure in measure(None).items():
            found.setdefault(name, ([], []))[0].append(figure)
        for name, figure in measure(checkout).items():
            found[name][1].append(figure)
    return found


def rows(found, at_least):
    """Print the medians of what `compare` gives, and the median of the ratios within the pairs, with its bound."""
    for name, (here, there) in found.items():
        figures.row(f'{name}: here', statistics.median(here))
        figures.row(f'{" " * len(name)}  there', statistics.median(there))
        figures.row(f'{" " * len(name)}  here / there', statistics.median(
            mine / theirs for mine, theirs in zip(here, there)), at_least=at_least)
