"""mapper: makes a map of a floor that the robot has never seen, and finds its place on that (SLAM).

It publishes
  /map            nav_msgs/OccupancyGrid: latched, as the map grows
  /tf             tf2_msgs/TFMessage: map -> odom, with the stamp of each scan
and below the robot's name
  amcl_pose       geometry_msgs/PoseWithCovarianceStamped: latched; the pose at each scan
  dock_pose       geometry_msgs/PoseStamped: latched; where the robot stood on the contacts of its dock
  key_frames      geometry_msgs/PoseArray: latched; with each /map, where the scans were taken that it shows; each keeps
                  its place in the array, so that it tells how the map moved if it was redrawn
It subscribes, below the robot's name, to
  scan            sensor_msgs/LaserScan: of a laser that is level, or upside down, where tf says on base_link
  odom            nav_msgs/Odometry
  bumper, cliff   rumba_msg/Bumper, Cliff: for what the laser does not see
  dock_status     rumba_msg/DockStatus
and to
  /tf_static, /tf tf2_msgs/TFMessage: where the laser is on base_link
and serves
  ~save_map       std_srvs/Trigger: writes the map, with the dock, to the file of the parameter map_file
It takes part in a lockstep by simulator/lockstep and simulator/lockstep_answers (rumba_msg/Lockstep, LockstepAnswer).

A simulator must leave map -> odom and /map to it: `rosrun rumba_sim simulator _localisation:=slam`.

Parameters, those of amcl and gmapping with their meaning, as in `rosrun rumba_localisation mapper _map_file:=a.yaml`:
"""

import dataclasses
from typing import Optional

import numpy as np
import rospy
from geometry_msgs.msg import PoseArray, PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import Header
from std_srvs.srv import Trigger, TriggerResponse

from rumba_localisation.mapping.findings import Findings
from rumba_localisation.mapping.grids import saving
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.ros import conversions
from rumba_localisation.ros.laser_settings import LaserSettings
from rumba_localisation.ros.scan_loop import COMPLAINT_PERIOD, QUEUE, ScanLoop
from rumba_localisation.scan import Reading, Scan
from rumba_msg.msg import Bumper, Cliff, DockStatus
from rumba_sim.model.common.config import part, setting
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.common.conversions import grid
from rumba_sim.ros.common.frames import MAP
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.common.own_robots import own_robot, own_robot_setting
from rumba_sim.ros.common.paths import absolute
from rumba_sim.ros.running import node

CALM = (False, False), (False,) * 4  # bumper and cliff sensors


@dataclasses.dataclass(frozen=True)
class Settings(MapperConfig, LaserSettings):
    """The node's private parameters."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    own_robot: str = own_robot_setting()
    initial_pose_x: float = setting(0.0, 'where the robot is at the first scan; this defines the map frame', 'm')
    initial_pose_y: float = setting(0.0, 'the same', 'm')
    initial_pose_a: float = setting(0.0, 'the same', 'rad')
    maxUrange: float = setting(0.0, 'a beam without an echo is free up to here, as for gmapping; 0: only as far as '
                                    'the echoes beside it, because lasers miss near things too', 'm', 0.0, 100.0)
    map_update_interval: float = setting(2.0, 'time between two publications of the map, at least', 's', 0.0, 3600.0)
    map_file: str = setting('rumba_map.yaml', 'path of the file to which ~save_map writes; its images go beside it')

    def __post_init__(self) -> None:
        """Check the robot's name."""
        check_names(self, 'robot')

    @property
    def reading(self) -> Reading:
        """How ranges are taken."""
        return super().reading._replace(usable=self.maxUrange)


def main() -> None:
    """Run the node."""
    node.run('mapper', Settings, lambda settings: MapperNode(settings).run(), is_single=True)


class MapperNode(ScanLoop):
    """The loop that owns the mapper."""

    def __init__(self, settings: Settings) -> None:
        """Open all topics and the service.

        Raises:
            ConfigError: the file of a robot that is not ours is wrong.
        """
        self._settings, own = settings, own_robot(settings.own_robot)
        self._mapper = Mapper(Pose(settings.initial_pose_x, settings.initial_pose_y, settings.initial_pose_a),
                              part(settings, MapperConfig))
        self._findings = Findings(RobotConfig() if own is None else own.config)
        self._bumper, self._cliffs = CALM
        self._is_docked = False
        self._dock: Optional[Pose] = None
        self._told: Optional[rospy.Time] = None  # stamp of the newest map that was published, and its version
        self._told_version = 0
        name = settings.robot
        self._map = rospy.Publisher('/map', OccupancyGrid, queue_size=1, latch=True)
        self._pose = rospy.Publisher(f'{name}/amcl_pose', PoseWithCovarianceStamped, queue_size=QUEUE, latch=True)
        self._docked = rospy.Publisher(f'{name}/dock_pose', PoseStamped, queue_size=1, latch=True)
        self._frames_told = rospy.Publisher(f'{name}/key_frames', PoseArray, queue_size=1, latch=True)
        super().__init__(name, settings.reading, own)
        self._subscribe(f'{name}/bumper', Bumper, self._take_bumper)
        self._subscribe(f'{name}/cliff', Cliff, self._take_cliff)
        self._subscribe(f'{name}/dock_status', DockStatus, self._take_dock)
        rospy.Service('~save_map', Trigger, lambda _: self._requests.call(self._save))

    def _take_bumper(self, message: Bumper) -> None:
        self._bumper = message.is_left_pressed, message.is_right_pressed

    def _take_cliff(self, message: Cliff) -> None:
        self._cliffs = (message.is_cliff_left, message.is_cliff_front_left, message.is_cliff_front_right,
                        message.is_cliff_right)

    def _take_dock(self, message: DockStatus) -> None:
        self._is_docked = message.is_docked

    def _use(self, scan: Scan, odometry: Pose, stamp: rospy.Time) -> None:
        mapper, redrawn = self._mapper, self._mapper.redrawn
        mapper.observe(odometry, scan)
        if mapper.redrawn > redrawn:
            self._follow(stamp)
        if mapper.estimate is None:
            return
        pose = mapper.pose(odometry)
        self._findings.note(mapper.grid, pose, self._bumper, self._cliffs)
        self._warn()
        self._correct(mapper.correction, stamp)
        header = Header(stamp=stamp, frame_id=MAP)
        self._pose.publish(conversions.pose_with_covariance(pose, mapper.estimate.covariance, header))
        if self._is_docked and self._dock is None:
            self._dock = pose
            self._tell_dock(pose, stamp)
        self._tell_map(stamp)

    def _warn(self) -> None:
        """Say what a person should know of the map."""
        mapper, name = self._mapper, self._settings.robot
        if mapper.is_lost:
            rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{name}: was carried away, and looks for its place on its map')
        if mapper.is_contradicted:
            rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{name}: scans and odometry show different movements: is '
                                                     'the laser where tf says, and does odom turn the right way?')
        if mapper.is_full:
            rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{name}: the map is as large as it can be: what lies farther '
                                                     'away is left out')

    def _follow(self, stamp: rospy.Time) -> None:
        """Move what was found on the map to where that is since the map was redrawn, and have that told at once."""
        self._told = None
        self._findings.move(self._mapper.moved)
        if self._dock is not None:
            self._dock = self._mapper.moved(self._dock)
            self._tell_dock(self._dock, stamp)

    def _tell_dock(self, dock: Pose, stamp: rospy.Time) -> None:
        self._docked.publish(PoseStamped(Header(stamp=stamp, frame_id=MAP), conversions.pose_message(*dock)))

    def _tell_map(self, stamp: rospy.Time) -> None:
        """Publish the map, if there is a newer one and the last one was published long enough ago."""
        is_due = self._told is None or not (
            rospy.Duration(0) <= stamp - self._told < rospy.Duration(self._settings.map_update_interval))
        if not is_due or self._version == self._told_version:
            return
        self._told, self._told_version = stamp, self._version
        plan = self._plan()
        cells = plan.occupancy if plan.cliff is None else np.where(plan.cliff, np.int8(OCCUPIED), plan.occupancy)
        self._frames_told.publish(conversions.cloud(np.array(self._mapper.frames), Header(stamp=stamp, frame_id=MAP)))
        self._map.publish(grid(plan, cells, stamp))

    @property
    def _version(self) -> int:
        return self._mapper.version + self._findings.version

    def _plan(self) -> FloorPlan:
        return self._mapper.plan('the map so far', self._dock, self._findings)

    def _save(self) -> TriggerResponse:
        path = absolute(self._settings.map_file)
        try:
            if self._mapper.estimate is None:
                raise MapError('there is no map yet: no scan came')
            saving.save(path, self._plan())
        except MapError as error:
            return TriggerResponse(False, str(error))
        return TriggerResponse(True, path)
