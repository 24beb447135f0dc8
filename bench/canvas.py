"""CPU time and memory from the file of a map to a plan, on canvases far larger than the floor, with rays of beams."""

import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
from common import canvases, drawings, figures, wings

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.planning import warm_up
from rumba_cleaning.planning.planner import plan
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

CANVASES = (0, 2000, 4000)  # [pixels] of a side; 0: no larger than the floor
SECONDS, MEGABYTES = 5.0, 700.0  # for floors of up to 200 m2: our choice
RESOLUTION = 0.05  # [m]


def main():
    """Measure and print."""
    figures.heading(f'From a map with {canvases.RAYS} rays of one cell to a plan; cells of 5 cm')
    for floor in ('room', 'furnished'):
        for size in CANVASES:  # each in a process of its own, whose memory is that of one floor
            subprocess.run([sys.executable, os.path.abspath(__file__), floor, str(size)], check=True)


def measure(floor, size):
    """Print what one plan takes."""
    with tempfile.TemporaryDirectory() as folder:
        path = canvases.write(pathlib.Path(folder), cells_of(floor), size, RESOLUTION)
        warm_up.main()
        begin = time.process_time()
        floor_plan = map_file.load(path)
        start = World(floor_plan).start
        context = Context(floor_plan, RobotConfig(), CleaningConfig())
        context.swept.begin(start.x, start.y)
        plan(context, start)
        seconds = time.process_time() - begin
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    canvas = f'on a canvas of {size} x {size}' if size else 'alone'
    figures.row(f'{floor}, {context.swept.reachable_area:.0f} m2 in reach, {canvas}: [CPU s]', seconds, below=SECONDS)
    figures.row('  memory of the process [MB]', memory, below=MEGABYTES)


def cells_of(floor):
    """The cells of a floor, row 0 at the bottom."""
    if floor == 'furnished':
        return drawings.drawn(floor, wings.furnished(np.random.default_rng(1), 250.0), RESOLUTION).occupancy
    cells = np.full((152, 202), OCCUPIED, np.int8)
    cells[1:-1, 1:-1] = FREE
    return cells


if __name__ == '__main__':
    if len(sys.argv) == 3:
        measure(sys.argv[1], int(sys.argv[2]))
    else:
        main()
