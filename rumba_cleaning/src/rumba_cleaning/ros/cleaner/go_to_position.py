"""The service go_to_position: which velocity now leads toward a target."""

import math
import threading
from typing import Any, Optional, Tuple

import numpy as np
import rospy

from rumba_cleaning.behaviours.follower import HEADING, Follower, Route, turn_rate
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner.senses import Senses
from rumba_cleaning.ros.cleaner.workplace import Workplace
from rumba_msg.srv import TargetPosition, TargetPositionResponse
from rumba_sim.model.errors import MapError, RumbaError
from rumba_sim.model.geometry import Pose, wrap_angle

THERE = 0.02  # [m] from the target, at most, for a robot that is there
PERIOD = 0.1  # [s] from one call to the next; a client that calls less often drives past bends


class GoToPosition:
    """Answers from the map alone, and does not disturb a goal that is active."""

    def __init__(self, robot: str, workplace: Workplace, config: CleaningConfig, senses: Senses) -> None:
        """Serve a robot, by its name."""
        self._workplace = workplace
        self._config = config
        self._senses = senses
        self._lock = threading.Lock()  # each client has a thread
        self._context: Optional[Context] = None
        rospy.Service(f'{robot}/go_to_position', TargetPosition, self._answer)

    def _answer(self, request: Any) -> TargetPositionResponse:
        target = Pose(request.target_x, request.target_y, request.target_theta)
        pose = self._senses.pose()
        try:
            if pose is None:
                raise MapError(self._senses.missing())
            with self._lock:
                v, w, message = velocity_toward(self._newest_context(), pose, target)
        except RumbaError as error:
            return TargetPositionResponse(0.0, 0.0, False, str(error))
        return TargetPositionResponse(v, w, True, message)

    def _newest_context(self) -> Context:
        """The context of the calls before, with all that it computed, until map or robot change."""
        plan, robot = self._workplace.look()
        context = self._context
        if context is None or context.plan is not plan or context.robot != robot:
            context = self._context = Context(plan, robot, self._config)
        return context


def velocity_toward(context: Context, pose: Pose, target: Pose) -> Tuple[float, float, str]:
    """Velocity [m/s], [rad/s] that leads from a pose toward a target, around walls, and how far that is, in words.

    Raises:
        MapError: the robot cannot stand at the target, or no path leads there.
    """
    check_finite(target)
    drive = context.robot.drive
    context.plan.check_pose(target, drive.radius, 'target')
    if math.hypot(target.x - pose.x, target.y - pose.y) < THERE:
        angle = wrap_angle(target.theta - pose.theta)
        if abs(angle) < HEADING:
            return 0.0, 0.0, 'there'
        return 0.0, turn_rate(angle, PERIOD, drive), 'turning'
    path = context.ground.path(np.array(pose[:2]), np.array(target[:2]))
    if path is None:
        raise MapError(f'no path from ({pose.x:.2f}, {pose.y:.2f}) to ({target.x:.2f}, {target.y:.2f}) m')
    follower = Follower(Route(path, np.full(len(path) - 1, context.config.transit_speed)), drive)
    v, w = follower.velocity(pose, PERIOD)
    return v, w, f'{follower.remaining:.2f} m to go'


def check_finite(target: Pose, may_face_anywhere: bool = False) -> None:
    """Refuse a target that is not a pose.

    Raises:
        MapError: a number is not finite; theta may be NaN if the robot may face anywhere.
    """
    if not (math.isfinite(target.x) and math.isfinite(target.y) and (
            math.isfinite(target.theta) or may_face_anywhere and math.isnan(target.theta))):
        raise MapError(f'target ({target.x}, {target.y}, {target.theta}): must be finite numbers')
