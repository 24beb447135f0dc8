"""The service go_to_position: which velocity, or which heading, now leads toward a target."""

import math
import threading
from typing import Any, List, Optional, Tuple

import numpy as np
import rospy

from rumba_cleaning.behaviours.compiled_follower import LEAST_AHEAD
from rumba_cleaning.behaviours.follower import HEADING, Follower, turn_rate
from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.ros.cleaner.goals.settings import Settings
from rumba_cleaning.ros.cleaner.goals.workplace import Workplace
from rumba_cleaning.ros.cleaner.robots.senses import Senses
from rumba_cleaning.route import Route
from rumba_msg.srv import TargetPosition, TargetPositionResponse
from rumba_sim.model.common.errors import MapError, RumbaError
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.running import peers

THERE = 0.02  # [m] from the target, at most, for a robot that is there
PERIOD = 0.1  # [s] from one call to the next; a client that calls less often drives past bends
BACKWARD = -1.0  # [m/s] beside a heading, as servers of the lesson answer: the heading is that of a robot that backs up


class GoToPosition:
    """Answers from the map alone, and does not disturb a goal that is active."""

    def __init__(self, settings: Settings, workplace: Workplace, senses: Senses) -> None:
        """Serve a robot, unless another node does so already, for example one of a learner: that one keeps the name."""
        self._knowledge = Knowledge(workplace, settings.cleaning)
        self._senses = senses
        self._toward = heading_toward if settings.go_to_position.answer == 'heading' else velocity_toward
        self._lock = threading.Lock()  # each client has a thread
        service = rospy.resolve_name(f'{settings.robot}/go_to_position')
        server = _other_server(service)
        if server:
            rospy.logwarn(f'{service} is served by {server}, which keeps it: this node does not serve it')
        else:
            rospy.Service(service, TargetPosition, self._answer)

    def _answer(self, request: Any) -> TargetPositionResponse:
        target = Pose(request.target_x, request.target_y, request.target_theta)
        pose = self._senses.pose()
        try:
            if pose is None:
                raise MapError(self._senses.missing())
            with self._lock:
                linear_x, angular_z, message = self._toward(self._knowledge.context(), pose, target)
        except RumbaError as error:
            return TargetPositionResponse(0.0, 0.0, False, str(error))
        return TargetPositionResponse(linear_x, angular_z, True, message)


class Knowledge:
    """What the service knows of floor and robot, with all that it computed for the calls before."""

    def __init__(self, workplace: Workplace, config: CleaningConfig) -> None:
        """Know nothing yet."""
        self._workplace = workplace
        self._config = config
        self._of: Optional[Tuple[FloorPlan, RobotConfig]] = None
        self._context: Optional[Context] = None

    def context(self) -> Context:
        """The same context, until map or robot change.

        Raises:
            MapError: as `Workplace.look`.
        """
        plan, robot = self._workplace.look()
        if self._context is None or self._of is None or self._of[0] is not plan or self._of[1] != robot:
            self._of, self._context = (plan, robot), Context(plan, robot, self._config)
        return self._context


def velocity_toward(context: Context, pose: Pose, target: Pose) -> Tuple[float, float, str]:
    """Velocity [m/s], [rad/s] that leads from a pose toward a target, around walls, and how far that is, in words.

    Raises:
        MapError: the robot cannot stand at the target, or no path leads there.
    """
    path, drive = _path(context, pose, target), context.robot.drive
    if path is None:
        angle = wrap_angle(target.theta - pose.theta)
        if abs(angle) < HEADING:
            return 0.0, 0.0, 'there'
        return 0.0, turn_rate(angle, PERIOD, drive), 'turning'
    follower = Follower(Route(path, np.full(len(path) - 1, context.config.transit_speed)), drive)
    v, w = follower.velocity(pose, PERIOD)
    return v, w, f'{follower.remaining:.2f} m to go'


def heading_toward(context: Context, pose: Pose, target: Pose) -> Tuple[float, float, str]:
    """A speed [m/s], the heading [rad] in which it leads from a pose toward a target, and how far that is, in words.

    The robot backs up to the target, around walls: the heading points away from the next corner of its path. At the
    target, the speed is 0, and the heading is that of the target.

    Raises:
        MapError: as for `velocity_toward`.
    """
    path = _path(context, pose, target)
    if path is None:
        heading = wrap_angle(target.theta)
        return 0.0, heading, 'there' if abs(wrap_angle(heading - pose.theta)) < HEADING else 'turning'
    ways = np.hypot(*(path - pose[:2]).T)
    # The first corner that is not so near that the robot circles it.
    x, y = path[int(np.argmax(ways >= LEAST_AHEAD)) or -1]
    length = float(np.hypot(*np.diff(path, axis=0).T).sum())
    return BACKWARD, math.atan2(pose.y - y, pose.x - x), f'{length:.2f} m to go'


def _path(context: Context, pose: Pose, target: Pose) -> Optional[Array]:
    """The path from a pose to a target, float64 (any, 2) [m]; None if the robot is there.

    Raises:
        MapError: the robot cannot stand at the target, or no path leads there.
    """
    check_finite(target)
    context.plan.check_pose(target, context.robot.drive.radius, 'target')
    if math.hypot(target.x - pose.x, target.y - pose.y) < THERE:
        return None
    path = paths.between(context.ground, np.array(pose[:2]), np.array(target[:2]))
    if path is None:
        raise MapError(f'no path from ({pose.x:.2f}, {pose.y:.2f}) to ({target.x:.2f}, {target.y:.2f}) m')
    return path


def _other_server(service: str) -> str:
    """Full name of another node that serves a service, and answers; empty if there is none."""
    _, _, (_, _, services) = rospy.get_master().getSystemState()
    others: List[str] = [node for node in dict(services).get(service, []) if node != rospy.get_name()]
    return others[0] if others and peers.is_alive(others[0]) else ''


def check_finite(target: Pose, may_face_anywhere: bool = False) -> None:
    """Refuse a target that is not a pose.

    Raises:
        MapError: a number is not finite; theta may be NaN if the robot may face anywhere.
    """
    if not (math.isfinite(target.x) and math.isfinite(target.y) and (
            math.isfinite(target.theta) or may_face_anywhere and math.isnan(target.theta))):
        raise MapError(f'target ({target.x}, {target.y}, {target.theta}): must be finite numbers')
