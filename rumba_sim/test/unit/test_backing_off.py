"""What a robot drove into does not hold it: neither walls nor obstacles nor robots, and no dent in the clearance."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms import NAMES, PLANS, RADIUS, STARTS, distances, quiet, start
from things import clutter, distance

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.simulation.world import World

SPARE = 0.002  # [m] by which the way back is wider than the robot
STRAIGHT_ON = np.arange(0.0, 0.2, 0.01)  # [m]
EXACT = 1e-6  # [m]


def populated(plan, step_rate, obstacles, starts):
    """A world with all of these obstacles and robots for which there is room; the first robot is there."""
    world = World(PLANS[plan], quiet(drive={'acceleration': 1000.0}), step_rate)
    for number, where in enumerate(starts):
        try:
            world.spawn(f'r{number}', start(plan, where))
        except WorldError:  # another one is there
            continue
    for obstacle in obstacles:
        try:
            world.add_obstacle(obstacle)
        except WorldError:  # a robot stands there, or the mover is too fast for this step rate
            continue
    return world


def is_clear(world, robot, before, x, y):
    """Whether nothing is where a robot would be that moves from a pose to (x, y), and no wall straight on behind."""
    way = math.hypot(x - before.x, y - before.y)
    cos, sin = (x - before.x) / way, (y - before.y) / way
    apart = [math.hypot(other.pose.x - x, other.pose.y - y) - RADIUS
             for other in world.robots.values() if other is not robot]
    apart += [distance(pose, obstacle, x, y) for obstacle, pose in world.obstacles.poses()]
    return min(apart, default=math.inf) > RADIUS + EXACT and min(
        distances(world.plan, [(x + far * cos, y + far * sin) for far in STRAIGHT_ON])) > RADIUS + SPARE


@settings(max_examples=60)
@given(NAMES, st.sampled_from([10, 50]), clutter(), st.lists(STARTS, min_size=1, max_size=4),
       st.sampled_from([0.3, -0.3, 0.1]))
def test_a_robot_that_backs_off_is_held_by_nothing_that_is_not_in_its_way(plan, step_rate, obstacles, starts, v):
    world = populated(plan, step_rate, obstacles, starts)
    backing, others = world.robots['r0'], list(world.robots.values())[1:]
    for _ in range(round(1.5 / abs(v) * step_rate)):
        for robot in (backing, *others):
            robot.command(v, 0.0, world.tick)
        world.step()
    way = -v / step_rate
    for _ in range(step_rate // 2):
        before = backing.pose
        for robot in others:
            robot.command(0.0, 0.0, world.tick)
        backing.command(-v, 0.0, world.tick)
        world.step()
        cos, sin = math.cos(before.theta), math.sin(before.theta)
        made = (backing.pose.x - before.x) * cos + (backing.pose.y - before.y) * sin
        if not 0.5 <= made / way <= 2.0:
            assert not is_clear(world, backing, before, before.x + way * cos, before.y + way * sin)
