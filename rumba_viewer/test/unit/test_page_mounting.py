"""The page draws what lasers see from where they are mounted, as the window does; needs Node.js."""

import json
import math
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
from pytest import approx

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.ros.readings import Mounting, Scan

PAGE = pathlib.Path(__file__).resolve().parents[2] / 'page'
pytestmark = pytest.mark.skipif(not shutil.which('node'), reason='needs Node.js')
PROGRAM = """
import {readFileSync} from 'fs';
const source = readFileSync(process.argv[1], 'utf-8');
const page = await import(`data:text/javascript,${encodeURIComponent(source)}`);
const {transforms, robot, scan} = JSON.parse(readFileSync(0, 'utf-8'));
const mountings = page.mountingsIn({transforms});
console.log(JSON.stringify([mountings, page.outline(robot, scan, mountings[scan.header.frame_id])]));
"""


def shown(robot, scan, *transforms):
    """The mountings that the page finds in transforms, and the outline (any, 2) that it draws of a scan."""
    done = subprocess.run(['node', '--input-type=module', '-e', PROGRAM, str(PAGE / 'mounting.js')],
                          input=json.dumps({'robot': robot._asdict(), 'scan': scan, 'transforms': transforms}),
                          stdout=subprocess.PIPE, check=True, universal_newlines=True)
    mountings, outline = json.loads(done.stdout)
    return mountings, np.array([(point['x'], point['y']) for point in outline])


def link(child, x, y, turn):
    """A transform as JSON."""
    return {'child_frame_id': child, 'transform': {'translation': {'x': x, 'y': y, 'z': 0.1}, 'rotation': dict(
        zip('xyzw', turn))}}


@pytest.mark.parametrize('upside_down', [False, True])
@pytest.mark.parametrize('increment', [0.1, -0.5 * math.pi])
def test_the_outline_is_that_of_the_window(upside_down, increment):
    robot, mounting = Pose(2.0, 1.0, 0.7), Mounting(Pose(0.1, -0.05, 1.2), upside_down)
    sin, cos = math.sin(0.6), math.cos(0.6)
    turn = (cos, sin, 0.0, 0.0) if upside_down else (0.0, 0.0, sin, cos)
    scan = {'header': {'frame_id': 'rumba2/laser'}, 'angle_min': 0.3, 'angle_increment': increment, 'range_max': 8.0,
            'ranges': [1.0, 2.0, None, 3.0]}
    mountings, outline = shown(robot, scan, link('wheel', 1.0, 1.0, turn), link('rumba2/laser', 0.1, -0.05, turn))
    assert list(mountings) == ['rumba2/laser']
    wanted = Scan(0.0, np.array([1.0, 2.0, 8.0, 3.0]), 0.3 + increment * np.arange(4), increment < 0.0)
    assert outline == approx(wanted.outline(robot, mounting))


def test_a_laser_of_which_nothing_is_told_is_in_the_centre():
    scan = {'header': {'frame_id': 'laser'}, 'angle_min': 0.0, 'angle_increment': 0.1, 'range_max': 8.0,
            'ranges': [1.0]}
    mountings, outline = shown(Pose(2.0, 1.0, 0.5 * math.pi), scan)
    assert mountings == {} and outline == approx(np.array([(2.0, 2.0), (2.0, 1.0)]))
