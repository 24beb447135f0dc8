"""Obstacles for the tests of the model, and exact distances to them, computed from their corners."""

import functools
import math

import numpy as np
from hypothesis import strategies as st

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle, walk

HIGH, LOW = 0.5, 0.05  # [m] over the laser and below it


def disc(name, x, y, radius, height=HIGH):
    """A disc that stands."""
    return Obstacle(name, Pose(x, y, 0.0), height, radius=radius)


def box(name, x, y, yaw, length, width, height=HIGH):
    """A box that stands."""
    return Obstacle(name, Pose(x, y, yaw), height, length=length, width=width)


def walker(name, waypoints, speed=0.5, radius=0.15, is_loop=False, pause=(0.0, 0.0), size=(0.0, 0.0), height=HIGH):
    """A disc, or a box of a size, that goes along waypoints."""
    poses = [Pose(*waypoint, *[0.0] * (3 - len(waypoint))) for waypoint in waypoints]
    return Obstacle(name, poses[0], height, 0.0 if any(size) else radius, *size,
                    stops=walk(poses, speed, is_loop, *pause))


@st.composite
def clutter(draw):
    """Obstacles anywhere in a room of 3 x 2.4 m."""
    found = []
    for number in range(draw(st.integers(1, 8))):
        x, y, yaw = draw(st.floats(0.0, 3.0)), draw(st.floats(0.0, 2.4)), draw(st.floats(-3.1, 3.1))
        kind, size = draw(st.sampled_from(['disc', 'box', 'walker', 'crate'])), draw(st.floats(0.02, 0.3))
        to = (draw(st.floats(0.0, 3.0)), draw(st.floats(0.0, 2.4)), draw(st.floats(-3.1, 3.1)))
        found.append({
            'disc': lambda: disc(f'o{number}', x, y, size), 'box': lambda: box(f'o{number}', x, y, yaw, size, 0.1),
            'walker': lambda: walker(f'o{number}', [(x, y), to[:2]], 0.7, size),
            'crate': lambda: walker(f'o{number}', [(x, y, yaw), to], 0.2, size=(size, 0.2), is_loop=True)}[kind]())
    return found


def corners(pose, obstacle):
    """Corners of a box at a pose, counter-clockwise: float64 (4, 2) [m]."""
    halves = 0.5 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * (obstacle.length, obstacle.width)
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    return halves @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]


def to_segment(point, start, end):
    """Distance from a point to a segment [m]."""
    x, y = end[0] - start[0], end[1] - start[1]
    share = ((point[0] - start[0]) * x + (point[1] - start[1]) * y) / (x * x + y * y)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(start[0] + share * x - point[0], start[1] + share * y - point[1])


@functools.lru_cache(maxsize=100)  # most obstacles stand, or several robots are near them
def sides_of(pose, obstacle):
    """Begin and end of each side of a box at a pose [m]."""
    points = corners(pose, obstacle).tolist()
    return list(zip(points, points[1:] + points[:1]))


def distance(pose, obstacle, x, y):
    """Distance from an obstacle at a pose to a point [m], negative inside: by the sides of a box, one by one."""
    if obstacle.radius:
        return math.hypot(pose.x - x, pose.y - y) - obstacle.radius
    sides = sides_of(pose, obstacle)
    least = min(to_segment((x, y), start, end) for start, end in sides)
    is_inside = all((end[0] - start[0]) * (y - start[1]) - (end[1] - start[1]) * (x - start[0]) > 0.0
                    for start, end in sides)
    return -least if is_inside else least


def gaps(world):
    """Distance from the edge of each robot to each obstacle [m]."""
    radius, obstacles = world.config.drive.radius, list(world.obstacles.poses())
    return [distance(pose, obstacle, robot.x, robot.y) - radius
            for robot in (robot.pose for robot in world.robots.values()) for obstacle, pose in obstacles]
