"""The maps of the repository: drawn by their script, of the stated size, and suitable for a Rumba."""

import importlib.util
import pathlib

import numpy as np
import pytest
from PIL import Image
from pytest import approx

from rumba_sim.model.floors.sweep import Sweep
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE
from rumba_sim.model.settings.robot_config import RobotConfig

MAPS = pathlib.Path(__file__).resolve().parents[2] / 'maps'
NAMES = ('apartment', 'studio', 'field')
RADIUS = 0.17425  # [m] of the default robot
ROOMS = {  # a point in each room
    'apartment': {'living room': (3.3, 2.0), 'kitchen': (2.0, 4.6), 'hall': (4.0, 4.8), 'bath': (6.8, 4.6),
                  'bedroom': (6.0, 1.4), 'beside the bed': (7.6, 2.9), 'under a chair': (0.77, 5.38)},
    'studio': {'room': (1.5, 2.5), 'kitchen': (2.5, 3.8), 'bath': (3.8, 3.4), 'under the desk': (4.65, 1.3),
               'corner': (4.7, 0.4)},
    'field': {'middle': (5.5, 5.5), 'lower left': (0.2, 0.2), 'upper right': (10.9, 10.9)},
}


@pytest.fixture(scope='module', params=NAMES)
def plan(request):
    return map_file.load(MAPS / f'{request.param}.yaml')


def short_name(plan):
    return pathlib.Path(plan.name).stem


def test_the_script_draws_the_maps_of_the_folder(tmp_path):
    spec = importlib.util.spec_from_file_location('make_maps', str(MAPS / 'make_maps.py'))
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    for draw in script.MAPS:
        draw(tmp_path)
    here = {path.name for path in MAPS.iterdir() if path.suffix in ('.yaml', '.png')}
    assert here == {path.name for path in tmp_path.iterdir()} and {f'{name}.yaml' for name in NAMES} <= here
    for name in here:
        if name.endswith('.yaml'):
            assert (tmp_path / name).read_bytes() == (MAPS / name).read_bytes(), name
        else:  # zlib's versions pack the same pixels into other bytes
            with Image.open(str(tmp_path / name)) as drawn, Image.open(str(MAPS / name)) as kept:
                assert np.array_equal(np.asarray(drawn), np.asarray(kept)), name


def test_a_robot_fits_at_the_dock_and_the_start_and_the_dock_is_at_a_wall(plan):
    plan.check_pose(plan.dock, RADIUS, 'dock')
    assert 0.02 <= plan.safe_clearance_at(plan.dock.x, plan.dock.y) - RADIUS <= 0.05
    ahead = plan.dock.x + RADIUS + 0.06
    assert plan.dock.theta == 0.0 and plan.occupancy[plan.cell(ahead, plan.dock.y)] != FREE
    if plan.start is not None:
        plan.check_pose(plan.start, RADIUS, 'start')


def test_the_floor_before_the_dock_is_free(plan):
    wall = plan.dock.x + RADIUS + 0.02
    for back in np.arange(0.0, 1.2, 0.01):
        for side in np.arange(-0.5, 0.5, 0.01):
            assert plan.occupancy[plan.cell(wall - back, plan.dock.y + side)] == FREE, (back, side)


def reachable_share(plan):
    """Share of each cell that can be reached from the dock [0..1]: float (rows, columns)."""
    sweep = Sweep(plan, RobotConfig())
    sweep.begin(plan.dock.x, plan.dock.y)
    return sweep.missing_share()


def test_every_room_can_be_cleaned_from_the_dock(plan):
    terrain = plan.refined()
    reached = reachable_share(terrain)
    for room, place in ROOMS[short_name(plan)].items():
        assert reached[terrain.cell(*place)] == 1.0, room
    # The brush cannot reach a strip of 9 cm along every wall and around every leg.
    assert reached.sum() / terrain.free.sum() > {'apartment': 0.72, 'studio': 0.75, 'field': 0.96}[short_name(plan)]


def test_the_free_floor_has_the_stated_area(plan):
    area = plan.free.sum() * plan.resolution ** 2
    assert area == approx({'apartment': 37.1, 'studio': 14.2, 'field': 11.1 ** 2}[short_name(plan)], abs=0.05)


def test_no_map_can_be_mistaken_for_its_mirror_image():
    for name in ('apartment', 'studio'):
        occupancy = map_file.load(MAPS / f'{name}.yaml').occupancy
        for mirrored in (occupancy[::-1], occupancy[:, ::-1], occupancy[::-1, ::-1]):
            assert (occupancy != mirrored).mean() > 0.1


def test_a_robot_passes_under_some_chairs_of_the_apartment_and_not_under_others():
    plan = map_file.load(MAPS / 'apartment.yaml')
    reached = reachable_share(plan)
    assert reached[plan.cell(0.77, 5.38)] == 1.0 and reached[plan.cell(0.8, 4.3)] == 0.0


def test_in_the_apartment_a_robot_reaches_the_carpet_but_not_the_step_down():
    plan = map_file.load(MAPS / 'apartment.yaml')
    reached = reachable_share(plan)
    assert plan.cliff[plan.cell(4.0, 6.0)] and not plan.cliff[plan.cell(4.0, 5.5)] and not reached[plan.cliff].any()
    assert plan.carpet[plan.cell(2.3, 2.5)] and not plan.carpet[plan.cell(3.3, 2.5)]
    assert reached[plan.carpet].mean() > 0.85


def test_the_field_has_the_size_of_turtlesim():
    plan = map_file.load(MAPS / 'field.yaml')
    assert plan.start == approx((5.544445, 5.544445, 0.0), abs=1e-5)
    assert plan.occupancy[1:-1, 1:-1].max() == FREE and (plan.occupancy == FREE).sum() == 222 ** 2
    left, bottom = (edge + plan.resolution for edge in plan.origin)
    assert (left, bottom) == approx((0.0, 0.0))
    assert 11.088889 <= plan.bounds.right - plan.resolution < 11.088889 + plan.resolution
