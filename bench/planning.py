"""The CPU time that the coverage planner takes, the length of its routes, and how both grow with the floor.

    python3 bench/planning.py --plot planning.png
"""

import argparse
import math
import pathlib
import time

import numpy as np
from common import drawings, figures, hard_floors, large_floors, wings

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.planning.planner import plan
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

MAPS = pathlib.Path(__file__).resolve().parents[1] / 'rumba_sim' / 'maps'
BOUNDS = ((1000.0, 3.0), (3600.0, 10.0))  # [m2, CPU s]; our choice: a person waits so long for a robot to start
AREAS = (100.0, 250.0, 500.0, 1200.0, 2400.0, 4850.0)  # [m2] of furnished plans, walls and furniture included
REHEARSED = 2  # of these are so small that routes over them are rehearsed, which takes longer
RESOLUTION = 0.05  # [m]


def main():
    """Plan, print, and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--plot', metavar='FILE', help='draw CPU time over area')
    arguments = parser.parse_args()
    figures.heading('Planning a whole floor, brush 0.17 m; CPU time of one core')
    others = [measure(name, map_file.load(MAPS / f'{name}.yaml'))
              for name in ('studio', 'apartment', 'field')]  # the first also loads the compiled code
    points = []
    for area in AREAS:
        drawing = wings.furnished(np.random.default_rng(1), area)
        points.append(measure(f'furnished, {area:g} m2 in all', drawings.drawn('furnished', drawing, RESOLUTION)))
    others.append(measure('office of 60 m x 60 m', hard_floors.floor('office', 1, RESOLUTION)))
    others += [measure(name, drawings.drawn(name, drawing, RESOLUTION))
               for name, drawing in large_floors.drawings().items()]
    (small, fast), (large, slow) = points[REHEARSED], points[-1]
    figures.row('growth: exponent of CPU time over area', math.log(slow / fast) / math.log(large / small), below=1.2)
    if arguments.plot:
        draw(points, others, arguments.plot)


def measure(name, floor):
    """Plan once; the area in reach [m2] and the CPU time [s]."""
    start = World(floor).start
    context = Context(floor, RobotConfig(), CleaningConfig())
    context.swept.begin(start.x, start.y)
    begin = time.process_time()
    route = plan(context, start)
    seconds = time.process_time() - begin
    length = float(np.hypot(*np.diff(route.waypoints, axis=0).T).sum())
    area = context.swept.reachable_area
    limit = next((bound for most, bound in BOUNDS if area <= most), None)
    figures.row(f'{name}, {area:.0f} m2 in reach: planned in [CPU s]', seconds, below=limit)
    figures.row('    length of the route * width of the brush / area', length * context.robot.brush.width / area)
    return area, seconds


def draw(points, others, path):
    """A picture of CPU times over areas."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6.0, 4.0))
    small, fast = points[REHEARSED]
    areas = np.array([10.0, 5000.0])
    axes.loglog(areas, fast / small * areas, color='0.8', label='in proportion to the floor')
    axes.loglog(*zip(*points), 'o-', label='furnished plans, cells of 5 cm')
    axes.loglog(*zip(*others), 'x', label='other floors')
    axes.step((areas[0], *(most for most, _ in BOUNDS)), (BOUNDS[0][1], *(bound for _, bound in BOUNDS)), '--',
              label='bound')
    axes.set(xlabel='floor in reach [m$^2$]', ylabel='CPU time [s]', xlim=areas, ylim=(0.3, 30.0))
    axes.legend(loc='upper left')
    figure.savefig(path, bbox_inches='tight')


if __name__ == '__main__':
    main()
