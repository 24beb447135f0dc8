"""From messages to plain values; a message that makes no sense is refused, and a single value that is odd is unknown.

Anybody can publish anything. What passes here is finite, of a sensible size, and fits together, so that no other module
needs to doubt it.
"""

import itertools
import math
from typing import Any, NamedTuple, Optional, Tuple, Union

import numpy as np
import rosgraph
from actionlib_msgs.msg import GoalStatusArray
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.msg import Odometry, Path
from sensor_msgs.msg import BatteryState
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from rumba_msg.msg import CleaningStatus, GoToActionGoal, MissionStatus, SimulatorState
from rumba_sim.model.common.errors import RumbaError, one_line, quoted
from rumba_sim.model.common.geometry import TURN, Pose, compose
from rumba_sim.model.maps.map_image import MAX_PIXELS
from rumba_sim.model.simulation.obstacle import LASER_HEIGHT
from rumba_sim.ros.common.conversions import map_pose, plane_pose, transform_pose
from rumba_viewer.scene.snapshot import GOING_TO, YIELDING, Array, Battery, Cleaning, Grid, Mission, Obstacle, Point

FAR = 1e7  # [m] larger coordinates are not valid
FINEST = 1e-4  # [m] smallest side of a cell
MOST = 1e9  # larger voltages, currents, areas, distances and speeds are not valid
MOST_BEAMS = 3600  # of a scan that are shown
MOST_OBSTACLES = 1000  # that are shown
MOST_PARTICLES = 1000  # that are shown
MOST_CORNERS = 100_000  # of a planned path
MOST_TURNS = 1e3  # [rad] largest angle of a beam
ROUNDING = 1e-6  # by which a share may exceed 1
STATES = {**{getattr(MissionStatus, name): name.lower().replace('_', ' ') for name in (
    'IDLE', 'UNDOCKING', 'CLEANING', 'RETURNING', 'DOCKING', 'CHARGING', 'STRANDED')},
    MissionStatus.YIELDING: YIELDING, MissionStatus.GOING_TO: GOING_TO}
SUPPLIES = {BatteryState.POWER_SUPPLY_STATUS_CHARGING: 'charging', BatteryState.POWER_SUPPLY_STATUS_FULL: 'full',
            BatteryState.POWER_SUPPLY_STATUS_DISCHARGING: 'on battery'}
WITHOUT_GOAL = (MissionStatus.IDLE, MissionStatus.STRANDED)

_numbers = itertools.count()


class OddMessage(RumbaError):
    """A message makes no sense."""


class Reading(NamedTuple):
    """Where a robot was at a time [s] of its clock."""

    stamp: float
    pose: Pose


class Mounting(NamedTuple):
    """Where a laser is on its robot: its pose in the frame of the robot, and whether it is upside down."""

    pose: Pose
    upside_down: bool


class Scan(NamedTuple):
    """What a laser measured at a time [s]: ranges (n,) [m] and angles (n,) [rad], in its own frame."""

    stamp: float
    ranges: Array
    angles: Array
    is_round: bool  # whether it sees all around

    def outline(self, robot: Pose, mounting: Mounting) -> Array:
        """The outline (any, 2) [m] of what it sees: the ends of its beams, and the laser itself if there is a gap."""
        x, y, theta = compose(robot, mounting.pose)
        angles = theta - self.angles if mounting.upside_down else theta + self.angles
        ends = np.stack([x + self.ranges * np.cos(angles), y + self.ranges * np.sin(angles)], axis=1)
        return ends if self.is_round else np.append(ends, [(x, y)], axis=0)


class State(NamedTuple):
    """What a simulator says of itself.

    Attributes:
        node: full name of its node.
        map: path of its map.
        reached, wanted: speed [times real time]; NaN if unknown.
        is_paused: whether time is stopped.
        is_simulated: whether time is that of /clock.
    """

    node: str
    map: str
    reached: float
    wanted: float
    is_paused: bool
    is_simulated: bool


def reading(message: Odometry) -> Reading:
    """Where a robot is.

    Raises:
        OddMessage: the pose is not finite, or is too far away.
    """
    return Reading(message.header.stamp.to_sec(), believed(message))


def believed(message: Union[Odometry, PoseWithCovarianceStamped]) -> Pose:
    """The pose of a message with covariance.

    Raises:
        OddMessage: it is not finite, or is too far away.
    """
    return _checked(plane_pose(message.pose.pose))


def _checked(pose: Pose) -> Pose:
    if not (abs(pose.x) < FAR and abs(pose.y) < FAR and math.isfinite(pose.theta)):
        raise OddMessage(f'the pose is {pose.x:g}, {pose.y:g} m, {pose.theta:g} rad: must be finite, within {FAR:g} m')
    return pose


def particles(message: PoseArray) -> Array:
    """Positions (n, 2) [m] of poses, at most MOST_PARTICLES, without those that are not finite or too far away."""
    step = max(-(-len(message.poses) // MOST_PARTICLES), 1)
    points = np.array([(pose.position.x, pose.position.y) for pose in message.poses[::step]], float).reshape(-1, 2)
    return np.asarray(points[(np.abs(points) < FAR).all(axis=1)])


def planned(message: Path) -> Array:
    """The corners (n, 2) [m] of a planned path, which may have none.

    Raises:
        OddMessage: one is not finite, or is too far away, or there are too many.
    """
    if len(message.poses) > MOST_CORNERS:
        raise OddMessage(f'a path of {len(message.poses)} poses: must be at most {MOST_CORNERS}')
    corners = np.array([(one.pose.position.x, one.pose.position.y) for one in message.poses], float).reshape(-1, 2)
    if not (np.abs(corners) < FAR).all():
        raise OddMessage(f'a pose of the path is not finite, or not within {FAR:g} m')
    return corners


def battery(message: BatteryState) -> Battery:
    """The battery of a robot."""
    return Battery(_share(message.percentage), _value(message.voltage), _value(message.current),
                   SUPPLIES.get(message.power_supply_status, ''))


def cleaning(message: CleaningStatus) -> Cleaning:
    """How much of the floor is clean."""
    return Cleaning(_share(message.coverage), _amount(message.cleaned_area), _amount(message.reachable_area),
                    _share(message.dirt), _amount(message.distance), message.header.stamp.to_sec())


def mission(message: MissionStatus) -> Mission:
    """What the cleaner makes a robot do."""
    return Mission(STATES.get(message.state, '?'), message.state not in WITHOUT_GOAL, one_line(message.strategy),
                   one_line(message.message))


def goal_time(message: GoalStatusArray) -> Optional[float]:
    """When the last goal came of an action [s]; None if it has none."""
    return max((status.goal_id.stamp.to_sec() for status in message.status_list), default=None)


def destination(message: GoToActionGoal) -> Point:
    """Where a robot is sent.

    Raises:
        OddMessage: it is not finite, or is too far away.
    """
    target = message.goal.target
    if not (abs(target.x) < FAR and abs(target.y) < FAR):
        raise OddMessage(f'the target is {target.x:g}, {target.y:g} m: must be finite, within {FAR:g} m')
    return Point(target.x, target.y)


def scan(message: Any) -> Scan:
    """What a laser measured: 0 if something was too near or unknown, range_max if nothing was hit.

    Raises:
        OddMessage: range_max or an angle is not valid, or there is no range.
    """
    count = len(message.ranges)
    last = message.angle_min + count * message.angle_increment
    if not (count and 0.0 < message.range_max < FAR and abs(message.angle_min) < MOST_TURNS and abs(last) < MOST_TURNS):
        raise OddMessage(f'{count} ranges up to {message.range_max:g} m, from {message.angle_min:g} rad with steps of '
                         f'{message.angle_increment:g} rad: must be one or more, finite and positive')
    shown = np.arange(0, count, -(-count // MOST_BEAMS))
    ranges = np.nan_to_num(np.asarray(message.ranges, float)[shown], nan=0.0)
    return Scan(message.header.stamp.to_sec(), np.clip(ranges, 0.0, message.range_max),
                message.angle_min + shown * message.angle_increment,
                abs((count + 0.5) * message.angle_increment) > TURN)


def mounting(message: TFMessage, frame: str) -> Optional[Mounting]:
    """Where the laser of a frame is mounted; None if the message does not tell it.

    Raises:
        OddMessage: it is not finite, or is too far away.
    """
    link = next((link.transform for link in message.transforms if link.child_frame_id == frame), None)
    if link is None:
        return None
    turn = link.rotation
    return Mounting(_checked(transform_pose(link)), turn.x * turn.x + turn.y * turn.y > 0.5)


def grid(message: Any) -> Grid:
    """The cells of a nav_msgs/OccupancyGrid.

    Raises:
        OddMessage: their number, size or position is not valid.
    """
    info, origin = message.info, message.info.origin.position
    if not 0 < info.width * info.height == len(message.data) <= MAX_PIXELS:
        raise OddMessage(f'{info.width} x {info.height} cells with {len(message.data)} values: must be one for each '
                         f'cell, 1 to {MAX_PIXELS}')
    if not (FINEST <= info.resolution and info.resolution * max(info.width, info.height) < FAR
            and abs(origin.x) < FAR and abs(origin.y) < FAR):
        raise OddMessage(f'cells of {info.resolution:g} m at {origin.x:g}, {origin.y:g} m: must be {FINEST:g} m or '
                         f'more, within {FAR:g} m')
    return Grid(message.data.reshape(info.height, info.width), info.resolution, origin.x, origin.y, next(_numbers))


def map_frame(message: TFMessage) -> Optional[Pose]:
    """Where the frame of the map that a robot makes is in the world; None if the message does not tell it.

    Raises:
        OddMessage: it is not finite, or is too far away.
    """
    pose = map_pose(message)
    return None if pose is None else _checked(pose)


def state(message: SimulatorState) -> State:
    """What a simulator says of itself.

    Raises:
        OddMessage: its node has no valid name, or its map no valid path.
    """
    if not (message.node.startswith('/') and rosgraph.names.is_legal_name(message.node)):
        raise OddMessage(f'node is {quoted(message.node)}: must be the full name of a node')
    if not message.map.isprintable():
        raise OddMessage(f'map is {quoted(message.map)}: must be the path of a file')
    return State(message.node, message.map, _amount(message.real_time_factor), _amount(message.speed),
                 message.is_paused, message.is_time_simulated)


def obstacles(message: MarkerArray) -> Tuple[Obstacle, ...]:
    """The cubes and cylinders among the markers that a simulator shows instead of its earlier ones.

    Raises:
        OddMessage: a pose or a size is not finite, or is too large.
    """
    return tuple(_obstacle(marker) for marker in message.markers[:MOST_OBSTACLES + 1]
                 if marker.action == Marker.ADD and marker.type in (Marker.CUBE, Marker.CYLINDER))


def _obstacle(marker: Marker) -> Obstacle:
    pose, size = plane_pose(marker.pose), marker.scale
    if not (abs(pose.x) < FAR and abs(pose.y) < FAR and math.isfinite(pose.theta)
            and 0.0 <= size.x < FAR and 0.0 <= size.y < FAR):
        raise OddMessage(f'an obstacle of {size.x:g} x {size.y:g} m at {pose.x:g}, {pose.y:g} m, {pose.theta:g} rad: '
                         f'must be finite, within {FAR:g} m')
    return Obstacle(pose, size.x, size.y, marker.type == Marker.CYLINDER, not size.z > LASER_HEIGHT)


def _value(value: float) -> float:
    """A value; NaN if it is too large."""
    return value if abs(value) < MOST else math.nan


def _amount(value: float) -> float:
    """A value; NaN if it is negative or too large."""
    return value if 0.0 <= value < MOST else math.nan


def _share(value: float) -> float:
    """A share 0..1; NaN if it is none."""
    return min(value, 1.0) if 0.0 <= value <= 1.0 + ROUNDING else math.nan
