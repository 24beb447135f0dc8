"""How often a robot falls that cleans a floor with pits that no map shows, and that its laser does not see.

`pits.py [--first N] [--last N] [--jobs N]` runs missions of explore_and_clean on floors drawn from seeds 1 to 110.
"""

import argparse
import collections
import concurrent.futures
import statistics

from common import figures, hard_floors

from rumba_evaluation.trials.cases import SLAM, Conditions
from rumba_evaluation.trials.trial import Trial

RESOLUTION = 0.02  # [m]
TARGET = 0.98  # of the floor that the robot knows


def mission(seed):
    """The result of a mission on the floor of a seed."""
    plan = hard_floors.floor('pits', seed, RESOLUTION)
    trial = Trial(plan, 'explore_and_clean', Conditions(pose=SLAM, target=TARGET), seed)
    while not trial.is_over:
        trial.step()
    return trial.result()


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--last', type=int, default=110)
    parser.add_argument('--jobs', type=int, default=None, help='processes; one for each core by default')
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.last + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        results = list(executor.map(mission, seeds))
    figures.heading(f'explore_and_clean among pits that no map shows, seeds {seeds[0]} to {seeds[-1]}')
    counts = collections.Counter(result.outcome.name.lower() for result in results)
    figures.row('fallen', counts.pop('fallen', 0), below=1)
    for name, count in sorted(counts.items()):
        figures.row(name, count)
    figures.row('coverage, true, median [%]', 100.0 * statistics.median(result.coverage for result in results))


if __name__ == '__main__':
    main()
