"""Passages between corners that are aslant: a robot passes if it has 3 mm to spare on each side, at any resolution."""

import math
import re

import numpy as np
import pytest
from pytest import approx
from rooms import RADIUS, quiet

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import SLACK, Parts, reach
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.remarks import remarks
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

LEFT, BOTTOM = 1.0, 2.0  # [m] the corner of the lower block


def corners(across, up, resolution=0.05, turns=0, **kwargs):
    """A floor of 3 x 4 m in two parts, with a passage between the corners of two blocks, so many cells apart.

    One block fills the lower left, the other the upper right; quarter turns turn all of it.
    """
    rows, columns = round(4.0 / resolution), round(3.0 / resolution)
    row, column = round(BOTTOM / resolution), round(LEFT / resolution)
    cells = np.full((rows, columns), FREE, np.int8)
    cells[:row, :column] = OCCUPIED
    cells[row + up:, column + across:] = OCCUPIED
    cells = np.pad(np.rot90(cells, turns), 1, mode='constant', constant_values=OCCUPIED)
    return FloorPlan('corners', cells, resolution, (-resolution, -resolution), **kwargs)


def reached(plan, x=2.0, y=1.0):
    """Area that a brush reaches from a point [m^2]."""
    terrain = plan.refined()
    return reach(terrain, quiet(), x, y).reachable * terrain.sample_pitch ** 2


@pytest.mark.parametrize('resolution, pairs', [
    (0.05, [(6, 4), (4, 6), (7, 2), (2, 7), (5, 5), (7, 1), (1, 7), (6, 3), (3, 7)]),
    (0.1, [(3, 2), (2, 3), (4, 1), (3, 1)]), (0.02, [(16, 8), (15, 9), (15, 10), (17, 6), (11, 13)])])
def test_two_parts_are_one_if_the_robot_has_the_slack_on_each_side(resolution, pairs):
    outcomes = set()
    for across, up in pairs:
        spare = 0.5 * resolution * math.hypot(across, up) - RADIUS
        is_wide = spare > SLACK
        assert abs(spare - SLACK) > 4e-4, 'the test needs other cells'
        assert (reached(corners(across, up, resolution)) > 5.0) == is_wide, (across, up, spare)
        outcomes.add(is_wide)
    assert outcomes == {True, False}


@pytest.mark.parametrize('turns', [0, 1, 2, 3])
def test_it_is_the_same_in_each_direction(turns):
    plan = corners(6, 4, turns=turns)
    terrain = plan.refined()
    parts = Parts(terrain, clearance_needed(RADIUS, terrain.resolution))
    assert len(parts.areas) == 1 and reached(plan, *parts.open_pose(1)[:2]) == approx(5.72, abs=0.05)
    x, y, _ = parts.open_pose(1)
    assert World(plan, quiet()).start[:2] == (x, y)


@pytest.mark.parametrize('across, up', [(6, 4), (7, 2)])
def test_a_robot_drives_through(across, up):
    world = World(corners(across, up), quiet())
    middle_x, middle_y = LEFT + 0.5 * across * 0.05, BOTTOM + 0.5 * up * 0.05
    heading = math.atan2(across, -up)
    robot = world.spawn('rumba', Pose(middle_x - 0.5 * math.cos(heading), middle_y - 0.5 * math.sin(heading), heading))
    for _ in range(400):
        robot.command(0.15, 0.0, world.tick)
        world.step()
    assert robot.distance == approx(1.2, abs=0.02) and robot.pose.y > BOTTOM + 0.6


def test_on_a_map_that_errs_a_strait_is_no_passage():
    terrain = corners(6, 4).refined()
    by_plan, by_map = (reach(terrain, quiet(), 2.0, 1.0, is_exact).reachable for is_exact in (True, False))
    assert by_map < 0.7 * by_plan
    assert reach(terrain, quiet(), 2.0, 1.0).reachable == by_plan


def test_an_obstacle_in_a_strait_keeps_the_parts_apart():
    box = Obstacle('box', Pose(LEFT + 0.15, BOTTOM + 0.1, 0.0), 0.3, radius=0.05)
    assert World(corners(6, 4), quiet()).floor.reachable_area > 5.0
    assert World(corners(6, 4), quiet(), obstacles=[box]).floor.reachable_area < 4.0


def test_a_cliff_in_a_strait_keeps_the_parts_apart():
    plan = corners(6, 4)
    cliff = np.zeros(plan.occupancy.shape, np.bool_)
    cliff[plan.cell(LEFT + 0.16, BOTTOM + 0.11)] = True
    assert reached(FloorPlan('cliff', plan.occupancy, plan.resolution, plan.origin, cliff=cliff)) < 4.0


def test_people_are_told_of_floor_behind_a_strait():
    remark, = remarks(World(corners(6, 4, start=Pose(2.0, 1.0, 0.0)), quiet()))
    share, x, y = map(float, re.match(r'corners: (.*) % of what a robot can reach, about \((.*), (.*)\) m, lies behind '
                                      'gaps', remark).groups())
    assert 30.0 < share < 40.0 and x < 2.0 and y > BOTTOM + 0.2
    assert remarks(World(corners(12, 8), quiet())) == []


def doorway(wide, long, resolution=0.025):
    """Two rooms of 2 x 2 m with a straight doorway, so many cells wide and long, between them."""
    side = round(2.0 / resolution)
    cells = np.full((side + 2, 2 * side + long + 2), OCCUPIED, np.int8)
    cells[1:-1, 1:side + 1] = cells[1:-1, side + long + 1:-1] = FREE
    cells[side // 2:side // 2 + wide, side + 1:side + long + 1] = FREE
    return FloorPlan('doorway', cells, resolution, (-resolution, -resolution))


@pytest.mark.parametrize('long', [1, 4, 8, 10])
def test_a_doorway_of_an_odd_number_of_cells_through_a_wall_is_a_passage(long):
    """Its middle lies between the nodes, beside which there is half a cell less: 0.375 m are 2 cm more than needed."""
    needed = clearance_needed(RADIUS, 0.025)
    assert 0.5 * 15 * 0.025 > needed + SLACK > 0.5 * 14 * 0.025
    assert len(Parts(doorway(15, long), needed).areas) == 1
    assert len(Parts(doorway(14, long), needed).areas) == 2


def niche(wide, deep=40, resolution=0.025):
    """A room of 2 x 2 m with a dead end, so many cells wide and deep, on its right."""
    side = round(2.0 / resolution)
    cells = np.full((side + 2, side + deep + 2), OCCUPIED, np.int8)
    cells[1:-1, 1:side + 1] = FREE
    cells[side // 2:side // 2 + wide, side + 1:side + deep + 1] = FREE
    return FloorPlan('niche', cells, resolution, (-resolution, -resolution))


def test_a_dead_end_of_an_odd_number_of_cells_can_be_reached_as_well_as_a_wider_one():
    """No node in it is far enough from both walls, so no other part of the floor shows that it is there."""
    blind, odd, even = (reached(niche(wide), 1.0, 1.0) for wide in (14, 15, 16))
    brush = quiet().brush.width
    assert odd - blind == approx((1.0 - RADIUS) * brush, rel=0.25) and 0.0 <= even - odd < 0.04


@pytest.mark.parametrize('side', [18, 20])
def test_a_pocket_with_little_room_behind_a_strait_can_be_reached(side):
    """A robot can stand at few points there, but its brush covers more, and what lies on the way."""
    def pocket(deep):
        plan = niche(15, deep + side)
        low = plan.rows // 2 - side // 2
        plan.occupancy[1:-1, -side - 1:-1] = OCCUPIED
        plan.occupancy[low:low + side, -side - 1:-1] = FREE
        return plan
    more = reached(pocket(12), 1.0, 1.0) - reached(pocket(4), 1.0, 1.0)
    assert more == approx(8 * 0.025 * quiet().brush.width, rel=0.2)
