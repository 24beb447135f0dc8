"""The layers of a map in few numbers, and the same layers again on the page; needs Node.js for the latter."""

import json
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.page.messages.layers import described, runs

PAGE = pathlib.Path(__file__).resolve().parents[2] / 'page'
PROGRAM = """
import {readFileSync} from 'fs';
const source = readFileSync(process.argv[1], 'utf-8');
const {cells} = await import(`data:text/javascript,${encodeURIComponent(source)}`);
console.log(JSON.stringify(JSON.parse(readFileSync(0, 'utf-8')).map(runs => cells(runs, 6) && [...cells(runs, 6)])));
"""
LAYERS = [[[0, 0, 1], [1, 0, 1]], [[1, 1, 0], [0, 0, 0]], [[0, 0, 0], [0, 0, 0]], [[1, 1, 1], [1, 1, 1]]]


@pytest.mark.parametrize('layer, wanted', zip(LAYERS, [[2, 2, 1, 1], [0, 2, 4], [6], [0, 6]]), ids=str)
def test_a_layer_is_told_by_its_runs(layer, wanted):
    assert runs(np.array(layer, bool)) == wanted


def test_a_map_is_described_with_its_docks_and_without_layers_that_it_lacks():
    told = described(3, 2, {'carpet': np.array(LAYERS[0], bool), 'cliff': None}, [Pose(1.0, 2.0, 0.5)])
    assert json.loads(json.dumps(told)) == {'width': 3, 'height': 2, 'carpet': [2, 2, 1, 1], 'cliff': [], 'docks': [
        {'x': 1.0, 'y': 2.0, 'theta': 0.5}]}


@pytest.mark.skipif(not shutil.which('node'), reason='needs Node.js')
def test_the_page_makes_the_same_layers_of_the_runs():
    given = [*(runs(np.array(layer, bool)) for layer in LAYERS), []]
    done = subprocess.run(['node', '--input-type=module', '-e', PROGRAM, str(PAGE / 'layers.js')],
                          input=json.dumps(given), stdout=subprocess.PIPE, check=True, universal_newlines=True)
    assert json.loads(done.stdout) == [*(np.ravel(layer).tolist() for layer in LAYERS), None]
