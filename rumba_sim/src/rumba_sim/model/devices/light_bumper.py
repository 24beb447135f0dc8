"""The six sensors in the bumper of a Create 2 that see by light what is near, before it touches.

The Open Interface gives a signal from 0 to 4095 for each, and no distances: how far they reach is our choice, and so
are their directions.
"""

import math
from typing import List, NamedTuple

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.simulation.world import World

# [rad] from straight ahead: left, front left, center left, center right, front right, right.
DIRECTIONS = tuple(math.radians(angle) for angle in (65.0, 38.0, 13.0, -13.0, -38.0, -65.0))
REACH = 0.15  # [m] from the bumper, at which the signal is 0
SEEN = 0.1  # [m] within which something counts as seen
STRONGEST = 4095
CONTACT = 1e-3  # [m]
STEPS = 20  # along a beam, at most


class Light(NamedTuple):
    """What a sensor tells."""

    signal: int  # 0 to STRONGEST
    is_near: bool


def light_bumper(world: World, name: str) -> List[Light]:
    """What the sensors of a robot tell, from left to right.

    Raises:
        KeyError: there is no robot of that name.
    """
    return [_light(_distance(world, name, direction)) for direction in DIRECTIONS]


def _light(distance: float) -> Light:
    return Light(round(STRONGEST * (1.0 - distance / REACH) ** 2), distance < SEEN)


def _distance(world: World, name: str, direction: float) -> float:
    """From the bumper to what is first met in a direction [m], at most REACH."""
    me, radius = world.robots[name].pose, world.config.drive.radius
    along_x, along_y = math.cos(me.theta + direction), math.sin(me.theta + direction)
    limit = radius + REACH
    distance: float = fast.cast(world.constants[0], world.terrain.skips, me.x, me.y, along_x, along_y, limit)
    others = [robot.pose for other, robot in world.robots.items() if other != name]
    at = radius
    for _ in range(STEPS):
        x, y = me.x + at * along_x, me.y + at * along_y
        gap = fast.nearest_obstacle(world.obstacles.records, x, y, REACH)[0]
        gap = min([gap] + [math.hypot(other.x - x, other.y - y) - radius for other in others])
        if gap < CONTACT:
            distance = min(distance, at)
        at += gap
        if gap < CONTACT or at > distance:
            break
    return max(0.0, min(distance, limit) - radius)
