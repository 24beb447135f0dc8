"""`./rumba stress`: arguments, and the exit code."""

import argparse
import math
import random
import re
import sys

from stress import publishers, report, run, schedule
from stress.scenarios import SCENARIOS

FAILED, USAGE = 1, 2
MINUTES = 10.0


def main():
    """Run and end with exit code 1 if something failed, 2 if the arguments are wrong."""
    arguments = _arguments()
    seed = random.SystemRandom().randrange(10 ** 6) if arguments.seed is None else arguments.seed
    told = report.Report(seed, 60.0 * arguments.minutes)
    told.say(f'seed {seed}')
    make = schedule.OneGround(arguments.ground) if arguments.ground else schedule
    trials = run.Run(seed, told, publishers.Publishers(), make)
    try:
        if arguments.only:
            trials.only(arguments.only)
        else:
            trials.rounds()
    except KeyboardInterrupt:
        told.say('stopped')
    told.summary()
    sys.exit(FAILED if told.failures else 0)


def _arguments():
    parser = argparse.ArgumentParser('./rumba stress', description='Starts real nodes on a master of its own, strikes '
                                     'blow after blow, and asks after each whether everything is well; docs/'
                                     'reliability.md tells more.')
    parser.add_argument('minutes', nargs='?', type=_minutes, default=MINUTES, metavar='MINUTES',
                        help=f'how long; default {MINUTES:g}')
    parser.add_argument('--seed', type=int, metavar='N', help='of all that is random; default: drawn, and printed')
    parser.add_argument('--only', type=_numbers, metavar='N,N,...', help='strike these blows of the seed alone')
    parser.add_argument('--ground', choices=sorted(SCENARIOS), metavar='NAME', help='strike on one ground alone: '
                        + ', '.join(sorted(SCENARIOS)))
    return parser.parse_args()


def _minutes(text):
    try:
        minutes = float(text)
    except ValueError:
        minutes = math.nan
    if not (math.isfinite(minutes) and minutes > 0.0):
        raise argparse.ArgumentTypeError(f'{text!r}: must be a number of minutes above 0')
    return minutes


def _numbers(text):
    if not re.fullmatch(r'\d{1,9}(,\d{1,9})*', text, re.ASCII):
        raise argparse.ArgumentTypeError(f'{text!r}: must be numbers of blows with commas between them, as in 12,17,18')
    return sorted({int(number) for number in text.split(',')})


if __name__ == '__main__':
    main()
