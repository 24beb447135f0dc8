"""Which beams a robot may take for those of its own dock, if other docks are near: all docks send the same."""

import math
from typing import Sequence

from rumba_cleaning.behaviour import Observation
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.kernel.sensors.dock import FORCE_FIELD, GREEN_BUOY, INNER, NO_BEAM, OUTER, RED_BUOY
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.robot import Infrared

OFF, TURNED = 0.02, 0.03  # [m], [rad] that a pose may be wrong by, beside its deviation: our choice
DEVIATIONS = 3.0  # of the pose, that it may be wrong by


def own_beams(observation: Observation, dock: Pose, others: Sequence[Pose], robot: RobotConfig) -> Observation:
    """The observation without beams that cannot come from a dock, if any of the others may send them.

    Args:
        observation: at a pose that may be wrong.
        dock: a robot that touches the contacts of its own dock is there, map frame.
        others: the same of other docks.
        robot: what it is like.
    """
    pose, beams = observation.pose, robot.dock
    if not any(hypot(other.x - pose.x, other.y - pose.y) < beams.buoy_range for other in others):
        return observation
    dx = dock.x + robot.drive.radius * math.cos(dock.theta) - pose.x
    dy = dock.y + robot.drive.radius * math.sin(dock.theta) - pose.y
    distance = hypot(dx, dy)
    (x, _, _), (_, y, _), (_, _, theta) = observation.covariance
    off = OFF + DEVIATIONS * math.sqrt(max(x, y, 0.0))
    aside = math.atan2(off, max(distance - off, 0.0))  # [rad] by which a direction may be wrong
    direction = math.atan2(dy, dx)
    right_of_axis = wrap_angle(direction - dock.theta)
    sent = FORCE_FIELD if distance - off <= beams.halo else NO_BEAM
    if -0.5 * beams.buoy_overlap - aside <= right_of_axis <= 0.5 * beams.buoy_field + aside:
        sent |= GREEN_BUOY
    if -0.5 * beams.buoy_field - aside <= right_of_axis <= 0.5 * beams.buoy_overlap + aside:
        sent |= RED_BUOY
    bearing, aside = wrap_angle(direction - pose.theta), aside + TURNED + DEVIATIONS * math.sqrt(max(theta, 0.0))
    omni, left, right = observation.infrared
    return observation._replace(infrared=Infrared(
        omni & sent,
        left & sent if -INNER - aside <= bearing <= OUTER + aside else NO_BEAM,
        right & sent if -OUTER - aside <= bearing <= INNER + aside else NO_BEAM))
