"""The figures of a mission's report, as markup that goes into the page."""

from __future__ import annotations

import base64
import html
import io
import math
import re
from typing import Any, NamedTuple, Sequence, Tuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, MultipleLocator

from rumba_evaluation.report.mission_events import LOW, bump_places, contacts
from rumba_evaluation.report.mission_record import STATES, Grid, MissionRecord, charging_spans, leaps, state_spans

# What the page calls a colour: in light, and in dark. Those of the light page stand in the SVG until they are replaced
# by the name, so no two may be the same.
COLOURS = {
    'ink': ('#1f2933', '#e4e7eb'), 'faint': ('#7b8794', '#9aa5b1'), 'rule': ('#d9dee4', '#3a444f'),
    'path': ('#1d5f9e', '#7cb8f0'), 'bump': ('#c2323c', '#ff7b82'), 'dock': ('#7a3fb0', '#c79bf2'),
    'battery': ('#33691e', '#9ccc65'), 'charging': ('#d4a40c', '#d9b23c'),
    # Those of cells are the same in the dark, since cells are pictures.
    'swept': ('#2f9e6e', '#2f9e6e'), 'missed': ('#e08a1e', '#e08a1e'), 'wall': ('#6b7783', '#6b7783')}
STATE_COLOURS = ('#9aa5b1', '#cf9fdb', '#2b9c6c', '#e0762b', '#8e5bbf', '#e3c01f', '#3b82c4', '#c9353f')
STYLE = {'svg.fonttype': 'none', 'svg.hashsalt': 'report', 'image.composite_image': False, 'font.size': 8.5,
         'axes.linewidth': 0.6, 'path.simplify': True, 'path.simplify_threshold': 0.25, 'agg.path.chunksize': 10000}
MARGINS = (36.0, 31.0, 8.0, 6.0)  # left, bottom, right, top of the axes [1/72 inch]
WIDTH, HEIGHT = 245.0, 130.0  # of the axes of a curve [1/72 inch]
MAP_WIDTH, MAP_HEIGHT = 265.0, 340.0  # at most, of the axes of the map [1/72 inch]
LARGE = 500_000  # characters of SVG, from which on a picture is smaller
DOTS = 180  # of such a picture, an inch
MARGIN = 0.15  # [m] around the map
MOST_CELLS = 800  # in a row or column that are drawn; finer grids are drawn coarser
FEWEST_DOTS = 400  # in a row or column of a picture of cells, lest a viewer blur them
OCCUPIED_PERCENT = 65  # [%] map_server's threshold: a cell that is as probably occupied is one


class Figures(NamedTuple):
    """The figures as markup; empty where there is nothing to show."""

    path: str
    coverage: str
    battery: str


def figures(record: MissionRecord) -> Figures:
    """Draw a mission."""
    with matplotlib.rc_context(STYLE):
        return Figures(_path_over_map(record), _coverage_over_time(record) if len(record.coverage.times) else '',
                       _battery_over_time(record))


def _path_over_map(record: MissionRecord) -> str:
    """Where the robot was, over the map and the floor that was swept and missed; equal axes, y up."""
    left, bottom, right, top = _view(record)
    scale = min(MAP_WIDTH / (right - left), MAP_HEIGHT / (top - bottom))
    figure, axes = _canvas((right - left) * scale, (top - bottom) * scale)
    axes.set(xlim=(left, right), ylim=(bottom, top), xlabel='x [m]', ylabel='y [m]')
    step = MultipleLocator(_round_step(max(right - left, top - bottom)))
    axes.xaxis.set_major_locator(step)
    axes.yaxis.set_major_locator(step)
    if record.swept is not None:
        _show(axes, record.swept, (('missed', 170, 0), ('swept', 90, 100)))
    if record.floor is not None:
        _show(axes, record.floor, (('wall', 255, OCCUPIED_PERCENT),))
    places = np.insert(record.path.values, leaps(record.path), math.nan, axis=0)  # a line ends where it was put away
    axes.plot(*places.T, color=_colour('path'), linewidth=0.55, gid='path')
    axes.plot(*bump_places(record).values.reshape(-1, 2).T, 'x', color=_colour('bump'), markersize=3.2,
              markeredgewidth=0.7, gid='bumps')
    for x, y in contacts(record):
        axes.plot(x, y, 'D', color=_colour('dock'), markersize=8.0, fillstyle='none', markeredgewidth=1.3)
    for (x, y), marker, size, fill in ((record.path.values[0], '^', 6.5, 'none'),
                                       (record.path.values[-1], 's', 3.2, 'full')):
        axes.plot(x, y, marker, color=_colour('ink'), markersize=size, fillstyle=fill, markeredgewidth=1.0)
    return _markup(figure, 'map', f'Map of {right - left:.1f} m by {top - bottom:.1f} m with the path of '
                                  f'{record.robot}, the swept and the missed floor, start, end, dock and bumps')


def _coverage_over_time(record: MissionRecord) -> str:
    """The share of the floor that was swept, and below it what the mission was at."""
    states = state_spans(record)
    figure, axes = _canvas(WIDTH, HEIGHT)
    unit = _time_axis(axes, record.duration)
    axes.plot(record.coverage.times / unit, 100.0 * record.coverage.values, color=_colour('swept'), linewidth=1.3,
              gid='coverage')
    axes.set(ylim=(-9.0 if states else 0.0, 102.0), ylabel='swept [%]')
    axes.yaxis.set_major_locator(MultipleLocator(20.0))
    axes.broken_barh([(begin / unit, (end - begin) / unit) for begin, end, _ in states], (-8.0, 6.0), linewidth=0.0,
                     facecolors=[state_colour(state.state) for _, _, state in states])
    last = f'{100.0 * record.coverage.values[-1]:.1f} % at the end'
    return _markup(figure, 'coverage', f'Share of the floor that is swept over time, {last}'
                   + ('; below it what the mission was at' if states else ''))


def _battery_over_time(record: MissionRecord) -> str:
    """The charge of the battery, with the times at which it was charged."""
    figure, axes = _canvas(WIDTH, HEIGHT)
    unit = _time_axis(axes, record.duration)
    charging = charging_spans(record)
    for begin, end in charging:
        axes.axvspan(begin / unit, end / unit, color=_colour('charging'), alpha=0.3, linewidth=0.0)
    axes.axhline(LOW, color=_colour('bump'), linewidth=0.8, linestyle='--')
    axes.plot(record.charge.times / unit, record.charge.values, color=_colour('battery'), linewidth=1.3, gid='battery')
    axes.set(ylim=(0.0, 102.0), ylabel='battery [%]')
    axes.yaxis.set_major_locator(MultipleLocator(20.0))
    return _markup(figure, 'battery', f'Charge of the battery over time, from {record.charge.values[0]:.0f} % to '
                                      f'{record.charge.values[-1]:.0f} %; charging {len(charging)} times is shaded')


def state_colour(state: int) -> str:
    """The colour of a state of the mission, on light and on dark."""
    return STATE_COLOURS[state % len(STATES)]


# --- drawing --------------------------------------------------------------------------------------------------------

def _colour(name: str) -> str:
    return COLOURS[name][0]


def _canvas(width: float, height: float) -> Tuple[Any, Any]:
    """A figure, and axes of a size [1/72 inch] in it."""
    left, bottom, right, top = MARGINS
    whole, high = width + left + right, height + bottom + top
    figure = Figure(figsize=(whole / 72.0, high / 72.0))
    figure.patch.set_alpha(0.0)
    axes = figure.add_axes([left / whole, bottom / high, width / whole, height / high])
    axes.patch.set_alpha(0.0)
    axes.grid(color=_colour('rule'), linewidth=0.5)
    axes.set_axisbelow(True)
    axes.tick_params(color=_colour('faint'), labelcolor=_colour('ink'), length=2.5, width=0.6)
    for spine in axes.spines.values():
        spine.set_color(_colour('faint'))
    for label in (axes.xaxis.label, axes.yaxis.label):
        label.set_color(_colour('ink'))
    return figure, axes


def _time_axis(axes: Any, duration: float) -> float:
    """Label the time; returns the seconds of its unit."""
    unit, name = next(((unit, name) for unit, name, most in ((1.0, 's', 180.0), (60.0, 'min', 10800.0))
                       if duration <= most), (3600.0, 'h'))
    axes.set(xlim=(0.0, max(duration, 1.0) / unit), xlabel=f'time [{name}]')
    axes.xaxis.set_major_locator(MaxNLocator(7, steps=[1, 2, 5, 10]))
    return unit


def _view(record: MissionRecord) -> Tuple[float, float, float, float]:
    """Left, bottom, right and top of all that is worth a look [m]."""
    corners = [record.path.values]
    for grid in (record.floor, record.swept):
        if grid is not None and (grid.cells >= 0).any():
            known = np.argwhere(grid.cells >= 0)
            rows_columns = np.array([known.min(axis=0), known.max(axis=0) + 1])
            corners.append(rows_columns[:, ::-1] * grid.resolution + (grid.left, grid.bottom))
    places = np.concatenate(corners)
    (left, bottom), (right, top) = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    lack = 0.5 * np.maximum(0.25 * max(right - left, top - bottom) - (right - left, top - bottom), 0.0)
    return left - lack[0], bottom - lack[1], right + lack[0], top + lack[1]  # nothing is narrower than 1 : 4


def _round_step(length: float) -> float:
    """A round distance [m], some of which make up a length."""
    power = 10.0 ** math.floor(math.log10(length / 4.0))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length / 4.0)


def _show(axes: Any, grid: Grid, layers: Sequence[Tuple[str, int, int]]) -> None:
    """Draw cells: for each layer a colour, its opacity [0..255], and the least value of its cells; later ones win."""
    longest = max(grid.cells.shape)
    block, finer = -(-longest // MOST_CELLS), max(FEWEST_DOTS // longest, 1)
    rows, columns = (-(-size // block) * block for size in grid.cells.shape)
    cells = np.full((rows, columns), -1, np.int8)
    cells[:grid.cells.shape[0], :grid.cells.shape[1]] = grid.cells
    cells = cells.reshape(rows // block, block, columns // block, block).max(axis=(1, 3))
    picture = np.zeros(cells.shape + (4,), np.uint8)
    for name, opacity, least in layers:
        picture[cells >= least] = (*bytes.fromhex(_colour(name)[1:]), opacity)
    picture = picture.repeat(finer, axis=0).repeat(finer, axis=1)
    axes.imshow(picture, origin='lower', interpolation='none', zorder=0.6, aspect='auto', extent=(
        grid.left, grid.left + columns * grid.resolution, grid.bottom, grid.bottom + rows * grid.resolution))


# --- markup ---------------------------------------------------------------------------------------------------------

def _markup(figure: Figure, name: str, told: str) -> str:
    """A figure as inline SVG; as a picture where that would be too large."""
    told = html.escape(told)
    buffer = io.BytesIO()
    figure.savefig(buffer, format='svg')
    svg = buffer.getvalue().decode()
    if len(svg) > LARGE:
        buffer = io.BytesIO()
        figure.savefig(buffer, format='png', dpi=DOTS, facecolor='white')
        data = base64.b64encode(buffer.getvalue()).decode()
        return f'<img class="{name}" alt="{told}" src="data:image/png;base64,{data}">'
    return _inline(svg, name, told)


def _inline(svg: str, name: str, told: str) -> str:
    """An SVG document as a part of a page: no prologue, ids that are the figure's own, colours of the page."""
    svg = re.sub(r'<!--.*?-->|<metadata>.*?</metadata>|<style.*?</style>', '', svg[svg.index('<svg'):], flags=re.DOTALL)
    svg = re.sub(r'(\bid="|url\(#|href="#)', rf'\g<1>{name}-', svg)
    for colour, (light, _) in COLOURS.items():
        svg = svg.replace(light, f'var(--{colour})')
    box = re.search(r'viewBox="[^"]*"', svg)
    shape = box.group() if box else ''
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    return re.sub(r'<svg[^>]*>', f'<svg class="{name}" role="img" aria-label="{told}" {shape} {spaces}>', svg, count=1)
