"""Shops and offices of 2,000 m2 with three docks, cleaned by one robot and by three; and how long that was to take.

`shops.py [--robots N ...]` takes some minutes for each mission.
"""

import argparse
import time

import docks
import numpy as np
from common import drawings, figures, wings
from common.judge import Judge
from people_maps import driven

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.outlook import HOUR, outlook
from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.trial import Trial

AREA, RESOLUTION, SEED = 2400.0, 0.05, 63  # with walls and furniture [m^2]; [m]
DOCKS, TARGET = 3, 0.98
RIGHT = 15.0  # [%] that the estimate may be wrong by


def floor():
    """The floor with its docks, which are far from each other."""
    plan = drawings.drawn('shops', wings.shops(np.random.default_rng(SEED), AREA), RESOLUTION)
    found = np.random.default_rng(SEED).permutation(docks.places(plan, docks.largest_part(plan)))
    chosen = [found[0]]
    while len(chosen) < DOCKS:
        away = np.min([np.hypot(*(found[:, :2] - each[:2]).T) for each in chosen], axis=0)
        chosen.append(found[np.argmax(away)])
    return docks.with_docks(plan, docks.as_poses(chosen))


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--robots', nargs='+', type=int, default=[1, DOCKS])
    arguments = parser.parse_args()
    plan = floor()
    for robots in arguments.robots:
        trial = Trial(plan, 'boustrophedon', Conditions(target=TARGET), 1, robots)
        show(trial, robots, plan)


def show(trial, robots, plan):
    """Run a trial, and print how it went."""
    start, config = trial.world.start, trial.world.config
    expected = outlook(plan, *start[:2], config, CleaningConfig(target_coverage=TARGET))
    begin = time.process_time()
    way = driven(trial) if robots == 1 else to_end(trial)
    result = trial.result()
    figures.heading(f'Shops of {result.area:.0f} m2 with {DOCKS} docks, {robots} robot{"s" * (robots > 1)}: '
                    f'{result.outcome.name.lower()}: {result.message}')
    figures.row('swept at the end [%]', 100.0 * result.coverage, at_least=100.0 * TARGET)
    if robots == 1:
        judge = Judge(plan.free, plan.resolution, plan.origin, start[:2], float(trial.world.constants[0]['reach']),
                      config.brush.width)
        judge.follow(*way)
        figures.row('    by the judge [%]', 100.0 * judge.coverage)
    figures.row('robots home', result.docked, at_least=robots)
    figures.row('time, with charging [h]', result.time / HOUR)
    figures.row('    charging of it, of all robots at once [h]', result.charging_time / HOUR)
    figures.row('    charges', result.charges)
    if robots == 1:
        figures.row('expected before [h]', expected.hours)
        figures.row('    charges', expected.charges)
        figures.row('    wrong by [%]', 100.0 * abs(expected.hours * HOUR / result.time - 1.0), below=RIGHT)
    figures.row('working time [T]', (result.time - result.charging_time) / result.ideal_time)
    figures.row('98 % swept [T]', result.multiple_to(98))
    figures.row('CPU time [s]', time.process_time() - begin)


def to_end(trial):
    """Run a trial."""
    while not trial.is_over:
        trial.step()


if __name__ == '__main__':
    main()
