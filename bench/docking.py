"""How many robots reach the dock from 200 random poses on each map that has one, and how long that takes them."""

import pathlib
import statistics

import numpy as np
from common import figures

from rumba_cleaning import control
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.homing import BUOYS
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_evaluation.trials import starts
from rumba_sim.model import map_file
from rumba_sim.model.world import World

MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
STARTS = 200
LIMIT = 600.0  # [s] of simulated time for each robot


def main():
    """Dock, and print."""
    for name in ('studio', 'apartment'):
        floor = map_file.load(MAPS / f'{name}.yaml')
        figures.heading(f'Docking on the map {name}, from {STARTS} poses')
        measure('anywhere', [begun(floor, seed) for seed in range(STARTS)])
        measure('in the field of the buoys', in_field(floor))


def begun(floor, seed):
    """A world with a robot at a random pose, and the behaviour that docks it; the same for the same seed."""
    world = World(floor, seed=seed)
    pose, = starts.anywhere(floor, world.config, world.start, 1, np.random.default_rng(seed))
    world.spawn('rumba', pose)
    return world, Dock(Context(floor, world.config, CleaningConfig(), seed))


def in_field(floor):
    """Worlds with a robot that sees a buoy of the dock."""
    worlds, seed = [], 0
    while len(worlds) < STARTS:
        world, behaviour = begun(floor, seed)
        if world.infrared('rumba').omni & BUOYS:
            worlds.append((world, behaviour))
        seed += 1
    return worlds


def measure(title, worlds):
    """Dock all robots."""
    seconds = [run(world, behaviour) for world, behaviour in worlds]
    docked = sum(world.robots['rumba'].is_docked for world, _ in worlds)
    figures.row(f'{title}: at the contacts', docked, at_least=STARTS)
    figures.row('    median time [s]', statistics.median(seconds))
    figures.row('    longest time [s]', max(seconds))


def run(world, behaviour):
    """Follow a behaviour to its end; returns how long that took [s]."""
    for _ in control.steps(behaviour, world, seconds=LIMIT):
        pass
    return world.time


if __name__ == '__main__':
    main()
