"""Map files: every key of map_server, and one clear line for every error."""

import itertools
import math
import os
import tracemalloc

import numpy as np
import pytest
from PIL import Image
from pytest import approx
from sheets import CUT, PIXELS, G, W, grid, write

from rumba_sim.model.common.errors import LONGEST, MapError
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN


def test_a_map_is_cropped_to_its_free_cells_and_keeps_its_coordinates(tmp_path):
    plan = map_file.load(write(tmp_path))
    assert plan.name == str(tmp_path / 'flat.yaml')
    assert plan.occupancy.tolist() == grid(CUT).tolist()
    assert plan.resolution == 0.5 and plan.origin == approx((-0.5, 2.0))
    assert plan.occupancy[plan.cell(0.25, 2.75)] == FREE and plan.occupancy[plan.cell(1.25, 4.75)] == FREE
    assert (plan.cliff, plan.carpet, plan.dock, plan.start) == (None, None, None, None)


def test_a_map_that_is_free_to_its_edges_is_not_cropped(tmp_path):
    plan = map_file.load(tmp_path / os.path.basename(write(tmp_path, np.full((3, 4), W, np.uint8))))
    assert plan.occupancy.shape == (3, 4) and plan.free.all() and plan.origin == (-1.0, 2.0)


def test_several_docks(tmp_path):
    plan = map_file.load(write(tmp_path, docks='[[1, 2.5, 7.0], [3e-1, 1, 0]]'))
    assert plan.docks == (approx((1.0, 2.5, 7.0 - 2.0 * math.pi)), approx((0.3, 1.0, 0.0)))
    assert plan.dock == plan.docks[0] and plan.refined().docks == plan.docks
    assert map_file.load(write(tmp_path, dock='[1, 2, 0]')).docks == ((1.0, 2.0, 0.0),)
    assert map_file.load(write(tmp_path)).docks == ()


def test_dock_start_and_layers(tmp_path):
    layer = np.full(PIXELS.shape, 255, np.uint8)
    layer[1, 3], layer[4, 2], layer[5, 2] = 0, 127, 128
    Image.fromarray(layer).save(str(tmp_path / 'carpet.png'))
    Image.fromarray(layer[:, ::-1].copy()).save(str(tmp_path / 'cliff.png'))
    plan = map_file.load(write(tmp_path, dock='[1, 2.5, 7.0]', start='[1e-1, -2, -3.14]', carpet='carpet.png',
                               cliff=tmp_path / 'cliff.png'))
    assert plan.dock == approx((1.0, 2.5, 7.0 - 2.0 * math.pi)) and plan.start == approx((0.1, -2.0, -3.14))
    assert np.argwhere(plan.carpet).tolist() == [[2, 1], [5, 2]]
    assert np.argwhere(plan.cliff).tolist() == [[2, 2], [5, 1]]


def by_the_rules(level, negate, mode, occupied, free):
    """The occupancy that map_server gives a level of grey."""
    level = 255 - level if negate else level
    if mode == 'raw':
        probability = level / 100.0 if level <= 100 else math.nan
    else:
        probability = (255 - level) / 255.0
    return OCCUPIED if probability > occupied else FREE if probability < free else UNKNOWN


@pytest.mark.parametrize('mode, negate, thresholds', itertools.product(
    [None, 'trinary', 'scale', 'raw'], [0, 1, 'true', 'false'], [(0.65, 0.196), (0.5, 0.5), (1.0, 1.0)]))
def test_every_level_of_grey_has_the_occupancy_that_map_server_gives_it(tmp_path, mode, negate, thresholds):
    negated = negate in (1, 'true')
    free = 255 if negated == (mode == 'raw') else 0
    levels = np.pad(np.arange(256, dtype=np.uint8).reshape(16, 16), 1, mode='constant', constant_values=free)
    plan = map_file.load(write(tmp_path, levels, mode=mode, negate=negate, occupied_thresh=thresholds[0],
                               free_thresh=thresholds[1]))
    assert plan.occupancy.tolist() == [[by_the_rules(int(level), negated, mode, *thresholds) for level in row]
                                       for row in levels[::-1]]


@pytest.mark.parametrize('turns', [1, 2, 3])
def test_a_quarter_turn_of_the_origin_turns_the_map_and_its_layers(tmp_path, turns):
    Image.fromarray(np.where(PIXELS == W, PIXELS.cumsum(axis=0) % 2 * 255, 255).astype(np.uint8)).save(
        str(tmp_path / 'carpet.png'))
    straight = map_file.load(write(tmp_path, carpet='carpet.png'))
    turned = map_file.load(write(tmp_path, carpet='carpet.png', cliff='carpet.png',
                                 origin=f'[-1.0, 2.0, {turns * math.pi / 2.0!r}]'))
    assert turned.occupancy.tolist() == np.rot90(straight.occupancy, -turns).tolist()  # row 0 is at the bottom
    assert turned.carpet.tolist() == turned.cliff.tolist() == np.rot90(straight.carpet, -turns).tolist()
    x, y = 0.75, 1.25  # a free point, from the origin
    cos, sin = [(0, 1), (-1, 0), (0, -1)][turns - 1]
    assert turned.occupancy[turned.cell(-1.0 + cos * x - sin * y, 2.0 + sin * x + cos * y)] \
        == straight.occupancy[straight.cell(-1.0 + x, 2.0 + y)]
    left, bottom = turned.centre(0, 0)
    assert (left / 0.25 % 2.0, bottom / 0.25 % 2.0) == approx((1.0, 1.0))


@pytest.mark.parametrize('yaw', [0.3, -0.7, 2.0, -3.0])
def test_each_cell_of_a_turned_map_has_the_value_under_its_centre(tmp_path, yaw):
    pixels = np.kron(PIXELS, np.ones((3, 2), np.uint8))
    plan = map_file.load(write(tmp_path, pixels, origin=f'[-1.0, 2.0, {yaw}]'))
    occupancy = grid(pixels)
    seen = set()
    for row, column in np.ndindex(plan.rows, plan.columns):
        x, y = plan.centre(row, column)
        along = (math.cos(yaw) * (x + 1.0) + math.sin(yaw) * (y - 2.0)) / 0.5
        across = (math.cos(yaw) * (y - 2.0) - math.sin(yaw) * (x + 1.0)) / 0.5
        i, j = math.floor(across), math.floor(along)
        on_sheet = 0 <= i < occupancy.shape[0] and 0 <= j < occupancy.shape[1]
        if on_sheet and occupancy[i, j] == FREE or plan.occupancy[row, column] == FREE:
            assert plan.occupancy[row, column] == occupancy[i, j]
            seen.add((i, j))
    assert len(seen) > 0.8 * (occupancy == FREE).sum()


@pytest.mark.parametrize('changes, message', [
    ({'image': None}, 'image is missing'),
    ({'resolution': None}, 'resolution is missing'),
    ({'origin': None}, 'origin is missing'),
    ({'negate': None}, 'negate is missing'),
    ({'occupied_thresh': None}, 'occupied_thresh is missing'),
    ({'free_thresh': None}, 'free_thresh is missing'),
    ({'image': '[1]'}, r'image is \[1\]: must be the path of an image'),
    ({'image': "''"}, "image is '': must be the path of an image"),
    ({'cliff': 3}, 'cliff is 3: must be the path of an image'),
    ({'resolution': 0}, r'resolution is 0: must be 0\.0001 to 10 m'),
    ({'resolution': -0.05}, r'resolution is -0\.05: must be'),
    ({'resolution': '.nan'}, 'resolution is nan: must be'),
    ({'resolution': '.inf'}, 'resolution is inf: must be'),
    ({'resolution': '1' + '0' * 400}, 'resolution is a number of 400 digits: must be'),
    ({'resolution': '0x' + 'f' * 5000}, 'resolution is a number of 6021 digits: must be'),
    ({'resolution': 'x' * 90_000}, "resolution is 'xxx.*xxx': must be"),
    ({'negate': r'"\x1b[2J\n"'}, r"negate is '\\x1b\[2J\\n': must be 0 or 1"),
    ({'resolution': 'fine'}, "resolution is 'fine': must be"),
    ({'resolution': 'true'}, 'resolution is True: must be'),
    ({'resolution': '~'}, 'resolution is None: must be'),
    ({'origin': 5}, r'origin is 5: must be \[x, y, angle\] in m, m, rad'),
    ({'origin': '[0, 0]'}, r'origin is \[0, 0\]: must be'),
    ({'origin': '[0, 0, 0, 0]'}, r'origin is \[0, 0, 0, 0\]: must be'),
    ({'origin': '[0, x, 0]'}, r"origin is \[0, 'x', 0\]: must be"),
    ({'origin': '[0, 1e300, 0]'}, r'origin is .*: must be'),
    ({'dock': '[0, .nan, 0]'}, r'dock is \[0, nan, 0\]: must be'),
    ({'start': '{x: 1}'}, r"start is \{'x': 1\}: must be"),
    ({'negate': 2}, 'negate is 2: must be 0 or 1'),
    ({'negate': '[]'}, r'negate is \[\]: must be 0 or 1'),
    ({'mode': 'binary'}, "mode is 'binary': must be trinary or scale or raw"),
    ({'occupied_thresh': 1.1}, r'occupied_thresh is 1\.1: must be 0 to 1'),
    ({'free_thresh': -0.1}, r'free_thresh is -0\.1: must be 0 to 1'),
    ({'free_thresh': 0.7}, r'free_thresh is 0\.7: must not be above occupied_thresh, 0\.65'),
    ({'docks': '[0, 0, 0]'}, r'docks is \[0, 0, 0\]: must be a list of \[x, y, angle\] in m, m, rad, of 100 at most'),
    ({'docks': '[]'}, r'docks is \[\]: must be a list'), ({'docks': '7'}, 'docks is 7: must be a list'),
    ({'docks': '[[0, 0, 0], [0, 0]]'}, r'docks is .*: must be a list'),
    ({'docks': '[[0, 0, 0]]', 'dock': '[0, 0, 0]'}, 'dock and docks: must be one of them'),
    ({'dok': '[0, 0, 0]'}, "'dok' is unknown: did you mean 'dock'"),
    ({'DOCK': '[0, 0, 0]'}, "'DOCK' is unknown: did you mean 'dock'"),
    ({'Origin': '[0, 0, 0]'}, "'Origin' is unknown: did you mean 'origin'"),
    ({'occupied_threshold': 0.5}, "'occupied_threshold' is unknown: did you mean 'occupied_thresh'"),
    ({'docking': '[0, 0, 0]'}, "'docking' is unknown: did you mean 'dock'"),
    ({'fill_unknown': -1}, 'fill_unknown is -1: must be 0 to 10 m2'),
    ({'cliffs': 'flat.png'}, "'cliffs' is unknown: did you mean 'cliff'"),
])
def test_a_wrong_key_or_value_is_named(tmp_path, changes, message):
    path = write(tmp_path, **changes)
    with pytest.raises(MapError, match=f'^{path}: {message}') as caught:
        map_file.load(path)
    assert len(str(caught.value)) <= LONGEST and str(caught.value).isprintable()


@pytest.mark.parametrize('content, message', [
    (b'', ': image is missing'),
    (b'[1, 2]', ': must hold keys and values'),
    (b'image: [', ', line 1: is not valid YAML: '),
    (b'a: 1\nb: !!python/object:os.system {}', ', line 2: is not valid YAML: could not determine a constructor'),
    (b'a: 2020-13-45', ': is not valid YAML: month must be in 1..12'),
    (b'[' * 5000, ': is not valid YAML: '),
    (b'\x89PNG\r\n\x1a\n\xff\xfe\xfd', ': is not a text file: must be YAML'),
    (b'a: \x00', ': is not valid YAML: '),
    (b'a: &a [1]\nb: *a', ', line 2: is not valid YAML: the alias [*]a is not allowed: write the value'),
    (b'a: &a {b: 1}\n<<: [' + b'*a, ' * 99 + b'*a]', ', line 2: is not valid YAML: the alias [*]a is not allowed'),
    (b'a: 1' + b'9' * 5000, ": ('a' is unknown|is not valid YAML: .*4300)"),
    (b'a: 1' + 3000 * b':1' + b'.5', ': is not valid YAML: int too large to convert to float'),
    (b'a: !!int ""', ': is not valid YAML: string index out of range'),
    (b'a: !!bool x', ": is not valid YAML: 'x'"),
    (b'a: !!timestamp x', ': is not valid YAML: '),
    (b'a: "\x1b[2J"', ': is not valid YAML: unacceptable character #x001b'),
    (b'#' * 100_001, ': is larger than 100 kB: must be a YAML file of keys and values$'),
], ids=lambda value: repr(value[:20]))
def test_a_file_that_is_not_yaml_is_refused(tmp_path, content, message):
    (tmp_path / 'flat.yaml').write_bytes(content)
    with pytest.raises(MapError, match=f'^{tmp_path / "flat.yaml"}{message}') as caught:
        map_file.load(str(tmp_path / 'flat.yaml'))
    assert '\n' not in str(caught.value)


def test_a_path_that_does_not_exist_or_is_a_folder_is_named(tmp_path):
    with pytest.raises(MapError, match='^/nowhere/flat.yaml: No such file or directory$'):
        map_file.load('/nowhere/flat.yaml')
    with pytest.raises(MapError, match=f'^{tmp_path}: is a directory: must be a regular file$'):
        map_file.load(tmp_path)
    path = write(tmp_path)
    for key, value, message in (('image', 'gone.png', f'{tmp_path}/gone.png: No such file or directory'),
                                ('image', '/nowhere/gone.png', '/nowhere/gone.png: No such file or directory'),
                                ('image', f'{tmp_path}/', f'{tmp_path}/: is a directory: must be a regular file'),
                                ('cliff', 'gone.png', f'{tmp_path}/gone.png: No such file or directory')):
        write(tmp_path, **{key: value})
        with pytest.raises(MapError, match=f'^{path}: {key}: {message}$'):
            map_file.load(path)


@pytest.mark.parametrize('value', ['/home/ann/maps/flat.png', '../maps/flat.png', r'C:\maps\flat.png', 'maps/flat.png'])
def test_an_image_that_is_not_where_the_file_says_is_taken_from_beside_the_file(tmp_path, value):
    path = write(tmp_path, image=value, carpet=value)
    plan = map_file.load(path)
    assert plan.occupancy.tolist() == grid(CUT).tolist() and plan.carpet.any()
    assert plan.remarks == tuple(f'{path}: {key} is {value!r}, which is not there: taking {tmp_path}/flat.png'
                                 for key in ('image', 'carpet'))


def test_an_image_that_is_where_the_file_says_is_taken_from_there(tmp_path):
    (tmp_path / 'maps').mkdir()
    Image.fromarray(PIXELS[:, ::-1].copy()).save(str(tmp_path / 'maps' / 'flat.png'))
    plan = map_file.load(write(tmp_path, image='maps/flat.png'))
    assert plan.occupancy.tolist() == grid(CUT[:, ::-1]).tolist() and plan.remarks == ()


def test_keys_of_other_programs_are_ignored_with_a_remark(tmp_path):
    path = write(tmp_path, map_type='occupancy', zones='[a, b]', **{'5': 1, 'x' * 1000: 1, '0x' + 'f' * 900: 1})
    remark, = map_file.load(path).remarks
    assert remark.startswith(f"{path}: unknown keys are ignored: 'map_type', 'zones', 5, 'xxx")
    assert len(remark) <= LONGEST and remark.isprintable()


def test_a_map_without_free_floor_is_refused(tmp_path):
    with pytest.raises(MapError, match=f'^{tmp_path}/flat.yaml: no free floor'):
        map_file.load(write(tmp_path, np.full((40, 30), G, np.uint8)))


def test_a_map_of_thirty_million_free_cells_is_refused_with_advice(tmp_path):
    (tmp_path / 'flat.pgm').write_bytes(b'P5\n6000 5000\n255\n' + b'\xff' * 30_000_000)
    with pytest.raises(MapError, match='flat.yaml: 6000 x 5000 cells are more than 25 million: cut the image'):
        map_file.load(write(tmp_path, image='flat.pgm'))
    (tmp_path / 'flat.pgm').unlink()


@pytest.mark.parametrize('rows, columns, yaw', [
    (3, 60_000, 0.7), (60_000, 3, -2.0), (1, 100_000, 3.0), (3, 60_000, 0.1)])
def test_a_long_narrow_map_that_would_be_huge_when_turned_is_refused_before_it_is_turned(tmp_path, rows, columns, yaw):
    path = write(tmp_path, np.full((rows, columns), W, np.uint8), origin=f'[0, 0, {yaw}]')
    tracemalloc.start()
    try:
        with pytest.raises(MapError, match=f'^{path}, turned by its yaw: [0-9]+ x [0-9]+ cells are more than 25 mill'):
            map_file.load(path)
        assert tracemalloc.get_traced_memory()[1] < 20e6  # bytes
    finally:
        tracemalloc.stop()
