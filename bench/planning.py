"""The CPU time that the coverage planner takes, and the length of its routes."""

import pathlib
import time

import numpy as np
from common import figures
from common.office import office

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.planning.planner import plan
from rumba_sim.model import map_file
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.model.world import World

MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
LIMIT = 10.0  # [s] for 1000 x 700 cells, at most; our choice: a person waits that long for a robot to start


def main():
    """Plan on the maps of the package, and on offices of 1000 x 700 cells."""
    figures.heading('Planning a whole floor, brush 0.17 m; CPU time of one core')
    for name in ('studio', 'apartment', 'field'):
        measure(name, map_file.load(MAPS / f'{name}.yaml'))
    measure('office of 20 m x 14 m, cells of 2 cm', office(700, 1000, 0.02, 25, 2))
    measure('office of 50 m x 35 m, cells of 5 cm', office(700, 1000, 0.05, 250, 1))


def measure(name, floor):
    """Plan once."""
    start = World(floor).start
    context = Context(floor, RobotConfig(), CleaningConfig())
    context.swept.begin(start.x, start.y)
    begin = time.process_time()
    route = plan(context, start)
    seconds = time.process_time() - begin
    length = float(np.hypot(*np.diff(route.waypoints, axis=0).T).sum())
    area = context.swept.reachable_area
    figures.row(f'{name}, {area:.0f} m2 in reach: planned in [CPU s]', seconds, below=LIMIT)
    figures.row('    length of the route * width of the brush / area', length * context.robot.brush.width / area)


if __name__ == '__main__':
    main()
