"""The page estimates the time left as the window does; needs Node.js."""

import json
import math
import pathlib
import shutil
import subprocess

import pytest
from pytest import approx

from rumba_viewer.scene import wording
from rumba_viewer.scene.forecast import Forecast
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

PAGE = pathlib.Path(__file__).resolve().parents[2] / 'page'
pytestmark = pytest.mark.skipif(not shutil.which('node'), reason='needs Node.js')
REACHABLE = 20.0  # [m^2]
STATES = {'idle': 0, 'undocking': 1, 'cleaning': 2, 'returning': 3, 'docking': 4, 'charging': 5, 'stranded': 7}
PROGRAM = """
import {readFileSync} from 'fs';
const source = readFileSync(process.argv[1], 'utf-8');
const {Forecast, about} = await import(`data:text/javascript,${encodeURIComponent(source)}`);
const forecast = new Forecast(), told = [];
for (const [cleaning, share, mission] of JSON.parse(readFileSync(0, 'utf-8'))) {
  forecast.add(cleaning, share ?? NaN, mission);
  told.push([forecast.elapsed, forecast.left, forecast.left === null ? '' : about(forecast.left)]);
}
console.log(JSON.stringify(told));
"""
# Time [s], swept [m^2], charge and state at some moments: a mission that charges, ends, and begins again.
MOMENTS = [(0.0, 0.0, 1.0, 'idle'), (1.0, 0.0, 1.0, 'undocking'), (10.0, 1.0, 0.98, 'cleaning'),
           (60.0, 6.0, 0.7, 'cleaning'), (120.0, 10.0, 0.3, 'cleaning'), (130.0, 10.0, 0.25, 'returning'),
           (140.0, 10.0, 0.24, 'docking'), (150.0, 10.0, 0.25, 'charging'), (180.0, 10.0, 0.6, 'charging'),
           (200.0, 10.0, 0.9, 'charging'), (300.0, 17.0, 0.5, 'cleaning'), (350.0, 19.5, 0.4, 'cleaning'),
           (355.0, 19.7, 0.4, 'idle'), (360.0, 0.0, 1.0, 'cleaning'), (400.0, 3.0, math.nan, 'cleaning'),
           (410.0, 3.0, 0.8, 'stranded')]


def on_the_page(strategy):
    """What the page says after each of the moments: time [s], time left [s], and that in words."""
    given = [({'time': time, 'distance': time, 'cleaned_area': area, 'reachable_area': REACHABLE},
              None if math.isnan(share) else share, {'state': STATES[state], 'strategy': strategy})
             for time, area, share, state in MOMENTS]
    done = subprocess.run(['node', '--input-type=module', '-e', PROGRAM, str(PAGE / 'forecast.js')],
                          input=json.dumps(given), stdout=subprocess.PIPE, check=True, universal_newlines=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize('strategy', ['boustrophedon', 'wander'])
def test_the_estimate_is_that_of_the_window(strategy):
    forecast = Forecast()
    for (time, area, share, state), (elapsed, left, words) in zip(MOMENTS, on_the_page(strategy)):
        forecast.add(Cleaning(area / REACHABLE, area, REACHABLE, 0.5, time, time), Battery(share, 15.0, -1.0, ''),
                     Mission(state, state not in ('idle', 'stranded'), strategy, ''))
        assert (elapsed, left) == (approx(forecast.elapsed), forecast.left if left is None else approx(forecast.left))
        assert words == ('' if forecast.left is None else wording.about(forecast.left))
    assert strategy == 'wander' or any(left for _, left, _ in on_the_page(strategy))
