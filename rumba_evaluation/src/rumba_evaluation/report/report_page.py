"""A report of one mission as an HTML page that needs no other file and no network."""

from __future__ import annotations

import datetime
import html
import os
from typing import Dict, Iterable, Optional, Sequence, Tuple

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_events import LOW, Event, bump_positions, contacts, events
from rumba_evaluation.report.mission_record import MissionRecord, charging_spans, clock, state_spans
from rumba_evaluation.report.mission_summary import Summary, summary
from rumba_evaluation.report.report_figures import COLOURS, FAINT, figures, state_colour
from rumba_evaluation.report.report_slider import SLIDER, scripts
from rumba_evaluation.report.report_style import PAGE, STYLE

MOST_EVENTS = 200  # rows of the table; further events are counted
CALENDAR = 1e9  # [s] later stamps are dates, earlier ones count from the start of a simulation
NOT_RECORDED = 'not recorded'


def page(record: MissionRecord) -> str:
    """A whole HTML document about a mission."""
    totals = summary(record)
    drawn = figures(record)
    name = html.escape(os.path.basename(record.source))
    robot = html.escape(record.robot)
    return f'''<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Mission of {robot}: {name}</title>
<style>{_colours()}{STYLE}</style>
</head>
<body>
<header><h1>Mission of {robot}</h1><p>{name}</p></header>
<main>
{_outcome(record, totals)}
{_tiles(record, totals)}
{_team(record)}
{_map(record, drawn.path)}
<div class="columns">
{_section('Coverage', drawn.coverage, _coverage_legend(record))}
{_section('Battery', drawn.battery, _battery_legend(record))}
</div>
{_event_table(events(record))}
{_details(record)}
</main>
<footer>{_remarks(record)}</footer>
{scripts(record) if drawn.path.startswith('<svg') else ''}</body>
</html>
'''


# --- parts of the page ----------------------------------------------------------------------------------------------

def _colours() -> str:
    """The colours by name: the dark ones on a dark screen, the light ones else and on paper."""
    pairs = {**COLOURS, **PAGE}.items()
    light, dark = (':root{' + ''.join(f'--{name}:{pair[index]};' for name, pair in pairs) + '}' for index in (0, 1))
    return f'{light}\n@media screen and (prefers-color-scheme:dark){{{dark}}}'


def _began(record: MissionRecord) -> str:
    if record.began < CALENDAR:
        return f'{record.began:.1f} s after the simulation began'
    return datetime.datetime.fromtimestamp(record.began, datetime.timezone.utc).strftime('%Y-%m-%d %H:%M:%S UTC')


def _tiles(record: MissionRecord, totals: Summary) -> str:
    """The most important figures in large print."""
    area = f'{totals.areas[0]:.1f} of {totals.areas[1]:.1f} m², ' if totals.areas else ''
    speed = f'{totals.mean_speed:.2f} m/s while driving' if totals.mean_speed is not None else 'at rest'
    ideal = f'ideal: {clock(totals.ideal_time)}, ' if totals.ideal_time is not None else ''
    first, last, lowest = totals.charge
    used, charged = totals.energy or (0.0, 0.0)
    tiles = [
        ('Coverage', _percent(totals.coverage), f'{area}target {100.0 * record.target:g} %'),
        ('Mission', clock(totals.busy) if totals.busy is not None else NOT_RECORDED,
         f'{ideal}recorded: {clock(totals.duration)}'),
        ('Dirt left', _percent(record.dirt), ''),
        ('Distance', f'{totals.distance:.1f} m', speed
         + (_times(totals.jumps, ', moved without driving ') if totals.jumps else '')),
        ('Charges', str(totals.charges),
         f'during the mission; on the charger for {clock(totals.charging_time)} in all'),
        ('Battery', f'{last:.0f} %', f'from {first:.0f} %, lowest {lowest:.0f} %'),
        ('Energy', *((f'{used:.2f} Wh', f'used; {charged:.2f} Wh charged') if totals.energy else (NOT_RECORDED, ''))),
        ('Bumps', str(totals.bumps) if totals.bumps is not None else NOT_RECORDED, '')]
    return '<dl class="tiles">' + ''.join(
        f'<div><dt>{name}</dt><dd>{value}{more and f"<small>{more}</small>"}</dd></div>' for name, value, more in tiles
    ) + '</dl>'


def _team(record: MissionRecord) -> str:
    """The figures of each robot, if there are several; they share the floor, so that one coverage is that of all."""
    if not record.mates:
        return ''
    heads = ('Robot', 'Mission', 'Distance', 'Charges', 'Battery', 'Bumps', 'How it ended')
    rows = []
    for one in (record, *record.mates):
        totals = summary(one)
        rows.append((one.robot, clock(totals.busy) if totals.busy is not None else NOT_RECORDED,
                     f'{totals.distance:.1f} m', str(totals.charges),
                     f'{totals.charge[1]:.0f} %, lowest {totals.charge[2]:.0f} %',
                     str(totals.bumps) if totals.bumps is not None else NOT_RECORDED, totals.outcome or NOT_RECORDED))
    return ('<section class="team" tabindex="0" aria-label="Robots"><h2>Robots</h2><table><thead><tr>'
            + ''.join(f'<th scope="col">{head}</th>' for head in heads) + '</tr></thead><tbody>'
            + ''.join('<tr>' + ''.join(f'<td>{html.escape(cell)}</td>' for cell in row) + '</tr>' for row in rows)
            + '</tbody></table></section>')


def _percent(share: Optional[float]) -> str:
    return f'{100.0 * share:.1f} %' if share is not None else NOT_RECORDED


def _outcome(record: MissionRecord, totals: Summary) -> str:
    is_stranded = bool(record.states) and record.states[-1].state == State.STRANDED
    colour = 'bad' if is_stranded else 'good' if totals.outcome else 'rule'
    told = totals.outcome or 'How the mission ended was not recorded.'
    return f'<p class="outcome" style="border-color:var(--{colour})">{html.escape(told)}</p>'


def _times(count: int, what: str = '') -> str:
    return f'{what}{count} time{"" if count == 1 else "s"}'


def _section(title: str, drawn: str, legend: str) -> str:
    if not drawn:
        return f'<section><h2>{title}</h2><p class="note">{NOT_RECORDED.capitalize()}.</p></section>'
    return f'<section><h2>{title}</h2><figure>{drawn}<figcaption>{legend}</figcaption></figure></section>'


def _map(record: MissionRecord, drawn: str) -> str:
    """The map with its legend, a switch for the bumps, and a slider for the time if the map is made of lines."""
    switch = ''
    if drawn.startswith('<svg') and len(bump_positions(record).times):
        switch = '<input type="checkbox" id="bumps" checked><label for="bumps">show bumps</label>'
    moving = SLIDER if drawn.startswith('<svg') else ''
    return (f'<section class="path"><h2>Path</h2>{switch}<figure>{drawn}<figcaption>{_map_legend(record)}</figcaption>'
            f'</figure>{moving}</section>')


def _legend(entries: Iterable[Tuple[str, str]]) -> str:
    """The legend of a figure: pairs of a mark as HTML and its meaning."""
    items = ''.join(f'<li>{mark} {html.escape(words)}</li>' for mark, words in entries)
    return f'<ul class="legend">{items}</ul>' if items else ''


def _patch(colour: str, kind: str = '', opacity: float = 1.0) -> str:
    return f'<i class="{kind}" style="background:{colour};opacity:{opacity:g}"></i>'


def _sign(sign: str, colour: str, kind: str = '') -> str:
    return f'<b class="{kind}" style="color:var(--{colour})">{sign}</b>'


def _map_legend(record: MissionRecord) -> str:
    entries = [(_sign('—', 'path', 'floor'), 'path'), (_sign('△', 'mark', 'floor'), 'start'),
               (_sign('■', 'mark', 'floor'), 'end')]
    if record.swept is not None:
        entries += [(_patch('var(--swept)', 'cell'), 'swept'), (_patch('var(--to_sweep)', 'cell'), 'missed')]
    if record.floor is not None:
        if record.swept is not None:
            entries.append((_patch('repeating-linear-gradient(135deg,var(--out_of_reach) 0 3px,var(--stripe) 3px 6px)',
                                   'cell'), 'out of reach'))
        entries.append((_patch('var(--wall)', 'cell'), 'wall'))
    if record.known is not None:
        entries.append((_patch('var(--wall)', opacity=FAINT), "not on the robot's map"))
    if contacts(record):
        entries.append((_sign('◇', 'dock', 'floor'), 'dock'))
    if len(bump_positions(record).times):
        entries.append((_sign('•', 'bump', 'floor'), 'bump'))
    return _legend(entries)


def _coverage_legend(record: MissionRecord) -> str:
    """Target and ideal, and the states in the order of their first occurrence, with the time spent in each."""
    spent: Dict[int, float] = {}
    names: Dict[int, str] = {}
    for begin, end, state in state_spans(record):
        spent[state.state] = spent.get(state.state, 0.0) + end - begin
        names[state.state] = state.name
    entries = [(_patch('var(--main)', 'line'), 'swept'), (_sign('╌', 'ink'), f'target {100.0 * record.target:g} %')]
    if record.areas is not None:
        entries.append((_sign('┈', 'faint'), 'ideal: without overlap and charging'))
    return _legend(entries + [(_patch(state_colour(state)), f'{names[state]} {clock(time)}')
                              for state, time in spent.items()])


def _battery_legend(record: MissionRecord) -> str:
    entries = [(_patch('var(--good)', 'line'), 'charge'), (_patch('var(--bad)', 'line'), f'{LOW:.0f} %')]
    if charging_spans(record):
        entries.append((_patch('var(--charging)', opacity=0.4), 'charging'))
    return _legend(entries)


def _details(record: MissionRecord) -> str:
    floor = record.floor
    size = NOT_RECORDED
    if floor is not None:
        rows, columns = floor.cells.shape
        size = (f'{columns * floor.resolution:.1f} m × {rows * floor.resolution:.1f} m, '
                f'cells of {100.0 * floor.resolution:g} cm')
    strategies = dict.fromkeys(state.strategy for state in record.states if state.strategy)
    rows_of_table = [('Robot', record.robot), ('Map', size), ('Strategy', ', '.join(strategies) or NOT_RECORDED),
                     ('Began', _began(record))]
    return '<section><h2>Details</h2><table>' + ''.join(
        f'<tr><th scope="row">{name}</th><td>{html.escape(value)}</td></tr>' for name, value in rows_of_table
    ) + '</table></section>'


def _event_table(found: Sequence[Event]) -> str:
    rows = [f'<tr class="{event.kind}" data-at="{event.time:.1f}"><td>{clock(event.time)}</td>'
            f'<td>{html.escape(event.text)}</td></tr>'
            for event in found[:MOST_EVENTS]]
    if len(found) > MOST_EVENTS:
        rows.append(f'<tr><td></td><td>... and {len(found) - MOST_EVENTS} more</td></tr>')
    return ('<section class="events"><h2>Events</h2><table><thead><tr><th scope="col">Time</th><th scope="col">What'
            f'</th></tr></thead><tbody>{"".join(rows)}</tbody></table></section>')


def _remarks(record: MissionRecord) -> str:
    return ''.join(f'<p>{html.escape(remark)}</p>' for remark in record.remarks)
