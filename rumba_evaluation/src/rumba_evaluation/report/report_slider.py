"""The slider of a mission's report: it shows where the robot was, what it had swept and how it fared at any time.

The page works without its script too; the map then shows the whole mission.
"""

from __future__ import annotations

import json
from typing import Any, Dict, List

import numpy as np

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_events import bump_positions
from rumba_evaluation.report.mission_record import MissionRecord, jumps, state_spans
from rumba_evaluation.report.report_figures import HEIGHT, MARGINS, WIDTH, map_scale, on_map
from rumba_sim.model.settings.robot_config import BrushConfig, DriveConfig

STEP = 0.04  # [m] from one point of the path to the next
MOST_POINTS = 8000  # of a path
SAMPLES = 500  # of charge and coverage

SLIDER = '''<div id="slider" hidden><button type="button">Play</button>
<input type="range" min="0" max="1000" value="1000" step="1" aria-label="Time of the mission">
<output></output></div>'''
SCRIPTS = '''<script type="application/json" id="track">%s</script>
<script>%s</script>
'''

SCRIPT = '''
(() => {
  const track = JSON.parse(document.getElementById('track').textContent);
  const map = document.querySelector('svg.map'), box = document.getElementById('slider');
  const whole = map && map.querySelector('#map-path path');
  if (!whole) return;
  const [button, input, output] = box.children, all = whole.getAttribute('d');
  const make = (tag, attributes) => {
    const made = document.createElementNS(map.namespaceURI, tag);
    for (const name in attributes) made.setAttribute(name, attributes[name]);
    return made;
  };
  const brushed = make('path', {fill: 'none', stroke: 'var(--swept)',
    'stroke-width': track.brush, style: 'stroke-linecap:round;stroke-linejoin:round'});
  const layer = make('g', {'clip-path': whole.getAttribute('clip-path') || ''});
  layer.append(brushed);
  whole.parentNode.before(layer);
  const robot = make('g', {visibility: 'hidden'});
  robot.append(make('circle', {r: 1, fill: 'var(--body)', stroke: '#fff', 'stroke-width': 1 / track.radius}),
    make('path', {d: 'M.38-.82A.9.9 0 0 1 .38.82', fill: 'none', stroke: 'var(--robot)', 'stroke-width': 0.16}),
    make('path', {d: 'M.7 0L.2-.4V.4Z', fill: 'var(--robot)'}));
  map.querySelector('g').append(robot);
  const cursors = [...document.querySelectorAll('svg.coverage, svg.battery')].map(svg => {
    const line = make('line', {y1: track.chart[1], y2: track.chart[1] + track.chart[3], stroke: 'var(--ink)'});
    line.setAttribute('visibility', 'hidden');
    svg.append(line);
    return line;
  });
  const swept = [...map.querySelectorAll('image.swept')];
  const bumps = [...map.querySelectorAll('#map-bumps use')];
  const two = number => String(number).padStart(2, '0');
  const clock = s => `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(Math.floor(s % 60))}`;
  const at = (times, time) => {
    let low = 0, high = times.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    return low;
  };
  const show = () => {
    const isEnd = +input.value >= 1000, time = track.duration * input.value / 1000;
    let drawn = '', brush = '', wasClean = false, last = 0;
    if (!isEnd) track.t.every((then, i) => {
      if (then > time) return false;
      const place = `${track.x[i] / 10} ${track.y[i] / 10}`, isClean = !!track.clean[i];
      drawn += (track.breaks.includes(i) || !i ? 'M' : 'L') + place;
      if (isClean) brush += (wasClean && !track.breaks.includes(i) ? 'L' : 'M') + place;
      wasClean = isClean;
      last = i;
      return true;
    });
    whole.setAttribute('d', isEnd ? all : drawn);
    brushed.setAttribute('d', brush);
    swept.forEach(image => { image.style.visibility = isEnd ? '' : 'hidden'; });
    bumps.forEach((bump, i) => { bump.style.visibility = isEnd || track.bumps[i] <= time ? '' : 'hidden'; });
    robot.setAttribute('visibility', isEnd ? 'hidden' : 'visible');
    const from = Math.max(last - 1, 0);
    const heading = Math.atan2(track.y[last] - track.y[from], track.x[last] - track.x[from]);
    robot.setAttribute('transform', `translate(${track.x[last] / 10} ${track.y[last] / 10}) rotate(${
      heading * 180 / Math.PI}) scale(${track.radius})`);
    cursors.forEach(line => {
      const x = track.chart[0] + track.chart[2] * time / Math.max(track.duration, 1);
      line.setAttribute('x1', x); line.setAttribute('x2', x);
      line.setAttribute('visibility', isEnd ? 'hidden' : 'visible');
    });
    const sample = Math.min(Math.round(input.value / 1000 * (track.charge.length - 1)), track.charge.length - 1);
    const state = track.states.length ? track.states[at(track.states.map(one => one[0]), time)][1] : '';
    output.textContent = [clock(time), state, `battery ${track.charge[sample]} %`,
      track.swept.length ? `${track.swept[sample].toFixed(1)} % swept` : ''].filter(Boolean).join(' · ');
    input.setAttribute('aria-valuetext', output.textContent);
  };
  let before = 0;
  const play = now => {
    if (button.textContent !== 'Pause') return;
    input.value = +input.value + Math.max(1, Math.round((now - before) / 30));
    before = now;
    show();
    if (+input.value >= 1000) button.textContent = 'Play'; else requestAnimationFrame(play);
  };
  button.onclick = () => {
    const begins = button.textContent === 'Play';
    if (begins && +input.value >= 1000) input.value = 0;
    button.textContent = begins ? 'Pause' : 'Play';
    before = performance.now();
    if (begins) requestAnimationFrame(play);
  };
  input.oninput = show;
  document.querySelectorAll('tr[data-at]').forEach(row => {  // a press of the time of an event shows it on the map
    const press = document.createElement('button'), cell = row.cells[0];
    Object.assign(press, {type: 'button', className: 'at', textContent: cell.textContent, onclick: () => {
      button.textContent = 'Play';
      input.value = Math.min(Math.round(1000 * row.dataset.at / Math.max(track.duration, 1)), 999);
      show();
      map.scrollIntoView({block: 'nearest'});
    }});
    press.setAttribute('aria-label', `Show ${press.textContent} on the map`);
    cell.replaceChildren(press);
  });
  box.hidden = false;
  show();
})();
'''


def scripts(record: MissionRecord) -> str:
    """The data and the script of the slider, for the end of a page with the figures of a record."""
    data = json.dumps(track(record), separators=(',', ':')).replace('<', '\\u003c')
    return SCRIPTS % (data, SCRIPT)


def track(record: MissionRecord) -> Dict[str, Any]:
    """What the script needs: points of the path on the map [1/720 inch] with times [s], and samples of the rest."""
    kept = _kept(record)
    points, times = np.rint(10.0 * on_map(record, record.path.values[kept])).astype(int), record.path.times[kept]
    moments = np.linspace(0.0, record.duration, SAMPLES + 1)
    scale, states = map_scale(record), state_spans(record)
    left, _, _, top = MARGINS
    return {
        'duration': round(record.duration, 1), 'brush': round(scale * BrushConfig().width, 2),
        'radius': round(scale * DriveConfig().radius, 2), 'chart': [left, top, WIDTH, HEIGHT],
        't': np.round(times, 1).tolist(), 'x': points[:, 0].tolist(), 'y': points[:, 1].tolist(),
        'breaks': np.searchsorted(kept, jumps(record.path)).tolist(),
        'clean': _is_cleaning(record, times),
        'bumps': np.round(bump_positions(record).times, 1).tolist(),
        'charge': np.rint(record.charge.at(moments)).tolist(),
        'swept': np.round(100.0 * record.coverage.at(moments), 1).tolist() if len(record.coverage.times) else [],
        'states': [[round(begin, 1), state.name] for begin, _, state in states]}


def _is_cleaning(record: MissionRecord, times: Any) -> List[int]:
    """1 where the mission cleans, else 0; 1 everywhere if its states were not recorded."""
    spans = [(begin, end) for begin, end, state in state_spans(record) if state.state == State.CLEANING]
    is_cleaning = np.full(len(times), not record.states)
    for begin, end in spans:
        is_cleaning |= (times >= begin) & (times <= end)
    return [int(flag) for flag in is_cleaning]


def _kept(record: MissionRecord) -> Any:
    """Indices of poses that are about STEP apart, or more if they would be too many; with both sides of each jump."""
    path = record.path
    driven = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path.values, axis=0).T))])
    step = max(STEP, float(driven[-1]) / MOST_POINTS)
    fresh = np.concatenate([[True], np.diff(np.floor(driven / step)) > 0.0])
    edges = jumps(path)
    fresh[edges] = fresh[edges - 1] = fresh[-1] = True
    return np.flatnonzero(fresh)
