"""From the model to messages: pure functions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Dict, List, Optional, Sequence

from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from nav_msgs.msg import MapMetaData, OccupancyGrid
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Header

from rumba_msg.msg import BatteryStatus, CleaningStatus
from rumba_sim.model.common.geometry import Pose, half_angle, yaw
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.battery import CELLS, Battery
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.settings.robot_config import OdometryConfig
from rumba_sim.model.simulation.robot import Robot
from rumba_sim.ros.common.frames import MAP, WORLD, Frames

if TYPE_CHECKING:  # with numba and SciPy, they take longer to import than all the rest of battery_status_publisher
    from tf2_msgs.msg import TFMessage

    from rumba_sim.model.floors.floor import Floor
    from rumba_sim.model.maps.floor_plan import FloorPlan

LASER_HEIGHT = 0.07  # [m] of laser over base_link


def battery_status(battery: Battery, pose: Pose, brushes_up: bool, trouble: str = '') -> BatteryStatus:
    """The lesson's message; its debug message, for a person, is about the battery, or about a trouble."""
    return BatteryStatus(
        percentage_battery=battery.percentage,
        location_x=pose.x,
        location_y=pose.y,
        orientation_theta=pose.theta,
        brushes_up=brushes_up,
        debug_message=trouble or _battery_in_words(battery))


def _battery_in_words(battery: Battery) -> str:
    if battery.percentage == 0:
        return 'battery empty'
    state = 'charging' if battery.current > 0.0 else 'discharging' if battery.current < 0.0 else 'resting'
    return f'{battery.voltage:.1f} V, {abs(battery.current):.2f} A, {state}'


def trouble(robot: Robot) -> str:
    """What keeps a robot from going on, for a person; empty if nothing does."""
    if robot.has_fallen:
        return 'a wheel hangs over a cliff: teleport me'
    left, right = robot.bumper
    if left or right:
        return f'bumper pressed {"ahead" if left and right else "left" if left else "right"}'
    return ''


def battery_numbers(battery: Battery, is_docked: bool) -> Dict[str, float]:
    """What BatteryState has of a battery that changes, and is measured, by the names of its fields."""
    full = battery.state_of_charge >= 1.0
    status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    if is_docked:
        status = BatteryState.POWER_SUPPLY_STATUS_FULL if full else BatteryState.POWER_SUPPLY_STATUS_CHARGING
    health = BatteryState.POWER_SUPPLY_HEALTH_GOOD if battery.charge > 0.0 else BatteryState.POWER_SUPPLY_HEALTH_DEAD
    return {
        'voltage': battery.voltage, 'current': battery.current, 'charge': battery.charge,
        'capacity': battery.config.capacity, 'design_capacity': battery.config.capacity,
        'percentage': battery.state_of_charge, 'power_supply_status': status, 'power_supply_health': health,
        'power_supply_technology': BatteryState.POWER_SUPPLY_TECHNOLOGY_NIMH, 'present': True}


def battery_state(battery: Battery, is_docked: bool, header: Header) -> BatteryState:
    """The battery as sensor_msgs has it; what is not measured is NaN."""
    message = BatteryState(header=header, cell_voltage=[math.nan] * CELLS, location='base',
                           **battery_numbers(battery, is_docked))
    for unmeasured in {'temperature', 'cell_temperature'} & set(message.__slots__):
        setattr(message, unmeasured, [math.nan] * CELLS if unmeasured.startswith('cell') else math.nan)
    return message


def quaternion(theta: float) -> Quaternion:
    """A heading [rad] as a rotation about z."""
    return Quaternion(0.0, 0.0, *half_angle(theta))


def heading(rotation: Quaternion) -> float:
    """The angle about z [rad] of a rotation."""
    return yaw(rotation.x, rotation.y, rotation.z, rotation.w)


def plane_pose(pose: PoseMessage) -> Pose:
    """A pose in space as one in the plane."""
    return Pose(pose.position.x, pose.position.y, heading(pose.orientation))


def transform_pose(transform: Transform) -> Pose:
    """A transform as a pose in the plane."""
    return Pose(transform.translation.x, transform.translation.y, heading(transform.rotation))


def map_pose(message: TFMessage) -> Optional[Pose]:
    """Where the frame of a map that a robot makes is in the world; None if a message of /tf_static does not tell it."""
    return next((transform_pose(link.transform) for link in message.transforms
                 if (link.header.frame_id, link.child_frame_id) == (WORLD, MAP)), None)


def odometry_variance(distance: float, config: OdometryConfig, wheel_base: float) -> Sequence[float]:
    """Variance of position [m^2] and heading [rad^2] after a distance [m], by wrong scale and noise of the wheels."""
    wheel = (config.scale_error * distance) ** 2 + config.noise ** 2 * distance
    return 0.5 * wheel, 2.0 * wheel / wheel_base ** 2


def transform(frame: str, child: str, pose: Pose, stamp: object, height: float = 0.0) -> TransformStamped:
    """The pose of a child frame in a frame, for tf."""
    return TransformStamped(Header(stamp=stamp, frame_id=frame), child,
                            Transform(Vector3(pose.x, pose.y, height), quaternion(pose.theta)))


def static_transforms(frames: Frames, stamp: object, wheel_diameter: float,
                      laser: LaserConfig) -> List[TransformStamped]:
    """The parts of a robot that do not move against each other: base_link lies in the axle of its wheels [m]."""
    mounted = transform(frames.base_link, frames.laser, Pose(laser.x, laser.y, laser.yaw), stamp, LASER_HEIGHT)
    if laser.upside_down:  # by half a turn about its x axis before it is turned about z
        sin, cos = half_angle(laser.yaw)
        mounted.transform.rotation = Quaternion(cos, sin, 0.0, 0.0)
    return [transform(frames.base_footprint, frames.base_link, Pose(0.0, 0.0, 0.0), stamp, 0.5 * wheel_diameter),
            mounted]


def scan(ranges: Array, config: LaserConfig, period: float, header: Header) -> LaserScan:
    """Ranges (beams) [m] from the first beam of a laser on, all taken at the header's stamp."""
    return LaserScan(
        header=header, angle_min=config.first_angle,
        angle_max=config.first_angle + (len(ranges) - 1) * config.increment,
        angle_increment=config.increment, time_increment=0.0, scan_time=period, range_min=config.range_min,
        range_max=config.range_max, ranges=ranges.tolist(), intensities=[])


def cleaning_status(robot: Robot, floor: Floor, header: Header) -> CleaningStatus:
    """How much of the floor is swept, and what the robot did for it."""
    return CleaningStatus(header, floor.coverage, floor.cleaned_area, floor.reachable_area, floor.dirt_left,
                          robot.distance, robot.brush_time)


def grid(plan: FloorPlan, cells: Array, stamp: object, frame: str = MAP) -> OccupancyGrid:
    """Values (rows, columns) int8 on the cells of a plan in a frame: its occupancy, or what was swept."""
    left, bottom = plan.origin
    info = MapMetaData(map_load_time=stamp, resolution=plan.resolution, width=plan.columns, height=plan.rows,
                       origin=PoseMessage(Point(left, bottom, 0.0), quaternion(0.0)))
    # A list is packed several times faster than an array.
    return OccupancyGrid(Header(stamp=stamp, frame_id=frame), info, cells.ravel().tolist())
