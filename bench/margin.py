"""What a margin to walls costs in coverage and time, and how many collisions it saves, by how ragged walls are."""

import argparse
import concurrent.futures
import itertools
import statistics

import numpy as np
from common import drawings, figures, hard_floors, people, wings

from rumba_evaluation.trials.cases import Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps.floor_plan import FloorPlan

MARGINS = 0.0, 0.01, 0.02, 0.03, 0.05  # [m]
AREA, RESOLUTION, FINE = 60.0, 0.05, 0.02  # [m^2] with furniture; [m]


def furnished(seed):
    """A home with smooth walls, as drawn."""
    return drawings.drawn('furnished', wings.furnished(np.random.default_rng(seed), AREA), RESOLUTION)


def ragged(seed):
    """The same with walls as a laser maps them."""
    plan = furnished(seed)
    cells = people.ragged(np.random.default_rng(seed), plan.occupancy)
    return FloorPlan('ragged', cells, plan.resolution, plan.origin)


def jagged(seed):
    """Two rooms with uneven walls, on fine cells."""
    return hard_floors.floor('jagged', seed, FINE)


FLOORS = {'home with ragged walls': ragged, 'rooms with jagged walls': jagged, 'home with smooth walls': furnished}


def mission(kind, margin, seed):
    """The result of a mission."""
    trial = Trial(FLOORS[kind](seed), 'boustrophedon', Conditions(margin=margin), seed)
    while not trial.is_over:
        trial.step()
    return trial.result()


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=5)
    parser.add_argument('--jobs', type=int)
    arguments = parser.parse_args()
    seeds = range(1, arguments.seeds + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        for kind in FLOORS:
            figures.heading(f'{kind}: medians of {len(seeds)} missions to 99 % of what the margin leaves')
            for margin in MARGINS:
                cases = zip(*itertools.product([kind], [margin], seeds))
                show(margin, list(executor.map(mission, *cases)))


def show(margin, results):
    """Print the medians of missions with a margin [m]."""
    figures.row(f'margin {margin:g} m: collisions for a square metre',
                statistics.median(each.collisions / each.area for each in results))
    figures.row('    swept of all that the brush could reach [%]',
                100.0 * statistics.median(each.coverage for each in results))
    figures.row('    time [T]', statistics.median(each.time / each.ideal_time for each in results))


if __name__ == '__main__':
    main()
