"""How missions end among obstacles that the map does not show, one or two of which move.

`obstacles.py [--seeds N] [--poses POSE ...] [--bumper] [--crowded]` runs seeds 1 to N, 20 by default, on all
cores; times are simulated. A mission has reached what it can when it lacks 0.1 % of the floor, or less, of what it has
swept in the end; from then on it has 15 % of its time to find that out, and to get home.
"""

import argparse
import concurrent.futures
import functools
import itertools
import math
import statistics
from typing import NamedTuple

import numpy as np
from common import figures
from common.judge import Tracks

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import LOCALISED, POSES, TRUTH, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.simulation.obstacle import Obstacle, walk

NAMES = ('studio', 'apartment')
TARGET = 0.98
AREA = 3.0  # [m^2] of floor for each thing that stands there, and one that moves
CROWDED = 10, 2  # that stand and that move on any floor
LAST = 0.001  # of the coverage in the end, which a mission may gain late
LATE = 1.15  # times the time at which it has reached what it can, in which a mission is home
JUDGED = 0.2  # [points] by which coverage may differ from that of an independent judge
KEPT = 1.0  # [m] around the dock, where nothing stands
ENDED = (Outcome.SUCCEEDED, Outcome.INCOMPLETE)
LIMIT = 20.0  # [T] of working time, after which a mission counts as one that does not end
LEAST = 0.95  # of what is free: a mission that ends with less gave up too early


class Mission(NamedTuple):
    """A mission among obstacles."""

    outcome: Outcome
    coverage: float  # of what can be reached beside all that stands there [0..1]
    multiple: float  # working time in multiples of T
    multiple_98: float  # the same until 98 % were swept; inf if they never were
    collisions: int
    is_home: bool
    has_penetrated: bool  # a wall or an obstacle
    late: float  # time of the end in multiples of that at which it had reached what it can
    off: float  # coverage beyond that of the judge [points]
    message: str

    @property
    def is_in_order(self):
        """Whether it ended at its target, or with about what could be reached."""
        return self.outcome in ENDED and self.coverage >= LEAST


@functools.lru_cache(maxsize=None)
def floor(name):
    """The plan of a map."""
    return map_file.load(named_maps.path(name))


def counts(plan, is_crowded):
    """How many things stand on a floor, and how many move."""
    return CROWDED if is_crowded else (round(plan.free.sum() * plan.resolution ** 2 / AREA), 1)


def drawn(plan, seed, is_crowded):
    """Obstacles for a floor, as different as what lies in a home."""
    generator = np.random.default_rng([seed, 7])
    standing, moving = counts(plan, is_crowded)
    found = [_standing(f'thing_{number}', _place(plan, generator), generator) for number in range(standing)]
    for number in range(moving):
        start = _place(plan, generator)
        ways = sorted((_place(plan, generator) for _ in range(8)),
                      key=lambda place: abs(math.hypot(place.x - start.x, place.y - start.y) - 2.0))
        found.append(Obstacle(f'mover_{number}', start, 0.25, float(generator.uniform(0.08, 0.16)),
                              stops=walk([start, *ways[:2]], float(generator.uniform(0.2, 0.6)), False, 2.0, 20.0)))
    return found


def _standing(name, pose, generator):
    height = float(generator.choice([0.05, 0.3]))
    if generator.random() < 0.5:
        return Obstacle(name, pose, height, float(generator.uniform(0.03, 0.2)))
    return Obstacle(name, pose, height, 0.0, *generator.uniform(0.08, 0.5, 2).tolist())


def _place(plan, generator):
    """A pose on free floor, not near the dock."""
    dock, radius = plan.dock or plan.start, 0.1
    free = np.argwhere((plan.clearance > radius)[:-1, :-1])
    for row, column in generator.permutation(free):
        x, y = plan.origin[0] + column * plan.resolution, plan.origin[1] + row * plan.resolution
        if math.hypot(x - dock.x, y - dock.y) > KEPT:
            return Pose(float(x), float(y), float(generator.uniform(-math.pi, math.pi)))
    raise ValueError('no place is free')


def mission(name, pose, has_laser, is_crowded, seed):
    """A mission on a map, by a kind of pose, by bumper alone or by laser too."""
    plan = floor(name)
    things = drawn(plan, seed, is_crowded)
    trial = Trial(plan, 'boustrophedon', Conditions(pose=pose, target=TARGET, laser=has_laser, bound=LIMIT), seed,
                  obstacles=things)
    tracks, curve = Tracks(trial.world), []
    trial.advance = tracks.advance
    while not trial.is_over:
        trial.step()
        curve.append((trial.working_time, trial.world.floor.coverage))
    result = trial.result()
    reached = next(time for time, coverage in curve if coverage >= result.coverage - LAST)
    judge = tracks.judge(plan, trial.world.config, [thing for thing in things if not thing.stops])
    return Mission(result.outcome, result.coverage, (result.time - result.charging_time) / result.ideal_time,
                   result.multiple_to(98), result.collisions, result.docked == 1, result.penetrated,
                   curve[-1][0] / reached, 100.0 * (result.coverage - judge.coverage), result.message)


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=int, default=20)
    parser.add_argument('--first', type=int, default=1, help='seed')
    parser.add_argument('--poses', nargs='+', choices=POSES, default=(TRUTH, LOCALISED))
    parser.add_argument('--bumper', action='store_true', help='robots find obstacles by their bumpers alone')
    parser.add_argument('--crowded', action='store_true', help='{} stand and {} move on each floor'.format(*CROWDED))
    parser.add_argument('--each', action='store_true', help='print a line for each mission')
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.first + arguments.seeds)
    with concurrent.futures.ProcessPoolExecutor() as executor:
        for name, pose in itertools.product(NAMES, arguments.poses):
            standing, moving = counts(floor(name), arguments.crowded)
            figures.heading(f'{standing} things that stand and {moving} that move on the map {name}, pose: {pose}, '
                            f'{"bumper alone" if arguments.bumper else "laser and bumper"}, {len(seeds)} seeds')
            run = functools.partial(mission, name, pose, not arguments.bumper, arguments.crowded)
            show(seeds, list(executor.map(run, seeds)), arguments.each)


def show(seeds, missions, is_each):
    """Print how missions went."""
    if is_each:
        for seed, each in zip(seeds, missions):
            print(f'  {seed}: {each.outcome.name}, {100 * each.coverage:.1f} %, {each.multiple:.2f} T, '
                  f'{each.late:.2f} times as long as needed, judged {-each.off:+.2f} points, '
                  f'{each.collisions} collisions, home {each.is_home}: {each.message}')
    figures.row('ended at the target, or with what could be reached', sum(each.is_in_order for each in missions),
                at_least=len(missions))
    figures.row(f'home within {LATE:g} times the time at which they had reached what they can',
                sum(each.late <= LATE for each in missions), at_least=len(missions))
    figures.row('    the longest, in multiples of that time', max(each.late for each in missions))
    figures.row('coverage is off that of an independent judge by, at most [points]',
                max(abs(each.off) for each in missions), below=JUDGED)
    figures.row('succeeded', sum(each.outcome is Outcome.SUCCEEDED for each in missions))
    figures.row('home', sum(each.is_home for each in missions), at_least=len(missions))
    figures.row('in a wall or an obstacle', sum(each.has_penetrated for each in missions), below=1)
    figures.row('swept of what is free at the end, median [%]',
                100.0 * statistics.median(each.coverage for each in missions))
    figures.row('    the same, least [%]', 100.0 * min(each.coverage for each in missions))
    figures.row('working time, median [T]', statistics.median(each.multiple for each in missions))
    figures.row('    the same, longest [T]', max(each.multiple for each in missions))
    figures.row('98 % swept of what is free, median [T]',
                statistics.median(each.multiple_98 for each in missions))
    figures.row('collisions, median', statistics.median(each.collisions for each in missions))


if __name__ == '__main__':
    main()
