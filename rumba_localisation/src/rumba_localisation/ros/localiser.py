"""localiser: finds out where a robot is on a map, by its odometry and its laser (Monte Carlo localisation).

For each scan it publishes, with the stamp of that scan,
  /tf             tf2_msgs/TFMessage: map -> odom
and below the robot's name
  amcl_pose       geometry_msgs/PoseWithCovarianceStamped: latched; the covariance is large while it is not sure. While
                  no scan comes it is told by odometry alone, as often as that, with a covariance that grows on the
                  way; map -> odom stays as old as the newest scan then
  particlecloud   geometry_msgs/PoseArray: after each scan that it used
It subscribes to
  /map            nav_msgs/OccupancyGrid: which it publishes itself if its parameter map names a file
and below the robot's name to
  scan            sensor_msgs/LaserScan: of a laser that is level, or upside down, where tf says on base_link
  odom            nav_msgs/Odometry
  initialpose     geometry_msgs/PoseWithCovarianceStamped: where the robot is, by a person
and to
  /tf_static, /tf tf2_msgs/TFMessage: where the laser is on base_link
and serves, below the robot's name,
  global_localization       std_srvs/Empty: look for the place all over the map
  request_nomotion_update   std_srvs/Empty: use the next scan even if the robot has not moved
It takes part in a lockstep by simulator/lockstep and simulator/lockstep_answers (rumba_msg/Lockstep, LockstepAnswer).

A simulator must leave map -> odom to it: `rosrun rumba_sim simulator _localisation:=none`.

Parameters, those of amcl with the same meaning, as in `rosrun rumba_localisation localiser _initial_pose_x:=1.5`:
"""

import dataclasses
import math
from typing import Optional

import numpy as np
import rospy
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import Header
from std_srvs.srv import Empty, EmptyResponse

from rumba_localisation.localiser import Localiser
from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.ros import conversions
from rumba_localisation.ros.laser_settings import LaserSettings
from rumba_localisation.ros.scan_loop import COMPLAINT_PERIOD, QUEUE, ScanLoop
from rumba_localisation.scan import Scan
from rumba_sim.model.common.config import part, setting
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.ros.common.conversions import grid, plane_pose
from rumba_sim.ros.common.frames import MAP
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.common.own_robots import own_robot, own_robot_setting
from rumba_sim.ros.participants.maps import map_path
from rumba_sim.ros.running import node

HERE = Pose(0.0, 0.0, 0.0)


@dataclasses.dataclass(frozen=True)
class Settings(LocaliserConfig, LaserSettings):
    """The node's private parameters."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    own_robot: str = own_robot_setting()
    map: str = setting('', 'path of a map_server YAML file, which it publishes as /map; empty: another node does')
    robot_radius: float = setting(0.17425, 'radius of the robot: it is not looked for nearer to a wall', 'm', 0.0, 5.0)
    initial_pose_x: float = setting(math.nan, 'where it begins; without x and y it looks all over the map', 'm')
    initial_pose_y: float = setting(math.nan, 'the same', 'm')
    initial_pose_a: float = setting(0.0, 'the same', 'rad')
    seed: int = setting(1, 'seed of the random generator', '', 0, 2 ** 31 - 1)

    def __post_init__(self) -> None:
        """Check the robot's name, and that a start has both coordinates."""
        super().__post_init__()
        check_names(self, 'robot')
        if math.isnan(self.initial_pose_x) != math.isnan(self.initial_pose_y):
            raise ConfigError('initial_pose_x and initial_pose_y must be given together, or neither')

    @property
    def start(self) -> Optional[Pose]:
        """Where the robot begins; None if nobody says."""
        if math.isnan(self.initial_pose_x):
            return None
        return Pose(self.initial_pose_x, self.initial_pose_y, self.initial_pose_a)


def main() -> None:
    """Run the node."""
    node.run('localiser', Settings, lambda settings: LocaliserNode(settings).run(), is_single=True)


class LocaliserNode(ScanLoop):
    """The loop that owns the localiser."""

    def __init__(self, settings: Settings) -> None:
        """Open all topics and services.

        Raises:
            ConfigError: the file of a robot that is not ours is wrong.
            MapError: the map cannot be read.
        """
        self._settings, own = settings, own_robot(settings.own_robot)
        self._radius = settings.robot_radius if own is None else own.config.drive.radius
        self._plan: Optional[FloorPlan] = None  # turned so that its cells lie along its axes ...
        self._turned = HERE  # ... and the frame of that in the map frame
        self._localiser: Optional[Localiser] = None  # None until there are a map and a scan
        self._is_forced = False
        self._was_sure: Optional[bool] = None
        name = settings.robot
        self._pose = rospy.Publisher(f'{name}/amcl_pose', PoseWithCovarianceStamped, queue_size=QUEUE, latch=True)
        self._cloud = rospy.Publisher(f'{name}/particlecloud', PoseArray, queue_size=2)
        super().__init__(name, settings.reading, own)
        if settings.map:
            self._publish_map(map_file.load(map_path(settings.map)))
        self._subscribe('/map', OccupancyGrid, self._take_map)
        self._subscribe(f'{name}/initialpose', PoseWithCovarianceStamped, self._take_start)
        rospy.Service(f'{name}/global_localization', Empty, lambda _: self._requests.call(self._search_anywhere))
        rospy.Service(f'{name}/request_nomotion_update', Empty, lambda _: self._requests.call(self._force))

    def _publish_map(self, plan: FloorPlan) -> None:
        self._map = rospy.Publisher('/map', OccupancyGrid, queue_size=1, latch=True)
        self._map.publish(grid(plan, plan.occupancy, rospy.Time.now()))

    # --- what comes -------------------------------------------------------------------------------------------------

    def _take_map(self, message: OccupancyGrid) -> None:
        try:
            (self._plan, self._turned), self._localiser = conversions.turned_plan(message), None
        except MapError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f'{error}; ignored')
        self._look()

    def _take_start(self, message: PoseWithCovarianceStamped) -> None:
        """Believe a person, if that makes sense."""
        pose, covariance = plane_pose(message.pose.pose), conversions.covariance_of(message.pose)
        frame = message.header.frame_id.lstrip('/')
        if frame not in ('', MAP) or not all(map(math.isfinite, pose)) or not conversions.is_covariance(covariance):
            rospy.logerr_throttle(COMPLAINT_PERIOD, f'initialpose: must be a finite pose in the frame {MAP} with a '
                                                    'covariance; ignored')
        elif self._localiser is None:
            rospy.logerr_throttle(COMPLAINT_PERIOD, 'initialpose: there is no map or no scan yet; ignored')
        else:
            self._localiser.start_at(compose(inverse(self._turned), pose),
                                     conversions.turned(covariance, -self._turned.theta))
            self._force()

    def _search_anywhere(self) -> EmptyResponse:
        if self._localiser is not None:
            self._localiser.search_anywhere()
        return self._force()

    def _force(self) -> EmptyResponse:
        self._is_forced = True
        return EmptyResponse()

    # --- scans ------------------------------------------------------------------------------------------------------

    @property
    def _is_ready(self) -> bool:
        return self._plan is not None

    @property
    def _not_ready(self) -> str:
        return 'no map came on /map'

    def _use(self, scan: Scan, odometry: Pose, stamp: rospy.Time) -> None:
        assert self._plan is not None
        localiser = self._known(self._plan)
        is_used = localiser.observe(odometry, scan, self._is_forced)
        if localiser.estimate is None:
            return
        self._is_forced = self._is_forced and not is_used
        self._correct(compose(self._turned, localiser.correction), stamp)
        self._tell(localiser, odometry, stamp, is_used)
        self._say(localiser)

    def _known(self, plan: FloorPlan) -> Localiser:
        """The localiser, made with the first scan."""
        if self._localiser is None:
            settings = self._settings
            self._localiser = Localiser(plan, self._radius, self._range_max, part(settings, LocaliserConfig),
                                        settings.seed)
            if settings.start is not None:
                self._localiser.start_at(compose(inverse(self._turned), settings.start))
        return self._localiser

    def _reckon(self, odometry: Pose, stamp: rospy.Time) -> None:
        """Go by odometry alone while the laser is silent."""
        localiser = self._localiser
        if localiser is None or localiser.estimate is None:
            return
        rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{self._settings.robot}: the laser has been silent for '
                                                 f'{self._silence(stamp):.0f} s: goes by odometry alone')
        self._tell(localiser, odometry, stamp, localiser.observe(odometry, None))

    def _tell(self, localiser: Localiser, odometry: Pose, stamp: rospy.Time, has_moved: bool) -> None:
        """Publish the pose, and the particles if they have moved and somebody listens."""
        assert localiser.estimate is not None
        header = Header(stamp=stamp, frame_id=MAP)
        self._pose.publish(conversions.pose_with_covariance(
            compose(self._turned, localiser.pose(odometry)),
            conversions.turned(localiser.estimate.covariance, self._turned.theta), header))
        if has_moved and self._cloud.get_num_connections():
            particles = localiser.particles if self._turned == HERE else np.array(
                [compose(self._turned, Pose(*each)) for each in localiser.particles.tolist()])
            self._cloud.publish(conversions.cloud(particles, header))

    def _say(self, localiser: Localiser) -> None:
        """Tell a person when the robot finds its place, or loses it."""
        estimate = localiser.estimate
        if estimate is None or estimate.is_sure == self._was_sure:
            return
        x, y, theta = compose(self._turned, estimate.pose)
        if estimate.is_sure:
            rospy.loginfo(f'{self._settings.robot}: is at ({x:.2f}, {y:.2f}) m, heading {theta:.2f} rad; '
                          f'{100.0 * estimate.fit:.0f} % of the beams fit')
        else:
            rospy.logwarn(f'{self._settings.robot}: does not know where it is; {100.0 * estimate.fit:.0f} % of the '
                          'beams fit at the best place')
        self._was_sure = estimate.is_sure
