"""How many robots reach the dock from 200 random poses on each map that has one, and how long that takes them.

`docking.py [--poses POSE ...]`: by what they know where they are.
"""

import argparse
import itertools
import pathlib
import statistics

import numpy as np
from common import figures

from rumba_cleaning import control
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.homing import BUOYS
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.pose_source import Localised, truth
from rumba_evaluation.trials import starts
from rumba_evaluation.trials.cases import LOCALISED, TRUTH
from rumba_sim.model.maps import map_file
from rumba_sim.model.simulation.world import World

MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
STARTS = 200
LIMIT = 600.0  # [s] of simulated time for each robot


def main():
    """Dock, and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--poses', nargs='+', choices=(TRUTH, LOCALISED), default=(TRUTH, LOCALISED))
    arguments = parser.parse_args()
    for name, pose in itertools.product(('studio', 'apartment'), arguments.poses):
        floor = map_file.load(MAPS / f'{name}.yaml')
        figures.heading(f'Docking on the map {name}, from {STARTS} poses, by the pose: {pose}')
        measure('anywhere', pose, [begun(floor, seed) for seed in range(STARTS)])
        measure('in the field of the buoys', pose, in_field(floor))


def begun(floor, seed):
    """A world with a robot at a random pose, the same for the same seed."""
    world = World(floor, seed=seed)
    pose, = starts.anywhere(floor, world.config, world.start, 1, np.random.default_rng(seed))
    world.spawn('rumba', pose)
    return world


def in_field(floor):
    """Worlds with a robot that sees a buoy of the dock."""
    worlds = (begun(floor, seed) for seed in itertools.count())
    return list(itertools.islice((world for world in worlds if world.infrared('rumba').omni & BUOYS), STARTS))


def measure(title, pose, worlds):
    """Dock all robots."""
    seconds = [run(world, pose) for world in worlds]
    docked = sum(world.robots['rumba'].is_docked for world in worlds)
    figures.row(f'{title}: at the contacts', docked, at_least=STARTS)
    figures.row('    median time [s]', statistics.median(seconds))
    figures.row('    longest time [s]', max(seconds))


def run(world, pose):
    """Dock the robot of a world; returns how long that took [s]."""
    behaviour = Dock(Context(world.plan, world.config, CleaningConfig(), world.seed))
    source = Localised(world.plan, world, 'rumba', [world.seed]) if pose == LOCALISED else truth
    for _ in control.steps(behaviour, world, seconds=LIMIT, source=source):
        pass
    return world.time


if __name__ == '__main__':
    main()
