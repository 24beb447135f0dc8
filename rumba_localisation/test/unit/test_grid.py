"""The occupancy grid: what beams tell of its cells, how it grows, and the distances to its walls."""

import math

import numpy as np
import pytest

from rumba_localisation import compiled_matching
from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.grids import compiled_grid
from rumba_localisation.mapping.grids.grid import Grid, placed
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN

NONE, NOISE = np.empty((0, 2)), Noise(0.01)


def beams(count, length):
    """Ends of beams of one length, evenly spread all around."""
    angles = np.arange(count) * 2.0 * math.pi / count
    return length * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def wall(grid, distance=1.0, scans=5):
    """Show a grid a wall straight ahead of a laser at the origin, along y, by evenly spread points on it."""
    points = np.stack([np.full(400, distance), np.linspace(-1.0, 1.0, 400)], axis=1)
    for _ in range(scans):
        grid.add(Pose(0.0, 0.0, 0.0), Scan(points, NONE), NOISE)
    grid.measure()


def test_a_beam_frees_the_cells_that_it_passes_and_raises_the_odds_of_the_last():
    odds, hits = np.zeros((3, 8), np.float32), np.zeros((3, 8, 5), np.float32)
    box = compiled_grid.add_beams(odds, hits, 0.5, 1.5, np.array([[5.25, 1.5]]), np.ones(1), True)
    assert odds[1].tolist() == pytest.approx([compiled_grid.MISS] * 5 + [compiled_grid.HIT, 0.0, 0.0])
    assert not odds[[0, 2]].any()
    assert box == (1, 5, 2, 6)
    assert hits[1, 5].tolist() == pytest.approx([5.25, 1.5, -1.0, 0.0, 1.0])


def test_a_slanting_beam_passes_each_cell_that_it_crosses():
    odds, hits = np.zeros((4, 4), np.float32), np.zeros((4, 4, 5), np.float32)
    compiled_grid.add_beams(odds, hits, 0.1, 0.5, np.array([[3.1, 2.5]]), np.ones(1), False)
    passed = {(int(row), int(column)) for row, column in np.argwhere(odds < 0.0)}
    along = np.linspace(0.0, 1.0, 5000)[:-1]
    crossed = {(int(0.5 + 2.0 * share), int(0.1 + 3.0 * share)) for share in along}
    assert passed == crossed - {(2, 3)}


def test_a_beam_without_an_echo_frees_and_occupies_nothing():
    odds, hits = np.zeros((1, 8), np.float32), np.zeros((1, 8, 5), np.float32)
    box = compiled_grid.add_beams(odds, hits, 0.5, 0.5, np.array([[6.5, 0.5]]), np.ones(1), False)
    assert (odds[0, :6] < 0.0).all() and odds[0, 6] == 0.0
    assert box[0] >= box[2]


def test_odds_have_limits_so_that_what_has_changed_is_believed():
    odds, hits = np.zeros((1, 4), np.float32), np.zeros((1, 4, 5), np.float32)
    for _ in range(100):
        compiled_grid.add_beams(odds, hits, 0.5, 0.5, np.array([[2.5, 0.5]]), np.ones(1), True)
    assert odds[0].tolist() == pytest.approx([-compiled_grid.MOST] * 2 + [compiled_grid.MOST, 0.0])
    scans = math.ceil(compiled_grid.MOST / -compiled_grid.MISS)
    for _ in range(scans):
        box = compiled_grid.add_beams(odds, hits, 0.5, 0.5, np.array([[3.5, 0.5]]), np.ones(1), False)
    assert odds[0, 2] <= 0.0
    assert box == (0, 2, 1, 3)


@pytest.mark.parametrize('distance', [1.0, 1.005, 1.013, 1.0199])
def test_distances_to_a_wall_are_finer_than_a_cell(distance):
    grid = Grid()
    wall(grid, distance)
    for ahead in (0.8, 0.9, 0.96):
        column, row = np.rint(grid.cells(np.array([ahead, 0.1]))).astype(int)
        x = grid.origin[0] + column * grid.resolution
        assert grid.field[row, column] == pytest.approx(distance - x, abs=1e-3)
    column, row = np.rint(grid.cells(np.array([1.1, 0.1]))).astype(int)
    assert grid.field[row, column] == pytest.approx(distance - grid.origin[0] - column * grid.resolution, abs=1e-3)


@pytest.mark.parametrize('distance', [1.0, 1.007, 1.013])
@pytest.mark.parametrize('sigma', [0.01, 0.02])
def test_the_noise_of_a_laser_moves_no_wall(distance, sigma):
    grid, generator, along = Grid(), np.random.default_rng(1), np.linspace(-1.0, 1.0, 400)
    for _ in range(30):
        x, y = generator.uniform(-0.5, 0.5, 2).tolist()
        sight = np.stack([np.full(400, distance - x), along - y], axis=1)
        lengths = np.hypot(sight[:, 0], sight[:, 1])
        points = sight * (1.0 + sigma * generator.standard_normal(400) / lengths)[:, None]
        grid.add(Pose(x, y, 0.0), Scan(points, NONE), Noise(sigma))
    grid.measure()
    for ahead in (-0.04, 0.0, 0.02):
        points = np.stack([np.full(50, distance + ahead), np.linspace(-0.5, 0.5, 50)], axis=1)
        away = compiled_matching.distances(np.zeros(3), points, grid.field, *grid.origin, grid.resolution)
        assert away.mean() == pytest.approx(-ahead, abs=0.004)


def test_the_field_is_far_where_no_wall_is_near():
    grid = Grid()
    wall(grid)
    assert grid.distance_at(0.0, 0.0) == pytest.approx(0.5)
    assert grid.distance_at(50.0, 0.0) == math.inf


@pytest.mark.parametrize('start', [Pose(0.0, 0.0, 0.0), Pose(-300.0, 712.3, 1.0)])
def test_a_grid_that_grows_keeps_what_it_knows(start):
    grid = Grid()
    grid.add(start, Scan(beams(360, 1.0), NONE), NOISE)
    here = placed(start, beams(360, 1.0))
    before, size = grid.share_unknown(start, beams(360, 1.0)), grid.odds.size
    for direction in range(4):
        grid.add(Pose(start.x + 5.0 * math.cos(direction * math.pi / 2), start.y + 5.0 * math.sin(
            direction * math.pi / 2), 0.0), Scan(beams(360, 1.0), NONE), NOISE)
    grid.measure()
    assert before == 0.0 and grid.share_unknown(start, beams(360, 1.0)) == 0.0
    assert size < grid.odds.size < 1_000_000
    assert max(grid.distance_at(x, y) for x, y in here.tolist()) < grid.resolution


def test_the_plan_of_a_grid_shows_floor_walls_and_what_is_unknown():
    grid, dock = Grid(), Pose(0.2, 0.0, 0.0)
    wall(grid)
    grid.add(Pose(0.0, 0.0, 0.0), Scan(NONE, beams(360, 0.9)), NOISE)
    plan = believed_plan(grid, 'a wall', dock)
    assert plan.occupancy[plan.cell(0.5, 0.3)] == FREE
    assert plan.occupancy[plan.cell(1.0, 0.3)] == OCCUPIED
    assert plan.occupancy[plan.cell(1.05, 0.3)] == UNKNOWN
    assert plan.dock == dock
    assert plan.bounds.left == pytest.approx(-0.94, abs=0.03)
    assert plan.bounds.right == pytest.approx(1.06, abs=0.03)


@pytest.mark.parametrize('distance', [0.96, 0.98, 1.0, 1.02, 1.04])
def test_coarse_cells_show_a_wall_where_it_is_and_no_thicker_than_fine_ones(distance):
    grid, random = Grid(0.05), np.random.default_rng(1)
    for _ in range(20):
        points = np.stack([distance + 0.02 * random.standard_normal(400), np.linspace(-1.0, 1.0, 400)], axis=1)
        grid.add(Pose(0.0, 0.0, 0.0), Scan(points, NONE), Noise(0.02))
    grid.measure()
    plan = believed_plan(grid, 'a wall', finest=0.025)
    assert plan.resolution == 0.025
    rows, columns = np.nonzero(plan.occupancy == OCCUPIED)
    x, y = (plan.origin[axis] + (cells + 0.5) * plan.resolution for axis, cells in ((0, columns), (1, rows)))
    middle = abs(y) < 0.4
    assert len(set(rows[middle])) == 32  # it has no gap
    assert max(abs(x[middle] - distance)) < 0.03


def test_what_lies_between_two_beams_is_free():
    grid = Grid()
    grid.add(Pose(0.0, 0.0, 0.0), Scan(NONE, beams(90, 2.0)), NOISE)  # 0.13 m apart at 1.9 m
    plan = believed_plan(grid, 'beams')
    angle = math.radians(2.0)
    cell = plan.cell(1.8 * math.cos(angle), 1.8 * math.sin(angle))
    assert grid.share_unknown(Pose(0.0, 0.0, 0.0), np.array([[1.8 * math.cos(angle), 1.8 * math.sin(angle)]])) == 1.0
    assert plan.occupancy[cell] == FREE
