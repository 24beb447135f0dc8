"""What each stage of the planner is worth: missions without it, on the same floors and from the same starts.

    python3 bench/ablation.py --without shortcuts shifts --floors studio chairs --seeds 0-2

A stage is switched off in the process that measures. The simulator, which the planner does not know, counts what is
swept; T is the time that the brush needs for the floor at the cleaning speed. Seeds below 100 are for decisions about
the planner, and those from 100 on for checks.
"""

import argparse
import concurrent.futures
import contextlib
import itertools
import math
import multiprocessing
import os
import statistics
from typing import NamedTuple
from unittest import mock

import numpy as np
from common import figures, hard_floors
from floors import Stopwatch, span

from rumba_cleaning.planning import planner
from rumba_cleaning.planning.common.effort import Effort
from rumba_cleaning.planning.decompose.regions import Shapes, shapes
from rumba_cleaning.planning.order import route, tour
from rumba_cleaning.planning.search import improvement
from rumba_cleaning.planning.swaths import drafting
from rumba_cleaning.strategies import boustrophedon
from rumba_evaluation.trials.cases import ANYWHERE, DOCK, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.maps import map_file, named_maps

PACKAGED = ('studio', 'apartment')
HARD = ('spiral of 0.8 m', 'dining', 'slanted', 'jagged', 'cliffs', 'pits', 'thin', 'star', 'crossing', 'neck')
RESOLUTION = 0.05  # [m] of the hard floors
TARGETS = (0.98, 0.99)
GROUPS = route.groups
ROW = '{:<24}{:>9}{:>9}{:>9}{:>9}{:>10}{:>8}'


def nothing(*_):
    """No edits, no strips, no rings."""
    return []


def without_rings(ground, labels):
    """Lanes in all regions."""
    found = shapes(ground, labels)
    return Shapes(np.zeros_like(found.is_open), np.ones_like(found.has_lanes))


def without_lanes(ground, labels):
    """Rings in all regions."""
    found = shapes(ground, labels)
    return Shapes(found.is_open, np.zeros_like(found.has_lanes))


# What replaces functions: (where, name, what) each.
STAGES = {
    'nothing': (),
    'rehearsal': ((planner, 'effort', lambda _: Effort(0)),),
    'rings': ((planner, 'shapes', without_rings), (drafting, 'rings', nothing)),
    'lanes': ((planner, 'shapes', without_lanes),),
    'shortcuts': ((improvement, 'shortcuts', nothing),),
    'other drafts': ((planner, 'choices', lambda _: drafting.DRAFTS[:1]),),
    'shifts': ((improvement, 'shifts', nothing),),
    'strips': ((drafting, '_strips', nothing),),
    'tours across rooms': ((route, 'groups', lambda found, _: GROUPS(found)),),
    'kicks': ((tour, 'KICKS', 0),),
    'spiral': ((planner, 'spiral_over', lambda *_: None),),
}


class Mission(NamedTuple):
    """How one mission went."""

    multiple: float  # time to the target [T]; inf if it was missed
    coverage: float  # in the end
    seconds: float  # CPU time of the planner [s]


def main():
    """Run all missions, and print."""
    arguments = parsed()
    without = ['nothing', *(name for name in arguments.without if name != 'nothing')]
    cases = list(itertools.product(arguments.floors, arguments.seeds, TARGETS))
    jobs = [(stage, *case) for case in cases for stage in without]
    context = multiprocessing.get_context('spawn')
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs, context) as executor:
        found = dict(zip(jobs, executor.map(run, *zip(*jobs))))
    figures.heading(f'{len(cases)} missions each on {", ".join(arguments.floors)}')
    print(ROW.format('without', '98 % [T]', 'change', '99 % [T]', 'change', 'plan [s]', 'missed'))
    for stage in without:
        summarise(stage, found, cases)
    if arguments.each:
        for case in cases:
            print(*case, *(f'{found[(stage, *case)].multiple:.4f}' for stage in without))


def summarise(stage, found, cases):
    """Print the medians of the times, and the means of their changes from those with all stages."""
    columns = []
    for target in TARGETS:
        pairs = [(found[(stage, *case)], found[('nothing', *case)]) for case in cases if case[2] == target]
        changes = [one.multiple - other.multiple for one, other in pairs
                   if math.isfinite(one.multiple + other.multiple)]
        columns += [f'{statistics.median(one.multiple for one, _ in pairs):.3f}',
                    f'{statistics.mean(changes or [math.nan]):+.3f}']
    missions = [found[(stage, *case)] for case in cases]
    seconds = statistics.mean(mission.seconds for mission in missions)
    missed = sum(not math.isfinite(mission.multiple) for mission in missions)
    print(ROW.format(stage, *columns, f'{seconds:.2f}', missed), flush=True)


def parsed():
    """The arguments."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--without', nargs='*', default=list(STAGES), choices=list(STAGES), metavar='STAGE',
                        help=', '.join(STAGES))
    parser.add_argument('--floors', nargs='+', default=[*PACKAGED, *HARD], metavar='FLOOR',
                        choices=[*PACKAGED, *hard_floors.KINDS], help='packaged maps, and kinds of hard floors')
    parser.add_argument('--seeds', type=span, default=[0, 1, 2], help='of the starts, or of the hard floors: 0-2')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--each', action='store_true', help='print each mission')
    return parser.parse_args()


def run(stage, name, seed, target):
    """One mission without a stage."""
    is_packaged = name in PACKAGED
    floor = map_file.load(named_maps.path(name)) if is_packaged else hard_floors.floor(name, seed, RESOLUTION)
    conditions = Conditions(start=ANYWHERE if is_packaged else DOCK, target=target)
    watch = Stopwatch()
    with contextlib.ExitStack() as stack:
        for place, function, other in STAGES[stage]:
            stack.enter_context(mock.patch.object(place, function, other))
        stack.enter_context(mock.patch.object(boustrophedon, 'plan', watch))
        trial = Trial(floor, 'boustrophedon', conditions, seed)
        while not trial.is_over:
            trial.step()
    result = trial.result()
    return Mission(result.multiple_to(round(100.0 * target)), result.coverage, watch.seconds)


if __name__ == '__main__':
    main()
