"""Whether a robot that cleans every day for a month holds what it held at first: memory, files, threads.

`endurance.py [--days N]` simulates N days in process, 3 by default: each morning a mission on the map apartment, then
the robot rests on its dock.
"""

import argparse
import os
import threading

import tqdm
from common import figures

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import STEP_RATE, steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_sim.model import map_file, named_maps
from rumba_sim.model.world import World

DAY = 86400  # [s]
TARGET = 0.98
STRIDE = 10  # [s] of rest in one call
GROWTH = 5.0  # [%] from the second day on, the upper bound


def main():
    """Simulate and print."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--days', type=int, default=3)
    days = parser.parse_args().days
    if days < 2:
        parser.error(f'--days is {days}: must be 2 or more, since growth counts from the second day on')
    plan = map_file.load(named_maps.path('apartment'))
    world = World(plan, step_rate=STEP_RATE, seed=1)
    world.spawn('rumba', brushes_up=True)
    held = [a_day(plan, world, day) for day in tqdm.trange(days, unit='day', disable=None)]
    figures.heading(f'A robot that cleans the apartment every morning, {days} days in process')
    figures.row('simulated time [days]', world.time / DAY, at_least=days)
    figures.row('driven [km]', world.robots['rumba'].distance / 1000.0)
    for day in sorted({0, 1, days // 2, days - 1}):
        megabytes, files, threads = held[day]
        figures.row(f'day {day + 1}: memory [MB]', megabytes)
        figures.row('    open files', files)
        figures.row('    threads', threads)
    figures.row('memory: growth since the second day [%]', 100.0 * (held[-1][0] / held[1][0] - 1.0), below=GROWTH)


def a_day(plan, world, day):
    """A mission and the rest of a day; returns memory [MB], open files and threads of this process in the evening.

    Raises:
        AssertionError: the mission failed.
    """
    end = world.time + DAY
    context = Context(plan, world.config, CleaningConfig(), seed=day)
    mission = Mission(context, 'boustrophedon', TARGET)
    for _ in steps(mission, world, seconds=0.5 * DAY):
        pass
    assert mission.outcome is Outcome.SUCCEEDED and world.robots['rumba'].is_docked, mission.message
    while world.time < end:
        world.step(STRIDE * STEP_RATE)
    return figures.resident_megabytes(), len(os.listdir('/proc/self/fd')), threading.active_count()


if __name__ == '__main__':
    main()
