"""The figures of a mission's report as markup for the page; needs matplotlib."""

from __future__ import annotations

import base64
import html
import io
import math
import re
from typing import Any, Dict, NamedTuple, Tuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, MultipleLocator

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_events import LOW, bump_positions, contacts
from rumba_evaluation.report.mission_record import Grid, MissionRecord, charging_spans, jumps, state_spans
from rumba_evaluation.report.mission_summary import ideal_time
from rumba_sim.model.maps.floor_colours import DARK, LIGHT, STRIPES

# Colours of the page by name, on a light and on a dark screen. matplotlib draws with the light ones; _inline replaces
# them by their names, so that no two may be equal. Cells are pictures, which the page has for both screens.
COLOURS = {
    'ink': ('#1f2933', '#e8ebef'), 'faint': ('#75818e', '#9aa5b1'), 'rule': ('#d9dee4', '#414853'),
    'main': ('#1a5fb8', '#6fb0ff'), 'good': ('#237a48', '#4cc47c'), 'bad': ('#b3261e', '#ff8a80'),
    'charging': ('#d4a40c', '#d9b23c'), 'veil': ('#eceef1', '#1b1e23'),
    'path': (LIGHT.lines[0], DARK.lines[0]), 'mark': ('#1d232b', '#10141a'), 'bump': ('#a8201a', '#a8201b'),
    **{name: (getattr(LIGHT, name), getattr(DARK, name)) for name in (
        'swept', 'to_sweep', 'out_of_reach', 'stripe', 'wall', 'dock')}}
STATE_COLOURS: Dict[int, str] = {
    State.IDLE: '#9aa5b1', State.UNDOCKING: '#cf9fdb', State.CLEANING: '#2b9c6c', State.RETURNING: '#e0762b',
    State.DOCKING: '#8e5bbf', State.CHARGING: '#e3c01f', State.GOING_TO: '#3b82c4', State.STRANDED: '#c9353f',
    State.YIELDING: '#6d4c41'}
UNKNOWN_STATE = '#000000'
SCHEMES = ('light', 'dark')
STYLE = {'svg.fonttype': 'none', 'svg.hashsalt': 'report', 'image.composite_image': False, 'font.size': 8.5,
         'axes.linewidth': 0.6, 'path.simplify': True, 'path.simplify_threshold': 0.25, 'agg.path.chunksize': 10000}
MARGINS = (36.0, 31.0, 8.0, 6.0)  # left, bottom, right, top of the axes [1/72 inch]
WIDTH, HEIGHT = 245.0, 130.0  # of the axes of a curve [1/72 inch]
MAP_WIDTH, MAP_HEIGHT = 560.0, 420.0  # at most, of the axes of the map [1/72 inch]
LARGE = 500_000  # characters of SVG; above that a PNG picture is smaller
DOTS = 180  # per inch of such a picture
MARGIN = 0.15  # [m] around the map
MOST_CELLS = 800  # drawn in a row or column; finer grids are drawn with larger cells
FEWEST_DOTS = 400  # in a row or column of a picture of cells; browsers blur pictures with fewer
HALF = 50  # [%] of a cell that was swept, from which on it is drawn as swept
FAINT = 0.3  # share of the opacity of what the robot's own map does not show
OCCUPIED_PERCENT = 65  # [%] from this probability on a cell is a wall: occupied_thresh 0.65 of map_server's examples


class Figures(NamedTuple):
    """The figures as markup; an empty string if there is nothing to show."""

    path: str
    coverage: str
    battery: str


def figures(record: MissionRecord) -> Figures:
    """Draw a mission."""
    with matplotlib.rc_context(STYLE):
        return Figures(_path_over_map(record), _coverage_over_time(record) if len(record.coverage.times) else '',
                       _battery_over_time(record))


def _path_over_map(record: MissionRecord) -> str:
    """The path over the map, with swept and missed floor; both axes have the same scale, y is up."""
    left, bottom, right, top = _view(record)
    scale = map_scale(record)
    figure, axes = _canvas((right - left) * scale, (top - bottom) * scale)
    axes.set(xlim=(left, right), ylim=(bottom, top), xlabel='x [m]', ylabel='y [m]')
    step = MultipleLocator(_round_step(max(right - left, top - bottom)))
    axes.xaxis.set_major_locator(step)
    axes.yaxis.set_major_locator(step)
    if record.floor is not None:
        _show(axes, record.floor, ('swept' if record.swept is None else 'out_of_reach', 255, 0))
    if record.swept is not None:
        _show(axes, record.swept, ('to_sweep', 255, 0))
        _show(axes, record.swept, ('swept', 255, HALF))
    if record.floor is not None:
        _show(axes, record.floor, ('wall', 255, OCCUPIED_PERCENT))
    if record.known is not None:
        _show(axes, record.known._replace(cells=np.where(record.known.cells < 0, np.int8(0), np.int8(-1))),
              ('veil', round(255 * (1.0 - FAINT)), 0))
        _show(axes, record.known, ('wall', 255, OCCUPIED_PERCENT))
    points = np.insert(record.path.values, jumps(record.path), math.nan, axis=0)  # NaN makes a gap in the line
    axes.plot(*points.T, color=_colour('path'), linewidth=1.1, gid='path')
    axes.plot(*bump_positions(record).values.reshape(-1, 2).T, 'o', color=_colour('bump'), markersize=3.6,
              markeredgewidth=0.5, markeredgecolor='white', gid='bumps')
    for x, y in contacts(record):
        axes.plot(x, y, 'D', color=_colour('dock'), markersize=8.0, fillstyle='none', markeredgewidth=1.3)
    for (x, y), marker, size, fill in ((record.path.values[0], '^', 6.5, 'none'),
                                       (record.path.values[-1], 's', 3.2, 'full')):
        axes.plot(x, y, marker, color=_colour('mark'), markersize=size, fillstyle=fill, markeredgewidth=1.0)
    return _markup(figure, 'map', f'Map of {right - left:.1f} m by {top - bottom:.1f} m with the path of '
                                  f'{record.robot}, the swept and the missed floor, start, end, dock and bumps')


def _coverage_over_time(record: MissionRecord) -> str:
    """The share of the floor that was swept, the target and the ideal, and below it the states of the mission."""
    states = state_spans(record)
    figure, axes = _canvas(WIDTH, HEIGHT)
    unit = _time_axis(axes, record.duration)
    axes.axhline(100.0 * record.target, color=_colour('ink'), linewidth=0.8, linestyle='--', gid='target')
    ideal = ideal_time(record)
    if ideal is not None:
        axes.plot([0.0, ideal / unit], [0.0, 100.0], color=_colour('faint'), linewidth=0.8, linestyle=':', gid='ideal')
    axes.plot(record.coverage.times / unit, 100.0 * record.coverage.values, color=_colour('main'), linewidth=1.3,
              gid='coverage')
    axes.set(ylim=(-9.0 if states else 0.0, 102.0), ylabel='swept [%]')
    axes.yaxis.set_major_locator(MultipleLocator(20.0))
    axes.broken_barh([(begin / unit, (end - begin) / unit) for begin, end, _ in states], (-8.0, 6.0), linewidth=0.0,
                     facecolors=[state_colour(state.state) for _, _, state in states])
    last = f'{100.0 * record.coverage.values[-1]:.1f} % at the end'
    return _markup(figure, 'coverage', f'Share of the floor that is swept over time, {last}'
                   + ('; below it the states of the mission' if states else ''))


def _battery_over_time(record: MissionRecord) -> str:
    """The charge of the battery; times of charging are shaded."""
    figure, axes = _canvas(WIDTH, HEIGHT)
    unit = _time_axis(axes, record.duration)
    charging = charging_spans(record)
    for begin, end in charging:
        axes.axvspan(begin / unit, end / unit, color=_colour('charging'), alpha=0.3, linewidth=0.0)
    axes.axhline(LOW, color=_colour('bad'), linewidth=0.8, linestyle='--')
    axes.plot(record.charge.times / unit, record.charge.values, color=_colour('good'), linewidth=1.3, gid='battery')
    axes.set(ylim=(0.0, 102.0), ylabel='battery [%]')
    axes.yaxis.set_major_locator(MultipleLocator(20.0))
    return _markup(figure, 'battery', f'Charge of the battery over time, from {record.charge.values[0]:.0f} % to '
                                      f'{record.charge.values[-1]:.0f} %; charging {len(charging)} times is shaded')


def state_colour(state: int) -> str:
    """The colour of a mission's state, on both screens."""
    return STATE_COLOURS.get(state, UNKNOWN_STATE)


# --- drawing --------------------------------------------------------------------------------------------------------

def _colour(name: str) -> str:
    return COLOURS[name][0]


def _canvas(width: float, height: float) -> Tuple[Any, Any]:
    """A figure with axes of a size [1/72 inch]."""
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
    """Label the time axis in a unit that fits; returns that unit [s]."""
    unit, name = next(((unit, name) for unit, name, most in ((1.0, 's', 180.0), (60.0, 'min', 10800.0))
                       if duration <= most), (3600.0, 'h'))
    axes.set(xlim=(0.0, max(duration, 1.0) / unit), xlabel=f'time [{name}]')
    axes.xaxis.set_major_locator(MaxNLocator(7, steps=[1, 2, 5, 10]))
    return unit


def _view(record: MissionRecord) -> Tuple[float, float, float, float]:
    """Left, bottom, right and top of what the map shows [m]."""
    corners = [record.path.values]
    for grid in (record.floor, record.swept):
        if grid is not None and (grid.cells >= 0).any():
            known = np.argwhere(grid.cells >= 0)
            rows_columns = np.array([known.min(axis=0), known.max(axis=0) + 1])
            corners.append(rows_columns[:, ::-1] * grid.resolution + (grid.left, grid.bottom))
    points = np.concatenate(corners)
    (left, bottom), (right, top) = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
    lack = 0.5 * np.maximum(0.25 * max(right - left, top - bottom) - (right - left, top - bottom), 0.0)
    return left - lack[0], bottom - lack[1], right + lack[0], top + lack[1]  # nothing is narrower than 1 : 4


def map_scale(record: MissionRecord) -> float:
    """The scale of the map [1/72 inch per m]."""
    left, bottom, right, top = _view(record)
    return min(MAP_WIDTH / (right - left), MAP_HEIGHT / (top - bottom))


def on_map(record: MissionRecord, points: Any) -> Any:
    """Where points (n, 2) [m] are on the map: from its upper left corner, y down (n, 2) [1/72 inch]."""
    left, _, _, top = _view(record)
    return (np.asarray(points) - (left, top)) * map_scale(record) * (1.0, -1.0) + (MARGINS[0], MARGINS[3])


def _round_step(length: float) -> float:
    """The largest round distance [m] (1, 2, 5, 10, ...) that fits at least four times into a length."""
    power = 10.0 ** math.floor(math.log10(length / 4.0))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length / 4.0)


def _show(axes: Any, grid: Grid, layer: Tuple[str, int, int]) -> None:
    """Draw cells for light and for dark screens: a colour, its opacity [0..255] and the least value of its cells."""
    name, opacity, least = layer
    longest = max(grid.cells.shape)
    block, finer = -(-longest // MOST_CELLS), max(FEWEST_DOTS // longest, 1)
    rows, columns = (-(-size // block) * block for size in grid.cells.shape)
    cells = np.full((rows, columns), -1, np.int8)
    cells[:grid.cells.shape[0], :grid.cells.shape[1]] = grid.cells
    is_shown = cells.reshape(rows // block, block, columns // block, block).max(axis=(1, 3)) >= least
    striped = np.add(*np.indices(is_shown.shape)) * block * grid.resolution % STRIPES < 0.5 * STRIPES
    for scheme, label in enumerate(SCHEMES):
        picture = np.zeros(is_shown.shape + (4,), np.uint8)
        picture[is_shown] = (*bytes.fromhex(COLOURS[name][scheme][1:]), opacity)
        if name == 'out_of_reach':
            picture[is_shown & striped] = (*bytes.fromhex(COLOURS['stripe'][scheme][1:]), opacity)
        picture = picture.repeat(finer, axis=0).repeat(finer, axis=1)
        axes.imshow(picture, origin='lower', interpolation='none', zorder=0.6, aspect='auto', label=f'{label} {name}',
                    extent=(grid.left, grid.left + columns * grid.resolution,
                            grid.bottom, grid.bottom + rows * grid.resolution))


# --- markup ---------------------------------------------------------------------------------------------------------

def _markup(figure: Figure, name: str, label: str) -> str:
    """A figure as inline SVG, or as a PNG picture if the SVG would be too large."""
    label = html.escape(label)
    buffer = io.BytesIO()
    figure.savefig(buffer, format='svg')
    svg = buffer.getvalue().decode()
    if len(svg) > LARGE:
        for image in figure.axes[0].images:
            image.set_visible(image.get_label().startswith(SCHEMES[0]))
        buffer = io.BytesIO()
        figure.savefig(buffer, format='png', dpi=DOTS, facecolor='white')
        data = base64.b64encode(buffer.getvalue()).decode()
        return f'<img class="{name}" alt="{label}" src="data:image/png;base64,{data}">'
    labels = iter([image.get_label() for image in figure.axes[0].images])
    svg = re.sub('<image ', lambda _: f'<image class="{next(labels)}" ', svg)
    return _inline(svg, name, label)


def _inline(svg: str, name: str, label: str) -> str:
    """An SVG document as part of a page: without prologue, with unique ids, with the page's names of colours."""
    svg = re.sub(r'<!--.*?-->|<metadata>.*?</metadata>|<style.*?</style>', '', svg[svg.index('<svg'):], flags=re.DOTALL)
    svg = re.sub(r'(\bid="|url\(#|href="#)', rf'\g<1>{name}-', svg)
    for colour, (light, _) in COLOURS.items():
        svg = svg.replace(light, f'var(--{colour})')
    box = re.search(r'viewBox="[^"]*"', svg)
    shape = box.group() if box else ''
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    return re.sub(r'<svg[^>]*>', f'<svg class="{name}" role="img" aria-label="{label}" {shape} {spaces}>', svg, count=1)
