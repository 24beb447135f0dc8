"""Pictures of results; needs matplotlib.

The colours are those of Okabe and Ito, which people with any colour vision can tell apart.
"""

import math
import os
import re
from typing import Any, Dict, List, Tuple

import matplotlib
import numpy as np
from matplotlib import ticker
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from rumba_evaluation.trials.batch import Trace
from rumba_evaluation.trials.cases import Result
from rumba_evaluation.trials.table import Group
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan

COLOURS = ('#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9')
STYLES = ('-', '--', '-.', ':')  # for lines of the same colour
GREY, LIGHT, DARK, AMBER, RED = '#808080', '#D8D8D8', '#404040', '#E69F00', '#D55E00'
BAND = (10.0, 50.0, 90.0)  # [%] of the runs
BARS = (90, 98, 99)  # [%] of coverage
POINTS = 500  # of a curve
DOTS = 120  # per inch
CHUNK = 10_000  # points of a path: Agg cannot draw much more at once

Results = Dict[Group, List[Result]]


def draw_results(folder: str, groups: Results) -> None:
    """Draw coverage over time for each map, and the times to coverage of all maps in one picture."""
    for name in dict.fromkeys(group.map for group in groups):
        of_map = {group: results for group, results in groups.items() if group.map == name}
        _save(_coverage(of_map), folder, f'coverage_{_file_name(name)}')
    _save(_times(groups), folder, 'times')


def draw_path(folder: str, plan: FloorPlan, trace: Trace) -> None:
    """Draw the paths of the robots, and the floor that they missed."""
    case = trace.job.case
    parts = [_file_name(case.map), _file_name(case.strategy), str(case.robots)]
    with matplotlib.rc_context({'agg.path.chunksize': CHUNK}):
        _save(_path(plan, trace), folder, '_'.join(['path', *parts]))


def _save(figure: Any, folder: str, name: str) -> None:
    figure.savefig(os.path.join(folder, f'{name}.png'), dpi=DOTS)


def _file_name(name: str) -> str:
    return re.sub(r'\W+', '_', os.path.splitext(name)[0]).strip('_')


def _looks(groups: Results) -> Dict[Tuple[str, int], Dict[str, str]]:
    """Colour and line style by strategy and number of robots, the same in all pictures of one evaluation."""
    kinds = dict.fromkeys((group.strategy, group.robots) for group in groups)
    return {kind: {'color': COLOURS[index % len(COLOURS)], 'linestyle': STYLES[index // len(COLOURS) % len(STYLES)]}
            for index, kind in enumerate(kinds)}


def _label(strategy: str, robots: int) -> str:
    return strategy if robots == 1 else f'{strategy}, {robots} robots'


# --- coverage over time -------------------------------------------------------------------------------------------

def _coverage(groups: Results) -> Any:
    name = next(iter(groups)).map
    figure = Figure(figsize=(8.0, 4.8), constrained_layout=True)
    axes = figure.add_subplot()
    end = max(1.0, *(_end(result) for results in groups.values() for result in results))
    times = np.linspace(0.0, 1.02 * end, POINTS)
    for (strategy, robots), look in _looks(groups).items():
        results = groups[Group(name, strategy, robots)]
        low, median, high = np.percentile([_sampled(result, times) for result in results], BAND, axis=0)
        axes.plot(times, median, linewidth=1.8, label=f'{_label(strategy, robots)} ({len(results)} runs)', **look)
        axes.fill_between(times, low, high, color=look['color'], alpha=0.25, linewidth=0.0)
    axes.plot([0.0, 1.0, times[-1]], [0.0, 100.0, 100.0], color=GREY, linestyle=':', label='one brush, no overlap')
    axes.set(title=f'{name}: median and band of 80 % of the runs', xlim=(0.0, times[-1]), ylim=(0.0, 102.0),
             xlabel='working time [T = reachable area / (brush width x cleaning speed)]',
             ylabel='reachable floor that is swept [%]')
    axes.yaxis.set_major_locator(ticker.MultipleLocator(10.0))
    axes.grid(color=LIGHT, linewidth=0.6)
    axes.legend(loc='lower right')
    return figure


def _end(result: Result) -> float:
    """Working time of a mission [T]."""
    return (result.time - result.charging_time) / result.ideal_time


def _sampled(result: Result, times: Array) -> Array:
    """Coverage [%] at working times [T]."""
    known = [result.multiple_to(percent) for percent in range(1, len(result.curve) + 1)]
    return np.interp(times, [0.0, *known], np.arange(len(known) + 1))


# --- times to coverage --------------------------------------------------------------------------------------------

def _times(groups: Results) -> Any:
    maps = list(dict.fromkeys(group.map for group in groups))
    figure = Figure(figsize=(8.0, 0.8 + 2.6 * len(maps)), constrained_layout=True)
    for index, name in enumerate(maps, 1):
        axes = figure.add_subplot(len(maps), 1, index)
        _bars(axes, {group: results for group, results in groups.items() if group.map == name}, _looks(groups))
        axes.set(title=name, ylabel='working time [T]')
        if index == 1:
            axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), fontsize='small')
    axes.set_xlabel('reachable floor that is swept; bars: median, lines: worst of the runs')
    return figure


def _bars(axes: Any, groups: Results, looks: Dict[Tuple[str, int], Dict[str, str]]) -> None:
    width = 0.8 / len(groups)
    highest = 0.0
    for index, (group, results) in enumerate(groups.items()):
        positions = np.arange(len(BARS)) + (index - 0.5 * (len(groups) - 1)) * width
        times = np.array([[result.multiple_to(percent) for result in results] for percent in BARS])
        medians, worst = np.median(times, axis=1), times.max(axis=1)
        finite = np.where(np.isfinite(medians), medians, 0.0)
        axes.bar(positions, finite, 0.92 * width, color=looks[group[1:]]['color'], label=_label(*group[1:]))
        for position, median, most in zip(positions, medians, worst):
            if math.isfinite(most):
                axes.plot([position, position], [median, most], color=DARK, linewidth=1.2)
            top = most if math.isfinite(most) else median if math.isfinite(median) else 0.0
            label = f'{median:.2f}' if math.isfinite(median) else 'not\nreached'
            axes.annotate(label, (position, top), (0, 2), textcoords='offset points', ha='center', va='bottom',
                          fontsize='small')
            highest = max(highest, top)
    axes.set(xticks=range(len(BARS)), xticklabels=[f'{percent} %' for percent in BARS],
             ylim=(0.0, 1.25 * max(highest, 1.0)))
    axes.grid(axis='y', color=LIGHT, linewidth=0.6)
    axes.set_axisbelow(True)


# --- one path -----------------------------------------------------------------------------------------------------

def _path(plan: FloorPlan, trace: Trace) -> Any:
    case, result, bounds = trace.job.case, trace.result, plan.bounds
    width, height = bounds.right - bounds.left, bounds.top - bounds.bottom
    scale = 8.0 / max(width, height)
    figure = Figure(figsize=(max(scale * width, 4.0) + 0.8, scale * height + 1.2), constrained_layout=True)
    axes = figure.add_subplot()
    kinds = np.where(plan.free, 0, np.where(plan.occupancy == OCCUPIED, 2, 1))
    if plan.cliff is not None:
        kinds[plan.cliff & plan.free] = 3
    kinds[trace.missed] = 4
    axes.imshow(kinds, ListedColormap(['white', LIGHT, DARK, AMBER, RED]), vmin=0, vmax=4, origin='lower',
                extent=(bounds.left, bounds.right, bounds.bottom, bounds.top), interpolation='nearest')
    for index, path in enumerate(trace.paths):
        colour = COLOURS[(0, 2, 3, 5)[index % 4]]
        axes.plot(path[:, 0], path[:, 1], color=colour, linewidth=0.8, alpha=0.8)
        axes.plot(*path[0], 'o', color=colour, markeredgecolor='white', markersize=9, label='start')
        axes.plot(*path[-1], 's', color=colour, markeredgecolor='white', markersize=8, label='end')
    axes.plot([], [], 's', color=RED, label='missed')
    if plan.cliff is not None:
        axes.plot([], [], 's', color=AMBER, label='cliff')
    axes.set(title=f'{_label(case.strategy, case.robots)} on {case.map}, seed {case.seed}: '
                   f'{100.0 * result.coverage:.1f} % swept, {result.outcome.words} after {_end(result):.2f} T',
             xlabel='x [m]', ylabel='y [m]')
    handles, labels = axes.get_legend_handles_labels()
    unique = dict(zip(labels, handles))
    axes.legend(list(unique.values()), list(unique), loc='upper right', bbox_to_anchor=(1.0, -0.05), ncol=len(unique))
    return figure
