"""How well robots map and find themselves by the lasers that people buy, and by logs of real ones.

`lasers.py [--logs FOLDER] [--seeds N] [--jobs N] [--models NAME ...] [--floors NAME ...]` maps each log of CARMEN in
the folder, whose poses must be corrected, and has robots clean homes with each laser of the simulator: by a map of
their own, and localised on the map; seeds 1 to N, 20 by default.
"""

import argparse
import concurrent.futures
import math
import pathlib
import statistics
import time
from typing import NamedTuple

import numpy as np
from common import figures
from mapping import Watched, centres, compared, floor
from scipy import ndimage
from scipy.spatial import cKDTree
from tqdm import tqdm

from rumba_evaluation.trials.cases import LOCALISED, SLAM, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_localisation.logs import carmen, trajectory
from rumba_localisation.mapping.grids.grid import placed
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.scan import Reading, thinned
from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.laser_config import MODELS, LaserConfig

FLOORS = ('studio', 'apartment')
WANTED = 0.97  # of the floor that can be reached
ASKED = {SLAM: 0.99, LOCALISED: 0.98}  # of what the map shows: one's own lacks up to 2 % of the floor if the laser errs
FARTHEST = 30.0  # [m] that a range of a log counts, as for gmapping by its maxUrange
NEAR = 0.05  # [m] from a wall that a wall cell may be
BEAMS = 200  # of a key frame, at most, by which it is told from how far walls were seen
# Scans that are left out, since a log is wrong there, by how its name begins.
FAULTS = {'freiburg-079': range(1374, 1395)}


class Mission(NamedTuple):
    """A mission with a laser."""

    coverage: float  # true share of the reachable floor that was swept
    is_home: bool
    error: float  # RMS of the position [m]
    near: float  # share of the wall cells of the map that are within NEAR of a wall
    fair: float  # share that are within what is `allowed`
    rescaled: float  # share that would be within NEAR without the error in proportion to the range: it scales the map
    sigma: float  # [m] that the mapper took for the noise of the ranges that err least


def log_lines(path):
    """Map a log; lines of a table."""
    begun, found, true, lost, mapper = time.process_time(), [], [], 0, None
    left_out = next((scans for name, scans in FAULTS.items() if path.name.startswith(name)), ())
    for number, entry in enumerate(carmen.entries(str(path), True, Reading(max_range=FARTHEST), lambda _: None)):
        mapper = mapper or Mapper(entry.reference)
        mapper.observe(entry.odometry, entry.scan)
        if number not in left_out:
            lost += mapper.is_lost
            found.append((entry.stamp, mapper.pose(entry.odometry)))
            true.append((entry.stamp, entry.reference))
    spent = time.process_time() - begun
    errors = trajectory.compared(found, true)
    omitted = f', without {left_out[0]} to {left_out[-1]}, where its odometry errs 0.3 m each' if left_out else ''
    figures.heading(f'{path.name}: {len(found)} scans{omitted}')
    figures.row('RMS of the position [m]', errors.absolute)
    figures.row('    after the best alignment', errors.aligned)
    figures.row('RMS over 1 m of way [m]', errors.relative)
    figures.row('scans while the robot was lost', lost)
    figures.row('seconds of the log per CPU second', (found[-1][0] - found[0][0]) / spent)


class Mapping(Watched):
    """A source of poses that makes a map, with the scans of its key frames."""

    def __init__(self, source):
        """Watch a source."""
        super().__init__(source)
        self.scans = [None] * len(source.mapper.frames)  # the first scan was taken before

    def __call__(self, world, name):
        """What the source believes."""
        belief = super().__call__(world, name)
        if len(self.source.mapper.frames) > len(self.scans):
            self.scans.append(belief.scan)
        return belief

    def ranges(self, cells):
        """From how far cells (cells, 2) [m] were seen, median of the key frames: float64 (cells); 0 if not at all."""
        ends, lengths = [], []
        for pose, scan in zip(self.source.mapper.frames, self.scans):
            if scan is not None:
                points = thinned(scan.points, BEAMS)
                ends.append(placed(pose, points))
                lengths.append(np.hypot(*(points - scan.laser).T))
        away, nearest = cKDTree(cells).query(np.concatenate(ends), distance_upper_bound=NEAR)
        is_met = np.isfinite(away)
        found = np.zeros(len(cells))
        met = np.unique(nearest[is_met])
        found[met] = ndimage.median(np.concatenate(lengths)[is_met], nearest[is_met], met)
        return found


def laser_of(model):
    """The parameters of a laser."""
    return from_mapping(LaserConfig, {'model': model}, model)


def allowed(model, ranges):
    """How far wall cells may be from a wall [m] that were seen from a range: the systematic error, if that is more."""
    laser = laser_of(model)
    return np.maximum(NEAR, 2.0 * np.maximum(laser.bias, ranges * laser.relative_bias))  # the maker's limit, two sigma


def mission(name, model, pose, seed):
    """A mission on a floor with a laser."""
    strategy = 'explore_and_clean' if pose == SLAM else 'boustrophedon'
    trial = Trial(floor(name), strategy, Conditions(pose=pose, target=ASKED[pose], laser_model=model), seed)
    watched = trial.sources['rumba'] = (Mapping if pose == SLAM else Watched)(trial.sources['rumba'])
    while not trial.is_over:
        trial.step()
    result, source = trial.result(), watched.source
    error = math.sqrt(np.mean(np.square(watched.errors)))
    if pose != SLAM:
        return Mission(result.coverage, result.docked == 1, error, math.nan, math.nan, math.nan, math.nan)
    plan = source.plan()
    limits = allowed(model, watched.ranges(centres(plan)))
    near, fair = (compared(plan, floor(name), limit)[0] for limit in (NEAR, limits))
    scale = 1.0 + trial.world.noise.biases[0] * laser_of(model).relative_bias
    left, bottom = plan.origin
    true = FloorPlan(plan.name, plan.occupancy, plan.resolution / scale, (left / scale, bottom / scale))
    rescaled = compared(true, floor(name), NEAR)[0]
    return Mission(result.coverage, result.docked == 1, error, near, fair, rescaled, source.mapper.noise.sigma)


def mission_lines(name, model, pose, missions):
    """Lines of a table."""
    figures.heading(f'{model}, {name}, {"by a map of its own" if pose == SLAM else "localised on the map"}')
    figures.row(f'missions that sweep {100 * WANTED:.0f} % and come home, of {len(missions)}',
                sum(each.coverage >= WANTED and each.is_home for each in missions))
    figures.row('coverage, median [%]', 100.0 * statistics.median(each.coverage for each in missions))
    figures.row('    worst', 100.0 * min(each.coverage for each in missions))
    figures.row('RMS error of position [m], median', statistics.median(each.error for each in missions))
    figures.row('    worst', max(each.error for each in missions))
    if pose == SLAM:
        figures.row(f'wall cells within {NEAR:.2f} m of a wall, median [%]',
                    100.0 * statistics.median(each.near for each in missions))
        figures.row('    or within the systematic error of the laser there',
                    100.0 * statistics.median(each.fair for each in missions))
        if laser_of(model).relative_bias > 0.0:
            figures.row(f'    within {NEAR:.2f} m on a map without the scale of the laser',
                        100.0 * statistics.median(each.rescaled for each in missions))
        figures.row('noise that was estimated [m], median', statistics.median(each.sigma for each in missions))


def main():
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--logs', type=pathlib.Path, help='folder of corrected logs of CARMEN')
    parser.add_argument('--seeds', type=int, default=20)
    parser.add_argument('--jobs', type=int, default=None, help='processes; one for each core by default')
    parser.add_argument('--models', nargs='+', choices=tuple(MODELS), default=tuple(MODELS))
    parser.add_argument('--floors', nargs='+', choices=FLOORS, default=FLOORS)
    arguments = parser.parse_args()
    logs = sorted(arguments.logs.glob('*.log*')) if arguments.logs else []
    if not logs:
        print('no logs: give their folder by --logs')
    for path in logs:
        log_lines(path)
    seeds = range(1, arguments.seeds + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as executor:
        for model in arguments.models:
            for name in arguments.floors:
                for pose in (SLAM, LOCALISED):
                    count = len(seeds)
                    missions = executor.map(mission, [name] * count, [model] * count, [pose] * count, seeds)
                    missions = list(tqdm(missions, f'{model}, {name}', count, unit=' missions', disable=None))
                    mission_lines(name, model, pose, missions)


if __name__ == '__main__':
    main()
