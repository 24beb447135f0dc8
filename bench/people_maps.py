"""Missions on maps as people have them: what ends below 98 % of the largest part without a word before it began.

`people_maps.py [--seeds A-B] [--jobs N]` runs seeds 1 to 30 by default; 16 to 30 are kept aside while code is mended.
Coverage is that of a judge that shares no code with the simulator, and is told how
near to walls its robots can come. Each map has a process of its own, whose memory and
CPU time up to the first plan count.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
from common import canvases, figures, people
from common.judge import Judge

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.outlook import outlook
from rumba_cleaning.planning import planner, warm_up
from rumba_cleaning.strategies import boustrophedon
from rumba_evaluation.trials.foresight import remarks_on
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.errors import RumbaError
from rumba_sim.model.floors.dock_place import place_dock
from rumba_sim.model.maps import map_file
from rumba_sim.model.simulation.world import World

SEEDS = '1-30'
ENOUGH, CLOSE = 0.98, 0.002  # of the largest part; how near the judge and the simulator must be
SECONDS, MEGABYTES, FLOOR = 5.0, 700.0, 200.0  # for floors of up to so many m2: our choice


class Watch:
    """The planner, with CPU time and memory of the process when the first plan is there."""

    def __init__(self):
        """Begin."""
        self._begin = time.process_time()
        self.seconds = self.megabytes = None

    def __call__(self, context, *poses):
        """Plan."""
        route = planner.plan(context, *poses)
        if self.seconds is None:
            self.seconds = time.process_time() - self._begin
            self.megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        return route


def main():
    """Run all missions, and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--seeds', type=span, default=SEEDS, help='default %(default)s')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--one', type=int, help=argparse.SUPPRESS)  # for the process of one map
    arguments = parser.parse_args()
    if arguments.one is not None:
        print(json.dumps(measured(people.home(arguments.one))))
        return
    figures.heading(f'{len(arguments.seeds)} maps as people have them, one robot, '
                    f'target {CleaningConfig().target_coverage:.0%}')
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as executor:
        found = []
        for each in executor.map(in_process, arguments.seeds):
            print('  ' + line(each), flush=True)
            found.append(each)
    summarise(found)


def span(text):
    """The seeds of a text such as 1-30."""
    first, _, last = text.partition('-')
    return list(range(int(first), int(last or first) + 1))


def in_process(seed):
    """What `measured` finds, by a process of its own."""
    done = subprocess.run([sys.executable, os.path.abspath(__file__), '--one', str(seed)], stdout=subprocess.PIPE,
                          check=True)
    return json.loads(done.stdout)


def measured(home):
    """How a mission goes."""
    found = {'seed': home.seed, 'robot': home.robot, 'traits': home.traits, 'canvas': home.size}
    warm_up.main()
    with tempfile.TemporaryDirectory() as folder:
        path = written(home, pathlib.Path(folder))
        try:
            return {**found, **cleaned(home, path)}
        except RumbaError as error:
            return {**found, 'refused': str(error).replace(folder, '')}


def written(home, folder):
    """Write the map, with a dock if it is to have one; returns its path."""
    arguments = folder, home.cells, home.size, home.resolution, home.rays
    path = canvases.write(*arguments, home.keys)
    if home.has_dock:
        plan, radius = map_file.load(path, home.config.drive.radius), home.config.drive.radius
        dock = place_dock(plan, radius, World(plan, home.config).start)
        if dock is not None:
            path = canvases.write(*arguments, f'{home.keys}dock: {list(dock)}\n')
    return path


def cleaned(home, path):
    """Run the mission on a map; returns what is to be known of it."""
    watch = boustrophedon.plan = Watch()
    plan = map_file.load(path, home.config.drive.radius)
    trial = Trial(plan, 'boustrophedon', seed=home.seed, robot=home.config)
    expected = outlook(plan, *trial.world.start[:2], home.config, CleaningConfig())
    lines = remarks_on(trial)
    way = driven(trial)
    result, keeps = trial.result(), float(trial.world.constants[0]['reach'])
    judge, ours = (Judge(home.floor, home.resolution, (0.0, 0.0), start, keeps, home.config.brush.width)
                   for start in (None, trial.world.start[:2]))
    judge.follow(*way)
    ours.follow(*way)
    return {'seconds': watch.seconds, 'megabytes': watch.megabytes, 'lines': lines, 'area': result.area,
            'largest': judge.area, 'ours': ours.area, 'outcome': result.outcome.name.lower(), 'message': result.message,
            'coverage': result.coverage, 'judged': ours.coverage, 'of_largest': judge.coverage,
            'docks': len(plan.docks), 'time': result.time - result.charging_time, 'expected': expected.working,
            'charges': [expected.charges, result.charges], 'multiple': result.multiple_to(98),
            'collisions': result.collisions, 'penetrated': result.penetrated}


def driven(trial):
    """Run a trial; returns the way of its robot, and whether its brush was down, as `Judge.follow` asks."""
    robot, = trial.world.robots.values()
    way = [(*robot.pose, False)]
    while not trial.is_over:
        trial.step()
        way.append((*robot.pose, not robot.brushes_up))  # which it decides at the beginning of a step
    return np.array(way)[:, :3], np.array(way)[:, 3] > 0.0


# --- what is printed --------------------------------------------------------------------------------------------------

def line(each):
    """About one map."""
    about = f'{each["seed"]}: {each["robot"]}, {each["traits"]}, canvas {each["canvas"]}'
    if 'refused' in each:
        return f'{about}: refused: {each["refused"]}'
    told = ''.join(f'\n      told: {text}' for text in each['lines'])
    return (f'{about}, {each["docks"]} docks: {each["area"]:.1f} of {each["largest"]:.1f} m2, {each["outcome"]}, '
            f'{each["coverage"]:.2%} (judge {each["judged"]:.2%}, {each["of_largest"]:.2%} of the largest part), '
            f'{each["multiple"]:.2f} T, {each["collisions"] / each["area"]:.2f} bumps/m2, {each["time"] / 60:.0f} min '
            f'({each["expected"] / 60:.0f} expected), charges {each["charges"]}, plan {each["seconds"]:.1f} CPU s, '
            f'{each["megabytes"]:.0f} MB{"" if each["of_largest"] >= ENOUGH else "; " + each["message"]}{told}')


def is_in_order(each):
    """Whether a mission ended with enough of the largest part, or a line came before it that says why not."""
    if 'refused' in each or each['of_largest'] >= ENOUGH - CLOSE:
        return True
    reason = 'has no dock' if each['outcome'] == 'battery_low' else 'is not planned'
    return any(reason in text for text in each['lines'])


def summarise(found):
    """Print what all have in common."""
    ended = [each for each in found if 'refused' not in each]
    figures.row('98 % of the largest part, or a line before the start', sum(map(is_in_order, found)),
                at_least=len(found))
    figures.row('    of these 98 % of the largest part',
                sum(each['of_largest'] >= ENOUGH - CLOSE for each in ended))
    figures.row('in a wall', sum(each['penetrated'] for each in ended), below=1)
    small = [each for each in ended if each['area'] <= FLOOR]
    figures.row(f'up to the first plan, floors of up to {FLOOR:g} m2: longest [CPU s]',
                max(each['seconds'] for each in small), below=SECONDS)
    figures.row('    largest memory [MB]', max(each['megabytes'] for each in small), below=MEGABYTES)
    figures.row('coverage by the judge and by the simulator: largest difference [%]',
                100.0 * max(abs(each['judged'] - each['coverage']) for each in ended), below=100.0 * CLOSE)
    ratios = [each['time'] / each['expected'] - 1.0 for each in ended if each['outcome'] == 'succeeded']
    figures.row('working time, more than was expected before: least [%]', 100.0 * min(ratios))
    figures.row('    most [%]', 100.0 * max(ratios))
    figures.row('    wrong by 15 % at most [missions]', sum(abs(ratio) <= 0.15 for ratio in ratios),
                at_least=len(ratios))


if __name__ == '__main__':
    main()
