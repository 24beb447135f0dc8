"""Draws the stages of a plan for the apartment: ./rumba shell python3 docs/pictures/stages.py [FILE]"""

import pathlib
import sys

import numpy as np
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.figure import Figure

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.planning import planner
from rumba_cleaning.planning.order.route import through
from rumba_cleaning.planning.swaths.drafting import choices, drafted
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.model.maps.floor_colours import LIGHT
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

PALE = 0.75  # of white in the colours of regions


def main(path=pathlib.Path(__file__).with_name('stages.png')):
    """Plan, and draw what each stage comes to, into a file."""
    floor = map_file.load(named_maps.path('apartment'))
    start = World(floor).start
    context = Context(floor, RobotConfig(), CleaningConfig())
    context.swept.begin(start.x, start.y)
    problem = planner.posed(context, start)
    labels, draft = problem.labels, next(drafted(problem, choices(problem)))
    route = through(problem, draft.stretches)
    figure = Figure(figsize=(10.0, 8.0), layout='constrained')
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    colours = LIGHT.lines
    for axes, title in zip(panels, ('1  Regions', '2, 3  Rings and lanes, of the first draft', '4  Tour',
                                    '5  Improved: the plan')):
        show(axes, floor, labels, colours)
        axes.set_title(title, loc='left')
    for part in draft.stretches:
        panels[1].plot(*part.variants[0].path().T, color=colours[part.region % len(colours)], linewidth=1.0)
    panels[2].plot(*route.waypoints.T, color=colours[0], linewidth=0.8)
    panels[3].plot(*planner.plan(context, start).waypoints.T, color=colours[0], linewidth=0.8)
    figure.savefig(str(path), dpi=90)


def show(axes, floor, labels, colours):
    """The walls, and the regions in pale colours."""
    left, bottom = floor.origin
    right, top = left + floor.columns * floor.resolution, bottom + floor.rows * floor.resolution
    pale = [(1.0, 1.0, 1.0), *(tuple(PALE + (1.0 - PALE) * np.array(to_rgb(colour))) for colour in colours)]
    shown = np.where(labels > 0, 1 + labels % len(colours), 0)
    axes.imshow(shown, cmap=ListedColormap(pale), vmin=-0.5, vmax=len(pale) - 0.5, origin='lower',
                extent=(left, right, bottom, top), interpolation='nearest')
    walls = np.ma.masked_equal(floor.occupancy > 50, False)
    axes.imshow(walls, cmap=ListedColormap([LIGHT.wall]), origin='lower', extent=(left, right, bottom, top),
                interpolation='nearest')
    axes.set_axis_off()


if __name__ == '__main__':
    main(*sys.argv[1:])
