"""The docks: their contacts, and the infrared beams that robots receive from them."""

import math
from typing import Tuple

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.geometry import wrap
from rumba_sim.model.kernel.records import THETA, X, Y
from rumba_sim.model.kernel.sensors.beams import cast

NO_BEAM, FORCE_FIELD, GREEN_BUOY, RED_BUOY = 0, 1, 4, 8  # rumba_msg/DockStatus
INNER, OUTER = 0.26, 1.57  # [rad] how far the left receiver sees to the right and to the left


def at_contacts(robot: Record, k: Record, docks: Array) -> bool:
    """Whether charging contacts are closed: they open at a larger distance than they close."""
    farthest = k.release_distance if robot.docked else k.contact_distance
    widest = k.release_angle if robot.docked else k.contact_angle
    for dock in range(len(docks)):
        if math.hypot(robot.x - docks[dock, X], robot.y - docks[dock, Y]) <= farthest and (
                abs(wrap(robot.theta - docks[dock, THETA])) <= widest):
            return True
    return False


def infrared(robots: Array, me: int, constants: Array, docks: Array, skips: Array) -> Tuple[int, int, int]:
    """Sums of the beams of all docks that the three receivers get: omnidirectional, front left, front right."""
    omni, left, right = NO_BEAM, NO_BEAM, NO_BEAM
    for dock in range(len(docks)):
        beams = beams_of(docks[dock], robots[me], constants[0], skips)
        omni, left, right = omni | beams[0], left | beams[1], right | beams[2]
    return omni, left, right


def beams_of(dock: Array, robot: Record, k: Record, skips: Array) -> Tuple[int, int, int]:
    """The same of one dock, a row of `docks`.

    It sends from the wall in front of a docked robot, opposite to the heading of that robot.
    """
    from_x = dock[X] + k.radius * math.cos(dock[THETA])
    from_y = dock[Y] + k.radius * math.sin(dock[THETA])
    dx, dy = robot.x - from_x, robot.y - from_y
    distance = math.hypot(dx, dy)
    if distance < 1e-6 or cast(k, skips, from_x, from_y, dx / distance, dy / distance, distance) < distance:
        return NO_BEAM, NO_BEAM, NO_BEAM
    beams = FORCE_FIELD if distance <= k.halo else NO_BEAM
    # Positive if a robot that faces the dock is to the right of its axis.
    off_axis = wrap(math.atan2(dy, dx) - dock[THETA] - math.pi)
    if distance <= k.buoy_range:
        if -k.buoy_overlap_half <= off_axis <= k.buoy_half:
            beams |= GREEN_BUOY
        if -k.buoy_half <= off_axis <= k.buoy_overlap_half:
            beams |= RED_BUOY
    bearing = wrap(math.atan2(-dy, -dx) - robot.theta)
    left = beams if -INNER <= bearing <= OUTER else NO_BEAM
    right = beams if -OUTER <= bearing <= INNER else NO_BEAM
    return beams, left, right
