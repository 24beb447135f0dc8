"""The picture of a map: what is reached, what is closed and where, docks and start; needs matplotlib.

The colours are those of Okabe and Ito, which people with any colour vision can tell apart.
"""

import math
import os
from typing import Any, List, Tuple

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from rumba_evaluation.inspection.barriers import Kind
from rumba_evaluation.inspection.findings import Findings
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED

FREE, UNKNOWN, WALL, CLIFF, REACHED, CLOSED = range(6)
COLOURS = ('white', '#D8D8D8', '#404040', '#56B4E9', '#BFE3D6', '#F6D9A8')
RED, DARK_GREEN, ORANGE, PURPLE, BLUE = '#D55E00', '#009E73', '#E69F00', '#CC79A7', '#0072B2'
NAMES = ((REACHED, 'the brush reaches it'), (CLOSED, 'closed'), (FREE, 'free, beside walls'), (UNKNOWN, 'unknown'),
         (WALL, 'wall'))
DOTS = 120  # per inch
LARGEST = 9.0  # [inch] of the map
SHORTEST = 0.02  # of the longer side of the map, of a barrier that is to be seen without a ring around it


def draw(found: Findings, path: str) -> None:
    """Draw the picture into a file."""
    bounds = found.plan.bounds
    width, height = bounds.right - bounds.left, bounds.top - bounds.bottom
    scale = LARGEST / max(width, height)
    figure = Figure(figsize=(max(scale * width, 3.0), max(scale * height, 2.0)))
    axes = figure.add_subplot()
    axes.imshow(_kinds(found), ListedColormap(list(COLOURS)), vmin=0, vmax=len(COLOURS) - 1, origin='lower',
                extent=(bounds.left, bounds.right, bounds.bottom, bounds.top), interpolation='nearest')
    for kind, name in NAMES:
        axes.plot([], [], 's', color=COLOURS[kind], markeredgecolor='#808080', label=name)
    if found.plan.cliff is not None:
        axes.plot([], [], 's', color=COLOURS[CLIFF], label='cliff')
    _draw_specks(axes, found)
    _draw_closed(axes, found, max(width, height))
    _draw_docks(axes, found)
    axes.plot(*found.start[:2], 'o', color=BLUE, markeredgecolor='white', markersize=9, label='start')
    axes.set(xlabel='x [m]', ylabel='y [m]', xlim=(bounds.left, bounds.right), ylim=(bounds.bottom, bounds.top))
    axes.set_title(f'{os.path.basename(found.plan.name)}: {found.expected.area:.1f} m$^2$ reached', fontsize='medium')
    handles, labels = axes.get_legend_handles_labels()
    unique = dict(zip(labels, handles))
    axes.legend(list(unique.values()), list(unique), loc='upper center', ncol=4, fontsize='small', frameon=False,
                bbox_to_anchor=(0.5, -0.55 / max(scale * height, 2.0)))
    figure.savefig(path, dpi=DOTS, bbox_inches='tight', format='png')


def _kinds(found: Findings) -> Array:
    """What each cell of the refined plan is."""
    terrain = found.plan.refined()
    kinds = np.where(terrain.free, FREE, np.where(terrain.occupancy == OCCUPIED, WALL, UNKNOWN))
    if terrain.cliff is not None:
        kinds[terrain.cliff & terrain.free] = CLIFF
    kinds[found.reached] = REACHED
    for part in found.closed:
        kinds[part.reached] = CLOSED
    return kinds


def _draw_specks(axes: Any, found: Findings) -> None:
    rows, columns = np.nonzero(found.specks)
    if len(rows):
        left, bottom = found.plan.origin
        axes.plot(left + (columns + 0.5) * found.plan.resolution, bottom + (rows + 0.5) * found.plan.resolution, '.',
                  color=PURPLE, markersize=5, label='speck of unknown cells')


def _draw_closed(axes: Any, found: Findings, size: float) -> None:
    """The number of each closed part, and what keeps robots out, with its width."""
    for number, part in enumerate(found.closed, 1):
        axes.text(part.pose.x, part.pose.y, str(number), ha='center', va='center', fontsize='x-large', weight='bold',
                  color=RED)
        if part.barrier is None:
            continue
        ends: List[Tuple[float, float]] = list(part.barrier.ends)
        is_gap = part.barrier.kind is Kind.GAP
        label = 'narrowest gap' if is_gap else 'thinnest place between'
        style = '-' if is_gap else ':'
        axes.plot(*zip(*ends), style, color=RED, linewidth=3, solid_capstyle='butt', label=label)
        x, y = (0.5 * (one + other) for one, other in zip(*ends))
        if math.dist(*ends) < SHORTEST * size:
            axes.plot(x, y, 'o', markersize=16, markerfacecolor='none', markeredgecolor=RED)
        what = f'{part.barrier.width:.3f} m' if is_gap else f'{part.barrier.kind.value}, {part.barrier.width:.2f} m'
        axes.annotate(what, (x, y), (8, 8), textcoords='offset points', color=RED,
                      fontsize='small', bbox={'facecolor': 'white', 'edgecolor': 'none', 'alpha': 0.8, 'pad': 1.0})


def _draw_docks(axes: Any, found: Findings) -> None:
    for dock in found.plan.docks:
        _draw_dock(axes, found, dock, DARK_GREEN, 'dock')
    if found.dock is not None:
        _draw_dock(axes, found, found.dock, ORANGE, 'place for a dock')


def _draw_dock(axes: Any, found: Findings, dock: Pose, colour: str, label: str) -> None:
    """A robot at a dock, with a line to the front."""
    radius = found.robot.drive.radius
    turn = np.linspace(0.0, 2.0 * math.pi, 40)
    axes.fill(dock.x + radius * np.cos(turn), dock.y + radius * np.sin(turn), color=colour, alpha=0.6)
    axes.plot([dock.x, dock.x + radius * math.cos(dock.theta)], [dock.y, dock.y + radius * math.sin(dock.theta)],
              color='black', linewidth=1.5)
    axes.plot([], [], 'o', color=colour, alpha=0.6, label=label)
