"""The page lays a robot's own map over the true one as the window does; needs Node.js."""

import json
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
from pytest import approx

from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.maps.laid_over import laid_over
from rumba_viewer.scene.map_frame import on_map
from rumba_viewer.scene.snapshot import Grid, Point

PAGE = pathlib.Path(__file__).resolve().parents[2] / 'page'
pytestmark = pytest.mark.skipif(not shutil.which('node'), reason='needs Node.js')
PROGRAM = """
import {readFileSync} from 'fs';
const source = readFileSync(process.argv[1], 'utf-8');
const page = await import(`data:text/javascript,${encodeURIComponent(source)}`);
const [name, ...values] = JSON.parse(readFileSync(0, 'utf-8'));
const found = page[name](...values);
console.log(JSON.stringify(found instanceof Int8Array ? [...found] : found));
"""
FRAME = Pose(2.0, 1.0, 0.7)


def run(name, *values):
    """What a function of the page's script returns."""
    done = subprocess.run(['node', '--input-type=module', '-e', PROGRAM, str(PAGE / 'own_map.js')],
                          input=json.dumps([name, *values]), stdout=subprocess.PIPE, check=True,
                          universal_newlines=True)
    return json.loads(done.stdout)


def message(grid):
    """A grid as the page gets it."""
    rows, columns = grid.cells.shape
    return {'info': {'width': columns, 'height': rows, 'resolution': grid.resolution,
                     'origin': {'position': {'x': grid.left, 'y': grid.bottom}}}, 'data': grid.cells.ravel().tolist()}


@pytest.mark.parametrize('side', [0.03, 0.05, 0.12])
def test_it_is_laid_over_as_in_the_window(side):
    own = Grid(np.random.default_rng(3).choice([-1, 0, 100], (30, 40)).astype(np.int8), 0.05, -0.4, -0.9, 1)
    true = Grid(np.zeros((50, 45), np.int8), side, 0.3, 0.2, 2)
    wanted = laid_over(own, FRAME, true)
    assert {-1, 0, 100} == set(wanted.ravel().tolist())
    shown = run('laidOver', message(own), FRAME._asdict(), message(true))
    assert np.mean(np.reshape(shown, wanted.shape) != wanted) < 0.001  # where a centre is between two cells


@pytest.mark.parametrize('own, frame', [(None, FRAME), (Grid(np.zeros((2, 2), np.int8), 1.0, 0.0, 0.0, 1), None)])
def test_nothing_is_known_before_there_are_a_map_and_its_frame(own, frame):
    floor = message(Grid(np.zeros((2, 3), np.int8), 1.0, 0.0, 0.0, 2))
    assert run('laidOver', own and message(own), frame and frame._asdict(), floor) == [-1] * 6


def test_points_go_to_the_floor_and_back_as_in_the_window():
    there = run('onFloor', FRAME._asdict(), {'x': 3.0, 'y': -1.0})
    assert (there['x'], there['y']) == approx(compose(FRAME, Pose(3.0, -1.0, 0.0))[:2])
    back = run('onMap', FRAME._asdict(), there)
    assert (back['x'], back['y']) == approx((3.0, -1.0)) and on_map(Point(**there), FRAME) == approx((3.0, -1.0))


@pytest.mark.parametrize('parent, x, is_told', [('world', 2.0, True), ('earth', 2.0, False), ('world', None, False)])
def test_the_frame_is_found_among_other_transforms(parent, x, is_told):
    def link(above, below, x):
        return {'header': {'frame_id': above}, 'child_frame_id': below, 'transform': {
            'translation': {'x': x, 'y': 1.0}, 'rotation': {'x': 0.0, 'y': 0.0, 'z': np.sin(0.35), 'w': np.cos(0.35)}}}
    found = run('frameIn', {'transforms': [link('base_link', 'laser', 5.0), link(parent, 'map', x)]})
    assert found == (approx(FRAME._asdict()) if is_told else None)
