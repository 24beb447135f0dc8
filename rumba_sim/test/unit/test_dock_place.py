"""Places for docks: against a straight wall, with room before them; and the command that prints one."""

import math

import numpy as np
import pytest
import yaml
from pytest import approx
from rooms import RADIUS, crooked, quiet, room
from sheets import B, G, W, write

from rumba_sim.model import place_dock
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.dock_place import place_dock as place
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN, FloorPlan
from rumba_sim.model.simulation.world import World


def placed(plan, x=0.5, y=0.5):
    """The place for a dock of robots that begin at a point [m]."""
    return place(plan, RADIUS, Pose(x, y, 0.0))


def tilted(angle, resolution=0.02):
    """A room of 4 x 3 m, turned about its middle by an angle [rad]."""
    y, x = np.mgrid[-3.0:3.0:resolution, -3.0:3.0:resolution] + 0.5 * resolution
    u, v = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    return FloorPlan('tilted', np.where((abs(u) < 2.0) & (abs(v) < 1.5), FREE, OCCUPIED), resolution, (-3.0, -3.0))


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
def test_a_dock_stands_at_a_wall_and_faces_it_with_free_floor_before_it(resolution):
    plan = crooked(resolution)
    dock = placed(plan)
    assert plan.clearance_at(dock.x, dock.y) == approx(RADIUS + 0.03, abs=0.011)
    cos, sin = math.cos(dock.theta), math.sin(dock.theta)
    wall = RADIUS + 0.03 + 0.5 * resolution
    assert plan.occupancy[plan.cell(dock.x + wall * cos, dock.y + wall * sin)] == OCCUPIED
    for back in np.arange(0.0, 1.2, 0.02):
        for side in np.arange(-0.49, 0.5, 0.02):
            x, y = dock.x - back * cos - side * sin, dock.y - back * sin + side * cos
            assert plan.occupancy[plan.cell(x, y)] == FREE, (back, side)


@pytest.mark.parametrize('angle', [0.3, 1.0, 2.5])
def test_a_dock_faces_a_slanted_wall(angle):
    for resolution in (0.02, 0.05):
        dock = placed(tilted(angle, resolution), 0.0, 0.0)
        assert math.remainder(dock.theta - angle, 0.5 * math.pi) == approx(0.0, abs=0.05)


def test_a_dock_is_where_robots_come_from_the_start():
    plan = room(8.0, 3.0, boxes=[(3.0, 0.0, 3.1, 3.0)])
    assert placed(plan, 1.0, 1.0).x < 3.0 < placed(plan, 5.0, 1.0).x
    assert placed(plan, 3.05, 1.0) is None


@pytest.mark.parametrize('plan', [
    room(6.0, 0.9), room(1.1, 1.1), room(3.0, 3.0, boxes=[(x, y, x + 0.1, y + 0.1) for x in np.arange(0.1, 3.0, 0.6)
                                                          for y in np.arange(0.1, 3.0, 0.6)])],
    ids=['corridor', 'cell', 'legs'])
def test_there_is_no_place_without_room(plan):
    assert placed(plan, 0.45, 0.45) is None


def test_the_rim_of_what_is_known_and_the_edge_of_the_map_are_no_walls():
    cells = np.full((62, 82), UNKNOWN, np.int8)
    cells[1:-1, 1:-1] = FREE
    assert placed(FloorPlan('seen', cells, 0.05, (0.0, 0.0)), 1.0, 1.0) is None
    assert placed(FloorPlan('all', np.zeros((60, 80), np.int8), 0.05, (0.0, 0.0)), 1.0, 1.0) is None
    cells[:, 0] = OCCUPIED
    assert placed(FloorPlan('seen', cells, 0.05, (0.0, 0.0)), 1.0, 1.0) == approx((0.254, 1.5, math.pi), abs=0.5)


@pytest.fixture
def run(tmp_path, capsys):
    """A function that runs the command on a map of some pixels, and returns exit code, output, errors and the path."""
    def run(pixels, *arguments):
        path = write(tmp_path, pixels, resolution=0.05)
        code = place_dock.main([path, *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err, path
    return run


def test_the_command_prints_a_line_for_the_file_of_the_map(run, tmp_path):
    pixels = np.pad(np.full((60, 80), W, np.uint8), 1, mode='constant', constant_values=B)
    code, output, errors, path = run(pixels)
    assert (code, errors) == (0, '') and output.startswith('dock: [')
    plan = map_file.load(write(tmp_path, pixels, resolution=0.05, dock=yaml.safe_load(output)['dock']))
    world = World(plan, quiet())
    world.spawn('rumba')
    world.step()
    assert world.robots['rumba'].is_docked and plan.clearance_at(*plan.dock[:2]) == approx(0.204, abs=0.011)
    (tmp_path / 'small.yaml').write_text('drive: {radius: 0.1}')
    _, output, _, _ = run(pixels, '--robot', str(tmp_path / 'small.yaml'))
    assert plan.clearance_at(*yaml.safe_load(output)['dock'][:2]) == approx(0.13, abs=0.011)


def test_the_command_says_what_is_wrong_in_one_line(run, tmp_path):
    code, output, errors, path = run(np.pad(np.full((12, 80), W, np.uint8), 1, mode='constant', constant_values=B))
    assert (code, output) == (1, '')
    assert errors == f'place_dock: {path}: no straight wall of 0.6 m with 1.2 m of free floor before it\n'
    code, output, errors, path = run(np.full((12, 80), G, np.uint8))
    assert (code, output, errors) == (2, '', f'place_dock: {path}: no free floor: every cell is wall or unknown\n')
    assert place_dock.main(['nowhere']) == 2
