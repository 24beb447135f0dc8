"""How brushes clean the floor."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import alone, crooked, drive, drove, quiet, room

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.floor import Floor
from rumba_sim.model.kernel.sweeping.brush import STRIDE
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE
from rumba_sim.model.simulation.world import World

WIDTH = 0.17
AT_ONCE = {'acceleration': 1000.0}


RESOLUTIONS = (0.005, 0.01, 0.02, 0.05, 0.1)
HEADINGS = tuple(math.radians(degrees) for degrees in (0.0, 7.0, 30.0, 45.0))


def swept_area(*start, v, w, seconds, resolution, step_rate=50):
    """Area [m^2] that a robot sweeps in a room of 4 m whose walls it does not touch."""
    world, robot = alone(Pose(*start), room(4.0, 4.0, resolution), step_rate, drive=AT_ONCE)
    drove(world, v, w, round(seconds * step_rate))
    robot.brushes_up = True
    world.step()  # what was not swept yet of the last stride
    assert robot.bumps == 0
    return world.floor.cleaned_area


@pytest.mark.parametrize('resolution', RESOLUTIONS)
@pytest.mark.parametrize('theta', HEADINGS)
def test_a_lane_is_as_wide_as_the_brush_at_any_heading_and_resolution(theta, resolution):
    x, y = 2.013 - math.cos(theta), 1.987 - math.sin(theta)
    area = swept_area(x, y, theta, v=0.25, w=0.0, seconds=8.0, resolution=resolution)
    assert area == approx(2.0 * WIDTH, rel=0.01)


@pytest.mark.parametrize('resolution', RESOLUTIONS)
@pytest.mark.parametrize('theta', HEADINGS)
def test_an_arc_is_a_part_of_a_ring(theta, resolution):
    radius = 0.5  # of the path; half a circle of it
    x, y = 2.0 + radius * math.sin(theta), 2.0 - radius * math.cos(theta)
    area = swept_area(x, y, theta, v=0.25, w=0.25 / radius, seconds=math.pi * radius / 0.25, resolution=resolution)
    assert area == approx(math.pi * radius * WIDTH, rel=0.012)


@pytest.mark.parametrize('resolution', RESOLUTIONS)
def test_turns_on_the_spot_sweep_discs(resolution):
    rng = np.random.default_rng(1)
    areas = [swept_area(*rng.uniform(1.9, 2.1, 2), 0.3, v=0.0, w=1.5, seconds=2.5, resolution=resolution)
             for _ in range(20)]
    assert np.mean(areas) == approx(math.pi * WIDTH ** 2 / 4.0, rel=0.01)
    assert np.std(areas) < 0.03 * np.mean(areas)  # a disc holds only some 200 samples


@pytest.mark.parametrize('speed, step_rate', [(0.1, 50), (0.5, 50), (0.3, 10), (0.3, 100)])
def test_the_area_depends_neither_on_the_speed_nor_on_the_step_rate(speed, step_rate):
    area = swept_area(1.0, 1.5, 0.4, v=speed, w=0.0, seconds=2.0 / speed, resolution=0.02, step_rate=step_rate)
    assert area == approx(2.0 * WIDTH, rel=0.01)


def test_lanes_side_by_side_leave_what_lies_between_them():
    world, robot = alone(Pose(1.0, 1.0, 0.0), room(4.0, 4.0), drive=AT_ONCE)
    for lane in range(6):
        robot.brushes_up = True
        world.step()
        world.teleport('rumba', Pose(1.0, 1.0 + 0.25 * lane, 0.0))
        robot.brushes_up = False
        drove(world, 0.25, 0.0, 400)
    robot.brushes_up = True
    world.step()
    assert world.floor.cleaned_area / (6 * 0.25 * 2.0) == approx(WIDTH / 0.25, rel=0.01)


def test_a_robot_that_drives_forth_and_back_sweeps_the_ends_too():
    world, robot = alone(Pose(2.0, 2.0, 0.0), room(4.0, 4.0), drive=AT_ONCE)
    for index in range(40):
        drove(world, -0.25 if index % 2 else 0.25, 0.0, 4)
    robot.brushes_up = True
    world.step()
    assert world.floor.cleaned_area == approx(4 * 0.005 * WIDTH, rel=0.15)


def crossed(samples, start, length):
    """Which squares of samples a lane from a pose covers, by the centres of the squares, except near its rim."""
    rows, columns = np.nonzero(samples)
    x, y = (columns + 0.5) * 0.01 - 0.02 - start.x, (rows + 0.5) * 0.01 - 0.02 - start.y
    cos, sin = math.cos(start.theta), math.sin(start.theta)
    along, across = x * cos + y * sin, y * cos - x * sin
    rim = 0.008  # [m] a sample may lie anywhere in its square
    assert along.min() > -rim and along.max() < length + rim and abs(across).max() < 0.5 * WIDTH + rim
    return len(rows)


def test_swept_samples_are_those_that_the_brush_passed_over():
    start = Pose(1.0, 1.0, 0.5)
    world, robot = alone(start, room(4.0, 4.0, 0.02), drive=AT_ONCE)
    drove(world, 0.3, 0.0, 200)
    robot.brushes_up = True
    world.step()
    assert crossed(world.floor.sweep.samples >= PASS, start, 1.2) == approx(1.2 * WIDTH / 0.01 ** 2, rel=0.015)


@pytest.mark.parametrize('heading', [0.0, 0.25 * math.pi, 1.0])
@pytest.mark.parametrize('v', [0.07, 0.5])
@pytest.mark.parametrize('passes', [1, 2, 3])
def test_each_pass_takes_the_same_share_of_the_dirt_at_any_speed_and_heading(passes, v, heading):
    world, robot = alone(Pose(2.0, 2.0, heading), room(4.0, 4.0), drive=AT_ONCE)
    world.floor.dirt[:] = 1.0
    samples = np.count_nonzero(world.floor.sweep.samples & REACHABLE)
    world.floor.sweep.tally[0]['dirt'] = samples
    for index in range(passes):
        drove(world, -v if index % 2 else v, 0.0, round(50.0 / v))
    robot.brushes_up = True
    world.step()
    taken = samples - float(world.floor.sweep.tally[0]['dirt'])
    assert taken == approx(np.count_nonzero(world.floor.sweep.samples >= PASS) * (1.0 - 0.1 ** passes), rel=0.02)


def test_brushes_that_are_up_neither_sweep_nor_clean_nor_count_their_time():
    world, robot = alone(Pose(3.0, 3.0, 0.0), room(6.0, 6.0))
    robot.brushes_up = True
    drove(world, 0.3, 0.2, 100)
    assert world.floor.cleaned_area == 0.0 and robot.brush_time == 0.0
    assert world.floor.dirt_left == 1.0
    robot.brushes_up = False
    drove(world, 0.3, 0.2, 100)
    assert world.floor.cleaned_area > 0.09 and world.floor.dirt_left < 1.0 and robot.brush_time == approx(2.0)


def test_a_robot_that_stands_still_cleans_nothing():
    world, robot = alone(Pose(3.0, 3.0, 0.0), room(6.0, 6.0))
    world.step(500)
    assert world.floor.cleaned_area == 0.0 and world.floor.dirt_left == 1.0 and robot.brush_time == approx(10.0)


def test_the_grid_shows_how_much_of_each_cell_of_the_map_is_swept():
    plan = room(4.0, 2.0, boxes=[(2.0, 0.0, 2.1, 1.75)], carpet=(0.5, 0.5, 1.0, 1.0))
    world, _ = alone(Pose(1.0, 1.0, 0.0), plan)
    drove(world, 0.2, 0.5, 200)
    grid = world.swept()
    assert grid.dtype == np.int8 and grid.shape == plan.occupancy.shape
    assert not (grid[:, 45:] >= 0).any() and (grid[~plan.free] == -1).all()
    assert (grid[20, 15:20] == 0).any() and (grid == 100).any() and ((grid > 0) & (grid < 100)).any()
    share = np.clip(grid, 0, None).sum() / 100.0 / np.count_nonzero(grid >= 0)
    assert share == approx(world.floor.coverage, rel=0.12) and world.floor.coverage > 0.03


def test_after_a_long_random_run_the_tally_equals_a_recount():
    plan = crooked(cliff=(3.4, 2.4, 4.0, 3.0), carpet=(0.0, 0.0, 1.0, 1.0))
    world = World(plan, quiet(), seed=5)
    for number, start in enumerate((Pose(0.5, 0.5, 0.0), Pose(2.0, 1.3, 1.0), Pose(3.5, 0.4, 2.0))):
        world.spawn(str(number), start)
    floor = world.floor
    samples, squares = floor.sweep.samples, world.terrain.sample_squares
    dirt = floor.dirt.astype(float).repeat(squares, 0).repeat(squares, 1)
    reachable = samples & REACHABLE > 0
    before = dirt[reachable].sum()
    assert float(floor.sweep.tally[0]['dirt']) == approx(before)
    rng = np.random.default_rng(6)
    for _ in range(600):
        for robot in world.robots.values():
            robot.command(rng.uniform(-0.2, 0.5), rng.uniform(-1.9, 1.9), world.tick)
            robot.brushes_up = bool(rng.random() < 0.1)
        world.step(25)
    passes = samples // PASS
    assert int(floor.sweep.tally[0]['swept']) == np.count_nonzero(passes[reachable])
    left = (dirt * 0.1 ** passes.astype(float))[reachable].sum()
    assert floor.dirt_left == approx(left / before, rel=1e-6)
    assert 0.2 < floor.coverage < 1.0 and passes.max() > 3
    floorless = (~world.terrain.free | world.terrain.cliff).repeat(squares, 0).repeat(squares, 1)
    assert not passes[floorless].any() and not reachable[floorless].any()


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
    assert once <= world.floor.cleaned_area <= once + STRIDE * WIDTH  # the end of the last stride
