"""Backs off from what is in the way, far enough to turn, and keeps away from the edges that the floor plan shows.

A robot that comes to an edge at a slant sees it late, and slides on while it stops.
"""

import math
from typing import Tuple

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.common.geometry import Pose

SPEED = 0.1  # [m/s] backward: slow, since nothing looks behind the robot
BUMP = 0.05  # [m] back from a contact: the bumper is open again, and the robot can turn
# Back from a cliff: the sensors see it 0.15 m ahead of the middle, the robot needs up to 0.08 m to notice and to stop,
# and its wheels, 0.12 m off the middle, must not swing over the edge when it turns.
CLIFF = 0.15  # [m]
BRAKING = 0.08  # [m] to spare to an edge: what the robot needs to notice and to stop
AHEAD = 0.1  # [m] from the middle at which the floor plan is looked at: a third of what is driven in 1 s


def time_back(observation: Observation) -> float:
    """How long to drive backward from a contact, or from a cliff [s]."""
    return (CLIFF if any(observation.cliffs) else BUMP) / SPEED


def is_near_edge(ground: Ground, pose: Pose) -> bool:
    """Whether a cliff of the floor plan is too near, and nearer than any wall."""
    plan = ground.plan
    return plan.safe_clearance_at(pose.x, pose.y) < min(ground.reach + BRAKING, plan.clearance_at(pose.x, pose.y))


def edge_ahead(ground: Ground, pose: Pose) -> Tuple[bool, bool]:
    """Whether a robot drives toward such a cliff on its left, and on its right."""
    if not is_near_edge(ground, pose):
        return False, False
    left, ahead, right = (ground.plan.safe_clearance_at(pose.x + AHEAD * math.cos(pose.theta + angle),
                                                        pose.y + AHEAD * math.sin(pose.theta + angle))
                          for angle in (0.25 * math.pi, 0.0, -0.25 * math.pi))
    leads_there = ahead < ground.plan.safe_clearance_at(pose.x, pose.y)
    return leads_there and left <= right, leads_there and right <= left
