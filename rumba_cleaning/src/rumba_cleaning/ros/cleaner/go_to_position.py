"""The service go_to_position: which velocity now leads toward a target."""

import math
from typing import Any, Tuple

import numpy as np
import rospy

from rumba_cleaning.behaviours.follower import HEADING, Follower, Route, turn_rate
from rumba_cleaning.belief.context import Context
from rumba_cleaning.ros.cleaner.senses import Senses
from rumba_msg.srv import TargetPosition, TargetPositionResponse
from rumba_sim.model.errors import MapError
from rumba_sim.model.geometry import Pose, wrap_angle

THERE = 0.02  # [m] so near is at the target
PERIOD = 0.1  # [s] from one call to the next; who calls less often drives past bends


class GoToPosition:
    """Answers from the map alone; what a goal does meanwhile is not disturbed."""

    def __init__(self, robot: str, context: Context, senses: Senses) -> None:
        """Serve a robot, by its name, with a context that nobody else uses."""
        self._context = context
        self._senses = senses
        rospy.Service(f'{robot}/go_to_position', TargetPosition, self._answer)

    def _answer(self, request: Any) -> TargetPositionResponse:
        target = Pose(request.target_x, request.target_y, request.target_theta)
        pose = self._senses.pose()
        try:
            if pose is None:
                raise MapError(self._senses.missing())
            v, w, message = velocity_toward(self._context, pose, target)
        except MapError as error:
            return TargetPositionResponse(0.0, 0.0, False, str(error))
        return TargetPositionResponse(v, w, True, message)


def velocity_toward(context: Context, pose: Pose, target: Pose) -> Tuple[float, float, str]:
    """Velocity [m/s], [rad/s] that leads from a pose toward a target, around walls, and how far that is, in words.

    Raises:
        MapError: the robot cannot stand at the target, or no way leads there.
    """
    check_finite(target)
    drive = context.robot.drive
    context.plan.check_place(target, drive.radius, 'target')
    if math.hypot(target.x - pose.x, target.y - pose.y) < THERE:
        angle = wrap_angle(target.theta - pose.theta)
        if abs(angle) < HEADING:
            return 0.0, 0.0, 'there'
        return 0.0, turn_rate(angle, PERIOD, drive), 'turning'
    way = context.ground.way(np.array(pose[:2]), np.array(target[:2]))
    if way is None:
        raise MapError(f'no way from ({pose.x:.2f}, {pose.y:.2f}) to ({target.x:.2f}, {target.y:.2f}) m')
    follower = Follower(Route(way, np.full(len(way) - 1, context.config.transit_speed)), drive)
    v, w = follower.update(pose, PERIOD)
    return v, w, f'{follower.remaining:.2f} m to go'


def check_finite(target: Pose, may_face_anywhere: bool = False) -> None:
    """Refuse a target that is no place.

    Raises:
        MapError: a number is not finite; theta may be NaN where the robot may face anywhere.
    """
    if not (math.isfinite(target.x) and math.isfinite(target.y) and (
            math.isfinite(target.theta) or may_face_anywhere and math.isnan(target.theta))):
        raise MapError(f'target ({target.x}, {target.y}, {target.theta}): must be finite numbers')
