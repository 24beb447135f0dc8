"""A report of one mission as an HTML page that needs no other file, no script and no network."""

from __future__ import annotations

import datetime
import html
import os
from typing import Dict, Iterable, Sequence, Tuple

from rumba_cleaning.mission.mission import State
from rumba_evaluation.report.mission_events import LOW, Event, bump_positions, contacts, events
from rumba_evaluation.report.mission_record import MissionRecord, Summary, charging_spans, clock, state_spans, summary
from rumba_evaluation.report.report_figures import COLOURS, figures, state_colour

MOST_EVENTS = 200  # rows of the table; further events are counted
CALENDAR = 1e9  # [s] later stamps are dates, earlier ones count from the start of a simulation
NOT_RECORDED = 'not recorded'

STYLE = '''
*{box-sizing:border-box}
body{margin:0 auto;padding:1rem;max-width:66rem;font:1rem/1.5 system-ui,-apple-system,"Segoe UI",sans-serif;
color:var(--ink);background:var(--page)}
h1{font-size:1.5rem;margin:0;overflow-wrap:anywhere}
h2{font-size:1.1rem;margin:0 0 .5rem}
header p,footer,.note{color:var(--soft);margin:.25rem 0 0;overflow-wrap:anywhere}
.tiles{display:grid;grid-template-columns:repeat(2,1fr);gap:.75rem;margin:1rem 0;padding:0}
.tiles div,section{background:var(--card);border:1px solid var(--rule);border-radius:.5rem;padding:.75rem 1rem}
.tiles dt{color:var(--soft);font-size:.85rem}
.tiles dd{margin:0;font-size:1.5rem;line-height:1.3}
.tiles dd small{display:block;color:var(--soft);font-size:.85rem}
.outcome{border-left:.3rem solid;background:var(--card);padding:.5rem 1rem;margin:1rem 0;
overflow-wrap:anywhere}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,26rem),1fr));gap:.75rem;align-items:start;
margin-bottom:.75rem}
.columns>div{display:grid;gap:.75rem}
section{min-width:0}
figure{margin:0}
svg,img{display:block;width:100%;height:auto;max-height:90vh}
svg *{stroke-linejoin:round;stroke-linecap:butt}
svg text{font-family:inherit!important}
img{background:#fff}
.legend{list-style:none;display:flex;flex-wrap:wrap;gap:.1rem 1rem;margin:.5rem 0 0;padding:0;font-size:.85rem}
.legend b{font-weight:400}
.legend i{display:inline-block;width:.8em;height:.8em;border-radius:.15em;margin-right:.35em}
.legend .line{height:.2em;vertical-align:.25em;width:1.2em}
table{border-collapse:collapse;width:100%;font-size:.9rem}
th,td{text-align:left;vertical-align:top;padding:.25rem .5rem .25rem 0;border-bottom:1px solid var(--rule)}
td:first-child,th[scope=row]{white-space:nowrap}
th[scope=row]{font-weight:400;color:var(--soft)}
td{overflow-wrap:anywhere}
.events td:first-child{font-variant-numeric:tabular-nums;color:var(--soft)}
@media (max-width:30rem){body{padding:.5rem}section,.tiles div{padding:.5rem .6rem}}
@media (min-width:44rem),print{.tiles{grid-template-columns:repeat(4,1fr)}}
@media print{body{background:none;padding:0;max-width:none;font-size:10pt}section,.tiles div,tr{break-inside:avoid}
.columns{grid-template-columns:1fr 1fr}.events{break-inside:auto}svg{max-height:16cm}
*{-webkit-print-color-adjust:exact;print-color-adjust:exact}}
'''
PAGE = {'page': ('#f5f7fa', '#14181c'), 'card': ('#ffffff', '#1d2329'), 'soft': ('#5b6773', '#a3afbb')}


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
{_tiles(totals)}
{_outcome(record, totals)}
<div class="columns">
<div>
{_section('Path', drawn.path, _map_legend(record))}
{_details(record)}
</div>
<div>
{_section('Coverage', drawn.coverage, _state_legend(record))}
{_section('Battery', drawn.battery, _battery_legend(record))}
</div>
</div>
{_event_table(events(record))}
</main>
<footer>{_remarks(record)}</footer>
</body>
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


def _tiles(totals: Summary) -> str:
    """The most important figures in large print."""
    area = f'{totals.areas[0]:.1f} of {totals.areas[1]:.1f} m²' if totals.areas else ''
    speed = f'{totals.mean_speed:.2f} m/s while driving' if totals.mean_speed is not None else 'at rest'
    first, last, lowest = totals.charge
    used, charged = totals.energy or (0.0, 0.0)
    tiles = [
        ('Coverage', f'{100.0 * totals.coverage:.1f} %' if totals.coverage is not None else NOT_RECORDED, area),
        ('Duration', clock(totals.duration),
         'simulated time' + (f', {clock(totals.busy)} not idle' if totals.busy is not None else '')),
        ('Distance', f'{totals.distance:.1f} m', speed),
        ('Driving', clock(totals.driving_time), _times(totals.jumps, 'moved without driving ') if totals.jumps else ''),
        ('Charging', clock(totals.charging_time), _times(totals.charges)),
        ('Battery', f'{last:.0f} %', f'from {first:.0f} %, lowest {lowest:.0f} %'),
        ('Energy', *((f'{used:.2f} Wh', f'used; {charged:.2f} Wh charged') if totals.energy else (NOT_RECORDED, ''))),
        ('Bumps', str(totals.bumps) if totals.bumps is not None else NOT_RECORDED, '')]
    return '<dl class="tiles">' + ''.join(
        f'<div><dt>{name}</dt><dd>{value}{more and f"<small>{more}</small>"}</dd></div>' for name, value, more in tiles
    ) + '</dl>'


def _outcome(record: MissionRecord, totals: Summary) -> str:
    is_stranded = bool(record.states) and record.states[-1].state == State.STRANDED
    colour = 'bump' if is_stranded else 'swept' if totals.outcome else 'rule'
    return (f'<p class="outcome" style="border-color:var(--{colour})"><strong>Outcome:</strong> '
            f'{html.escape(totals.outcome or NOT_RECORDED)}</p>')


def _times(count: int, what: str = '') -> str:
    return f'{what}{count} time{"" if count == 1 else "s"}'


def _section(title: str, drawn: str, legend: str) -> str:
    if not drawn:
        return f'<section><h2>{title}</h2><p class="note">{NOT_RECORDED.capitalize()}.</p></section>'
    return f'<section><h2>{title}</h2><figure>{drawn}<figcaption>{legend}</figcaption></figure></section>'


def _legend(entries: Iterable[Tuple[str, str]]) -> str:
    """The legend of a figure: pairs of a mark as HTML and its meaning."""
    items = ''.join(f'<li>{mark} {html.escape(words)}</li>' for mark, words in entries)
    return f'<ul class="legend">{items}</ul>' if items else ''


def _patch(colour: str, kind: str = '', opacity: float = 1.0) -> str:
    return f'<i class="{kind}" style="background:{colour};opacity:{opacity:g}"></i>'


def _sign(sign: str, colour: str) -> str:
    return f'<b style="color:var(--{colour})">{sign}</b>'


def _map_legend(record: MissionRecord) -> str:
    entries = [(_patch('var(--path)', 'line'), 'path'), (_sign('△', 'ink'), 'start'), (_sign('■', 'ink'), 'end')]
    if record.floor is not None:
        entries.append((_patch('var(--wall)'), 'wall'))
    if record.swept is not None:
        entries += [(_patch('var(--swept)', opacity=0.4), 'swept'), (_patch('var(--missed)', opacity=0.7), 'missed')]
    if contacts(record):
        entries.append((_sign('◇', 'dock'), 'dock'))
    if len(bump_positions(record).times):
        entries.append((_sign('✕', 'bump'), 'bump'))
    return _legend(entries)


def _state_legend(record: MissionRecord) -> str:
    """The states that occurred, in the order of their first occurrence, with the time spent in each."""
    spent: Dict[int, float] = {}
    names: Dict[int, str] = {}
    for begin, end, state in state_spans(record):
        spent[state.state] = spent.get(state.state, 0.0) + end - begin
        names[state.state] = state.name
    return _legend((_patch(state_colour(state)), f'{names[state]} {clock(time)}') for state, time in spent.items())


def _battery_legend(record: MissionRecord) -> str:
    entries = [(_patch('var(--battery)', 'line'), 'charge'), (_patch('var(--bump)', 'line'), f'{LOW:.0f} %')]
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
    rows = [f'<tr class="{event.kind}"><td>{clock(event.time)}</td><td>{html.escape(event.text)}</td></tr>'
            for event in found[:MOST_EVENTS]]
    if len(found) > MOST_EVENTS:
        rows.append(f'<tr><td></td><td>... and {len(found) - MOST_EVENTS} more</td></tr>')
    return ('<section class="events"><h2>Events</h2><table><thead><tr><th scope="col">Time</th><th scope="col">What'
            f'</th></tr></thead><tbody>{"".join(rows)}</tbody></table></section>')


def _remarks(record: MissionRecord) -> str:
    return ''.join(f'<p>{html.escape(remark)}</p>' for remark in record.remarks)
