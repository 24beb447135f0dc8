"""Where the first robot starts if the map does not say, and what people are told of floor that it cannot reach."""

import pytest
import yaml
from pytest import approx
from rooms import quiet, room

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import Parts
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.remarks import remarks
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

FLAT = [(3.1, 0.0, 3.2, 8.3), (0.0, 3.1, 3.1, 8.3)]  # a closed room of 3.1 m square beside a flat of 2.7 x 8.3 m


def flat(**kwargs):
    """The flat; the most open place is in the closed room."""
    return room(5.9, 8.3, boxes=FLAT, **kwargs)


def test_without_a_start_robots_begin_in_the_largest_part_and_not_in_the_most_open_one():
    plan = flat()
    assert plan.most_open_pose()[:2] == approx((1.55, 1.55), abs=0.03)
    world = World(plan, quiet())
    assert 3.2 < world.start.x and plan.clearance_at(*world.start[:2]) == approx(1.35)
    assert world.floor.reachable_area > 20.0
    world.spawn('rumba')
    world.spawn('rumba2')
    assert all(robot.pose.x > 3.2 for robot in world.robots.values())


def test_obstacles_that_stand_there_from_the_start_divide_the_floor_too():
    plan = room(6.0, 3.0)
    door = Obstacle('shelf', Pose(2.0, 1.5, 0.0), 1.0, length=0.2, width=2.9)
    assert World(plan, quiet(), obstacles=[door]).start.x > 3.0


def test_people_are_told_of_floor_out_of_reach_and_where_to_start_instead():
    world = World(flat(), quiet())
    assert remarks(world) == [
        'room: 29 % of the floor on which a robot can stand is out of reach of the start at '
        f'({world.start.x:.2f}, {world.start.y:.2f}) m. To reach the largest part of it, give the map '
        'start: [1.55, 1.55, 0.0]']
    remark, = remarks(World(flat(start=Pose(1.0, 1.0, 0.0)), quiet()))
    assert remark.startswith('room: 71 % of the floor') and 'start at (1.00, 1.00) m' in remark
    start = yaml.safe_load(remark.split('the map ')[1])['start']
    assert World(flat(start=Pose(*start)), quiet()).floor.reachable_area > 20.0


def test_a_map_without_much_to_say_has_only_the_remarks_of_its_file():
    plan = room(3.0, 3.0, boxes=[(0.0, 2.5, 0.4, 2.6), (0.4, 2.5, 0.5, 3.0)])  # a corner of 0.4 x 0.4 m is closed
    assert remarks(World(plan, quiet())) == []
    odd = FloorPlan('odd', plan.occupancy, plan.resolution, plan.origin, remarks=['odd: a line'])
    assert remarks(World(odd, quiet())) == ['odd: a line'] and odd.refined().remarks == ('odd: a line',)


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
def test_parts_are_numbered_by_their_size(resolution):
    plan = flat(resolution=resolution).refined()
    parts = Parts(plan, clearance_needed(0.17425, plan.resolution))
    assert len(parts.areas) == 2 and parts.areas.tolist() == approx(
        [(width - 2.0 * 0.177) * (height - 2.0 * 0.177) for width, height in ((2.7, 8.3), (3.1, 3.1))], rel=0.02)
    assert [parts.at(4.5, 1.0), parts.at(1.5, 1.5), parts.at(1.5, 6.0), parts.at(3.1 - 0.175, 1.0)] == [1, 2, 0, 2]
    assert parts.open_pose(2) == approx((1.55, 1.55, 0.0), abs=0.03) and parts.open_pose(3) == plan.most_open_pose()
