"""viewer: a window that shows a simulation of Rumbas, and lets a person drive, clean, dock, pause and reset.

It only listens to topics, so it can be opened, closed and opened twice while the simulation runs, on any machine.
F1 shows its keys. docs/viewer.md describes it.

Subscribes, for each robot that publishes a ground_truth, below its name:
  ground_truth     nav_msgs/Odometry          bumper           rumba_msg/Bumper
  battery_status   rumba_msg/BatteryStatus    battery_state    sensor_msgs/BatteryState
  cleaning_status  rumba_msg/CleaningStatus   mission_status   rumba_msg/MissionStatus
  cliff            rumba_msg/Cliff            clean/result     rumba_msg/CleanActionResult
  go_to/goal       rumba_msg/GoToActionGoal   clean/status     actionlib_msgs/GoalStatusArray
for the selected robot also
  coverage         nav_msgs/OccupancyGrid     scan             sensor_msgs/LaserScan, while the laser is shown
to /tf_static (tf2_msgs/TFMessage), /map (nav_msgs/OccupancyGrid) and simulator/state (rumba_msg/SimulatorState)
Publishes for the selected robot
  teleop/cmd_vel   geometry_msgs/Twist, while a key drives
Calls
  the actions clean, dock, undock and go_to of its cleaner; set_brushes_up and teleport of robots; pause, resume, step,
  reset and tuning/set_parameters of the simulator, below the name of its node
Serves
  ~save_png        std_srvs/Trigger, saves a picture of the window and answers with its path

Parameters, as in `rosrun rumba_viewer viewer _robot:=rumba2 _laser:=true`:
"""

import dataclasses
from typing import Any

import rospy

from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError, WorldError
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.common.teleop import ANGULAR_RANGE, LINEAR_RANGE
from rumba_sim.ros.running import node
from rumba_viewer.window import display

STYLES = ('auto', 'light', 'dark')


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    robot: str = setting('rumba', 'name of the robot that is selected at first')
    laser: bool = setting(False, 'whether the laser is shown at first')
    linear: float = setting(0.3, 'driving speed of the keys', 'm/s', *LINEAR_RANGE)
    angular: float = setting(1.5, 'turning speed of the keys', 'rad/s', *ANGULAR_RANGE)
    strategies: str = setting('', 'further cleaning strategies to offer, separated by commas')
    style: str = setting('auto', 'light, dark, or auto: that of the desktop')
    width: int = setting(1180, 'width of the window', 'pixels', 320, 10000)
    height: int = setting(720, 'height of the window', 'pixels', 240, 10000)
    folder: str = setting('', 'where pictures are saved; empty: ~/Pictures, or the home directory if there is none')
    save_png: str = setting('', 'path: save one picture there as soon as it is complete, and exit')
    where_possible: bool = setting(False, 'whether it is no error if no window can be opened')

    def __post_init__(self) -> None:
        """Check the name of the robot, of which names of topics are made, and the style."""
        check_names(self, 'robot')
        if self.style not in STYLES:
            raise ConfigError(f'style is {self.style!r}: must be one of {", ".join(STYLES)}')


def main() -> None:
    """Run the node."""
    viewer = Viewer()
    node.run('viewer', Settings, viewer.run, own_clock=True, before=viewer.open)


class Viewer:
    """The node; it imports Qt only if a window can be opened."""

    def __init__(self) -> None:
        """Do nothing yet."""
        self._trouble = ''
        self._application: Any = None

    def open(self) -> None:
        """Connect to the display, and show a window while there is no master."""
        with display.reached() as self._trouble:
            if not self._trouble:
                from rumba_viewer.ros.application import Application
                self._application = Application()
        if self._application is not None:
            self._application.wait_for_master()

    def run(self, settings: Settings) -> None:
        """Show the window until it is closed, or ROS shuts down.

        Raises:
            WorldError: no window can be opened, or the picture cannot be saved.
        """
        if settings.save_png:  # for this run only; but parameters outlive a node
            rospy.delete_param('~save_png')
        if not self._trouble:
            self._application.run(settings)
        elif settings.where_possible:
            rospy.loginfo(f'the simulation runs without a window: {self._trouble}')
        else:
            raise WorldError(f'no window: {self._trouble}')
