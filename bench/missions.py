"""Speed of whole missions in process: one after another, and by the workers of `evaluate` on all cores.

`missions.py [--missions N]`: N missions for the workers, 40 by default; one worker alone does a part of them.
"""

import argparse
import os
import statistics
import time
from typing import NamedTuple

from common import figures

from rumba_evaluation.trials import batch
from rumba_evaluation.trials.batch import Job
from rumba_evaluation.trials.cases import Case, Conditions
from rumba_sim.model.maps import named_maps

STRATEGY = 'boustrophedon'
NAMES, SEEDS = ('studio', 'apartment'), range(1, 6)
MAP = 'apartment'  # of the missions of the workers
SPEED = 1000  # simulated seconds in a CPU second, the lower bound
SCALING = 90.0  # [%] of the missions in a second that as many single processes would do, the lower bound
ALONE = 100  # missions that one worker does alone, at most
GROWTH = 5.0  # [%] of the memory of a worker, from the first tenth of its missions to the last one, the upper bound


class Mission(NamedTuple):
    """What a mission took."""

    simulated: float  # [s]
    cpu: float  # [s]
    worker: int  # process id
    megabytes: float  # that the worker held afterwards


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--missions', type=int, default=40)
    count = parser.parse_args().missions
    figures.heading(f'Whole missions in process, {STRATEGY}, planning included; figures for one CPU second')
    for name in NAMES:
        run(job(name, 0))  # the map and the compiled code are loaded
        speeds = [each.simulated / each.cpu for each in (run(job(name, seed)) for seed in SEEDS)]
        figures.row(f'{name}: simulated seconds, median of {len(SEEDS)} seeds', statistics.median(speeds),
                    at_least=SPEED)
        figures.row('    of the CPU time in the steps of the world [%]', 100.0 * share_of_world(job(name, 1)))
    workers = len(os.sched_getaffinity(0))
    figures.heading(f'{count} missions on the {MAP} by the workers of evaluate')
    few, alone = by_workers(1, min(count, ALONE))
    missions, together = by_workers(workers, count)
    single, several = len(few) / alone, count / together
    figures.row(f'missions in a second, 1 worker, {len(few)} of them', single)
    figures.row(f'missions in a second, {workers} workers', several)
    figures.row('    of those of as many single workers [%]', 100.0 * several / (workers * single), at_least=SCALING)
    figures.row('memory of a worker: largest growth [%]', max(map(growth, by_worker(missions))), below=GROWTH)


def job(name, seed):
    """The job of a mission."""
    return Job(Case(name, STRATEGY, seed, 1), Conditions(), named_maps.path(name), '')


def run(work):
    """Run a mission."""
    begin = time.process_time()
    simulated = batch.run(work).time
    return Mission(simulated, time.process_time() - begin, os.getpid(), figures.resident_megabytes())


def share_of_world(work):
    """Share of the CPU time of a mission in which its world advances: all that one call for many could spare."""
    trial = batch.prepare(work)
    advance, spent = trial.advance, 0.0

    def timed(ticks):
        nonlocal spent
        begin = time.perf_counter()
        advance(ticks)
        spent += time.perf_counter() - begin

    trial.advance = timed
    begin = time.process_time()
    batch.finish(trial)
    return spent / (time.process_time() - begin)


def by_workers(workers, count):
    """Missions in the order in which they ended, and how long all of them took [s], without the start of workers."""
    with batch.local(workers) as executor:
        list(executor.map(run, [job(MAP, 0)] * 2 * workers))  # the workers have loaded map and code
        begin = time.monotonic()
        done = [mission for _, mission in batch.each(executor, run, [job(MAP, seed) for seed in range(count)],
                                                     'missions')]
        return done, time.monotonic() - begin


def by_worker(missions):
    """The missions of each worker."""
    return [[mission for mission in missions if mission.worker == worker]
            for worker in {mission.worker for mission in missions}]


def growth(missions):
    """Growth of the memory of one worker [%]."""
    return 100.0 * (missions[-1].megabytes / missions[len(missions) // 10].megabytes - 1.0)


if __name__ == '__main__':
    main()
