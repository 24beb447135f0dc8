"""inspect_map: what it says of a drawn map, why parts are closed, and what it draws."""

import numpy as np
import pytest
from PIL import Image
from pytest import approx
from rooms import room
from sheets import B, G, W, write

from rumba_evaluation.inspection import inspect_map
from rumba_evaluation.inspection.barriers import Kind, barrier
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import Parts
from rumba_sim.model.maps.floor_plan import FREE, UNKNOWN, FloorPlan

CELL = 0.05  # [m]


def painted(pixels, left, bottom, right, top, level):
    """Paint a rectangle [m] on a sheet whose row 0 is at the top."""
    rows = len(pixels)
    pixels[rows - round(top / CELL):rows - round(bottom / CELL), round(left / CELL):round(right / CELL)] = level


def flat(gap=0.3):
    """Two rooms with a gap between them, a third one without a door, specks, and a ray out of a window."""
    pixels = np.full((200, 300), G, np.uint8)
    painted(pixels, 0.9, 0.9, 9.1, 6.1, B)
    for left, right in ((1.0, 4.0), (4.1, 7.0), (7.1, 9.0)):
        painted(pixels, left, 1.0, right, 6.0, W)
    painted(pixels, 4.0, 3.0, 4.1, 3.0 + gap, W)
    painted(pixels, 2.0, 2.0, 2.05, 2.05, G)
    painted(pixels, 3.0, 5.0, 3.05, 5.05, G)
    painted(pixels, 9.0, 4.0, 14.9, 4.05, W)
    return pixels


@pytest.fixture
def run(tmp_path, capsys, monkeypatch):
    """A function that inspects a map of some pixels, and returns exit code, lines and errors."""
    monkeypatch.chdir(tmp_path)

    def run(pixels, *arguments, **keys):
        path = write(tmp_path, pixels, **{'resolution': CELL, 'origin': '[0, 0, 0]', **keys})
        code = inspect_map.main([path, *arguments])
        captured = capsys.readouterr()
        return code, captured.out.splitlines(), captured.err
    return run


def test_a_map_in_ten_lines(run, tmp_path):
    code, lines, errors = run(flat())
    assert (code, errors) == (0, '')
    assert lines == [
        f'map       {tmp_path}/flat.yaml: PNG, 300 x 200 pixels of 0.05 m, mode trinary',
        'cells     cut to 183 x 102, x 0.95 to 10.10 m, y 0.95 to 6.05 m: 39.1 m2 free, 2.5 m2 wall; 0.2 m2 more are '
        'free far from there',
        'robot     radius 0.174 m, brush 0.170 m: drives through gaps of 0.355 m',
        'start     (2.50, 3.50) m, the most open place of the largest part; no docks',
        'reached   13.5 m2 by the brush, 35 % of the free floor',
        'closed 1  13.1 m2 around (5.55, 2.45) m: behind a gap of 0.300 m at (4.05, 3.15) m, 55 mm too narrow',
        'closed 2  8.3 m2 around (8.05, 1.95) m: behind a wall, 0.10 m across at (7.05, 3.49) m',
        'specks    2 of unknown cells, 0.01 m2 in all, count as walls',
        'mission   about 5 min with one robot, without a charge',
        'to add    dock: [1.204, 3.425, 3.1416]; fill_unknown: 0.05',
        'picture   inspect_flat.png']


def test_the_picture_shows_what_is_reached_and_what_is_closed_and_the_gap(run, tmp_path):
    run(flat(), '--output', str(tmp_path / 'drawn.png'))
    with Image.open(str(tmp_path / 'drawn.png')) as image:
        pixels = np.asarray(image.convert('RGB')).reshape(-1, 3)
    colours, counts = np.unique(pixels, axis=0, return_counts=True)
    share = {'#' + bytes(colour.tolist()).hex().upper(): count for colour, count in zip(colours, counts)}
    assert share['#F6D9A8'] > 1.2 * share['#BFE3D6'] > 10_000 and share['#D55E00'] > 100


def test_what_the_file_says_is_in_the_lines(run, tmp_path):
    _, lines, _ = run(flat(0.4), '--no-picture', dock='[1.2, 3.5, 3.1416]', fill_unknown='0.05', map_type='x')
    text = '\n'.join(lines)
    assert lines[0].endswith("unknown keys are ignored: 'map_type'")
    assert 'start     (1.20, 3.50) m, the dock; 1 dock\n' in text
    assert 'closed 1  8.3 m2' in text and 'closed 2' not in text
    assert 'specks    filled up to 0.05 m2 each\n' in text and text.endswith('to add    nothing')
    assert not (tmp_path / 'inspect_flat.png').exists()


def test_a_start_outside_the_largest_part_and_a_floor_of_many_charges_are_told(run):
    _, lines, _ = run(flat(), '--no-picture', start='[4.0, 9.0, 0.0]', resolution=0.15, origin='[-20.0, 0, 0]')
    assert any(line.startswith('to add') and 'start: [' in line and 'dock: [' in line for line in lines)
    assert any(line.startswith('mission') and 'charge' in line for line in lines)


def test_a_smaller_robot_reaches_more(run, tmp_path):
    (tmp_path / 'small.yaml').write_text('drive: {radius: 0.105}\nbrush: {width: 0.1}\n')
    _, lines, _ = run(flat(), '--no-picture', '--robot', str(tmp_path / 'small.yaml'))
    assert lines[2] == 'robot     radius 0.105 m, brush 0.100 m: drives through gaps of 0.218 m'
    assert not any('a gap' in line for line in lines)


def why(plan):
    """What keeps robots from the second largest part."""
    terrain = plan.refined()
    parts = Parts(terrain, clearance_needed(0.17425, terrain.resolution))
    return barrier(terrain, parts, 1, 2)


def test_why_a_part_is_closed():
    ends = [(3.0, 0.0, 3.1, 1.0), (3.0, 1.32, 3.1, 3.0)]
    found = why(room(6.0, 3.0, 0.02, ends))
    assert found.kind is Kind.GAP and found.width == approx(0.32)
    assert sorted(found.ends) == [approx((3.05, 1.0), abs=0.06), approx((3.05, 1.32), abs=0.06)]
    corridor = why(room(7.0, 3.0, 0.05, [(3.0, 0.0, 4.0, 1.0), (3.0, 1.3, 4.0, 3.0)]))
    assert corridor.kind is Kind.GAP and corridor.width == approx(0.3) and 3.4 < corridor.ends[0][0] < 3.6
    wall = why(room(6.0, 3.0, 0.05, [(3.0, 0.0, 3.1, 3.0)]))
    assert wall.kind is Kind.WALL and wall.width == approx(0.1) and 1.4 < wall.ends[0][1] < 1.6
    cliff = why(room(6.0, 3.0, 0.05, cliff=(3.0, 0.0, 3.5, 3.0)))
    assert cliff.kind is Kind.CLIFF and cliff.width == approx(0.5)
    cells = np.full((60, 120), FREE, np.int8)
    cells[:, 60:64] = UNKNOWN
    unknown = why(FloorPlan('seen', cells, 0.05, (0.0, 0.0)))
    assert unknown.kind is Kind.UNKNOWN and unknown.width == approx(0.2)


@pytest.mark.parametrize('arguments, message', [
    (['nowhere'], "inspect_map: there is no map 'nowhere'"), (['/nowhere.yaml'], 'inspect_map: /nowhere.yaml: No such'),
    (['studio', '--robot', '/nowhere.yaml'], 'inspect_map: /nowhere.yaml: No such file')])
def test_bad_input_is_one_line(capsys, arguments, message):
    assert inspect_map.main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == '' and captured.err.startswith(message) and captured.err.count('\n') == 1


def test_a_picture_that_cannot_be_written_is_one_line(capsys, tmp_path):
    assert inspect_map.main(['studio', '--output', str(tmp_path / 'no' / 'folder.png')]) == 1
    assert capsys.readouterr().err.startswith('inspect_map: [Errno 2] No such file or directory')
