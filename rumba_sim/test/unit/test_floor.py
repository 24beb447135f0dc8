"""How brushes clean the floor."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import alone, crooked, drive, drove, quiet, room

from rumba_sim.model import kernel
from rumba_sim.model.floor import Floor
from rumba_sim.model.geometry import Pose
from rumba_sim.model.world import World

WIDTH = 0.17
AT_ONCE = {'acceleration': 1000.0}


@pytest.mark.parametrize('resolution', [0.02, 0.05])
@pytest.mark.parametrize('theta', [0.0, math.pi / 2.0, 0.5, -2.2])
@pytest.mark.parametrize('v', [0.05, 0.3, -0.5])
def test_a_straight_lane_covers_its_length_times_the_width_of_the_brush(v, theta, resolution):
    world, robot = alone(Pose(3.0, 3.0, theta), room(6.0, 6.0, resolution), drive=AT_ONCE)
    drove(world, v, 0.0, round(1.5 / abs(v) * 50))
    area = world.floor.cleaned_area
    # A cell that the brush touches counts as a whole: on average half a cell more on each side.
    assert robot.distance == approx(1.5)
    assert 1.5 * WIDTH * 0.98 <= area <= (1.5 + 2.0 * resolution) * (WIDTH + 2.0 * resolution)


def test_swept_cells_are_those_that_the_brush_passed_over():
    world, robot = alone(Pose(3.0, 3.0, 0.5), room(6.0, 6.0, 0.02), drive=AT_ONCE)
    drove(world, 0.3, 0.0, 200)
    rows, columns = np.nonzero(world.floor.cells & kernel.SWEPT)
    x, y = (columns - 0.5) * 0.02 - 3.0, (rows - 0.5) * 0.02 - 3.0
    along, across = x * math.cos(0.5) + y * math.sin(0.5), y * math.cos(0.5) - x * math.sin(0.5)
    assert along.min() > -0.015 and along.max() < 1.215
    assert abs(across).max() < WIDTH / 2.0 + 0.015
    y, x = np.mgrid[:world.plan.rows, :world.plan.columns] * 0.02 - 0.01 - 3.0
    along, across = x * math.cos(0.5) + y * math.sin(0.5), y * math.cos(0.5) - x * math.sin(0.5)
    inner = (along > 0.0) & (along < 1.2) & (abs(across) < WIDTH / 2.0 - 0.005)
    assert inner.sum() > 450 and (world.floor.cells[inner] & kernel.SWEPT > 0).all()


def test_a_turn_in_place_sweeps_a_disc():
    world, _ = alone(Pose(3.0, 3.0, 0.3), room(6.0, 6.0, 0.02), drive=AT_ONCE)
    drove(world, 0.0, 1.5, 250)
    assert world.floor.cleaned_area == approx(math.pi * (WIDTH / 2.0 + 0.01) ** 2, rel=0.1)


def kept(v, passes, resolution=0.02, step_rate=50):
    """Geometric mean of the share of dirt that is left in the middle of a lane after a number of passes."""
    world, _ = alone(Pose(1.0, 3.01, 0.0), room(6.0, 6.0, resolution), step_rate, drive=AT_ONCE)
    rows, columns = ((round(low / resolution), round(high / resolution)) for low, high in ((3.0, 3.05), (2.0, 4.0)))
    lane = slice(*rows), slice(*columns)
    before = world.floor.dirt[lane].astype(float)
    for index in range(passes):
        drove(world, -v if index % 2 else v, 0.0, round(4.0 / v * step_rate))
    return math.exp(np.mean(np.log(world.floor.dirt[lane] / before)))


@pytest.mark.parametrize('v', [0.07, 0.2, 0.37, 0.5])
@pytest.mark.parametrize('step_rate', [20, 50])
def test_each_pass_removes_its_share_of_the_dirt_at_any_speed(v, step_rate):
    assert kept(v, 1, step_rate=step_rate) == approx(0.1, rel=0.04)


@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_a_second_pass_removes_the_same_share_of_the_rest(resolution):
    assert kept(0.3, 2, resolution) == approx(0.01, rel=0.08)


def test_no_cell_of_a_lane_keeps_more_than_the_square_root_of_the_usual_share():
    world, _ = alone(Pose(1.0, 3.01, 0.0), room(6.0, 6.0, 0.02), drive=AT_ONCE)
    before = world.floor.dirt[150:153, 100:200].copy()
    drove(world, 0.5, 0.0, 400)
    assert (world.floor.dirt[150:153, 100:200] / before).max() <= 0.1 ** 0.5 + 0.01


def test_brushes_that_are_up_neither_sweep_nor_clean_nor_count_their_time():
    world, robot = alone(Pose(3.0, 3.0, 0.0), room(6.0, 6.0))
    before = world.floor.dirt.copy()
    robot.brushes_up = True
    drove(world, 0.3, 0.2, 100)
    assert world.floor.cleaned_area == 0.0 and (world.floor.dirt == before).all() and robot.brush_time == 0.0
    assert world.floor.dirt_left == 1.0
    robot.brushes_up = False
    drove(world, 0.3, 0.2, 100)
    assert world.floor.cleaned_area > 0.1 and world.floor.dirt_left < 1.0 and robot.brush_time == approx(2.0)


def test_a_robot_that_stands_still_cleans_nothing():
    world, robot = alone(Pose(3.0, 3.0, 0.0), room(6.0, 6.0))
    world.step(500)
    assert world.floor.cleaned_area == 0.0 and world.floor.dirt_left == 1.0 and robot.brush_time == approx(10.0)


def test_coverage_is_over_the_cells_that_the_brush_can_reach():
    plan = room(4.0, 2.0, boxes=[(2.0, 0.0, 2.1, 1.75)], carpet=(0.5, 0.5, 1.0, 1.0))
    world, _ = alone(Pose(1.0, 1.0, 0.0), plan)
    reachable = plan.reachable(1.0, 1.0, quiet().drive.radius, WIDTH)
    assert not reachable[:, 45:].any()
    assert world.floor.reachable_area == approx(reachable.sum() * 0.05 ** 2)
    drove(world, 0.2, 0.5, 200)
    swept = (world.floor.cells & kernel.SWEPT > 0) & reachable
    assert world.floor.coverage == swept.sum() / reachable.sum() > 0.05
    grid = world.floor.swept()
    assert grid.dtype == np.int8
    assert (grid == np.where(reachable, np.where(swept, 100, 0), -1)).all()


def test_after_a_long_random_run_the_tally_equals_a_recount():
    plan = crooked(cliff=(3.4, 2.4, 4.0, 3.0), carpet=(0.0, 0.0, 1.0, 1.0))
    world = World(plan, quiet(), seed=5)
    for number, start in enumerate((Pose(0.5, 0.5, 0.0), Pose(2.0, 1.3, 1.0), Pose(3.5, 0.4, 2.0))):
        world.spawn(str(number), start)
    reachable = world.floor.cells & kernel.REACHABLE > 0
    before = world.floor.dirt.astype(float)
    assert float(world.floor.tally[0]['dirt']) == approx(before[reachable].sum())
    rng = np.random.default_rng(6)
    for _ in range(600):
        for robot in world.robots.values():
            robot.command(rng.uniform(-0.2, 0.5), rng.uniform(-1.9, 1.9), world.tick)
            robot.brushes_up = bool(rng.random() < 0.1)
        world.step(25)
    floor = world.floor
    assert int(floor.tally[0]['swept']) == np.count_nonzero((floor.cells & kernel.SWEPT > 0) & reachable)
    assert float(floor.tally[0]['dirt']) == approx(floor.dirt[reachable].astype(float).sum(), rel=1e-4)
    assert floor.dirt_left == approx(floor.dirt[reachable].sum() / before[reachable].sum(), rel=1e-4)
    assert 0.2 < floor.coverage < 1.0
    assert (floor.dirt >= 0.0).all() and (floor.dirt <= before).all()
    untouched = floor.cells & kernel.SWEPT == 0
    assert (floor.dirt[untouched] == before[untouched].astype(np.float32)).all()
    assert not (floor.cells[~plan.free] & kernel.SWEPT).any() and not (floor.cells[plan.cliff] & kernel.SWEPT).any()


def test_dirt_is_on_free_cells_only_with_more_in_spots_and_depends_on_the_seed():
    plan = crooked()
    floors = [Floor(plan, quiet(), Pose(0.5, 0.5, 0.0), np.random.default_rng(seed)) for seed in (1, 1, 2)]
    dirt = floors[0].dirt
    assert dirt.dtype == np.float32 and dirt.shape == plan.occupancy.shape
    assert (dirt[~plan.free] == 0.0).all() and (dirt[plan.free] >= np.float32(0.3)).all() and dirt.max() > 1.0
    assert (floors[1].dirt == dirt).all() and (floors[2].dirt != dirt).any()
    assert (floors[0].coverage, floors[0].dirt_left, floors[0].cleaned_area) == (0.0, 1.0, 0.0)


def test_a_lane_that_is_driven_twice_counts_once():
    world, _ = alone(Pose(1.0, 3.0, 0.0), room(6.0, 6.0), drive=AT_ONCE)
    for _ in drive(world, 0.3, 0.0, 200):
        pass
    once = world.floor.cleaned_area
    drove(world, -0.3, 0.0, 199)
    assert world.floor.cleaned_area == once
