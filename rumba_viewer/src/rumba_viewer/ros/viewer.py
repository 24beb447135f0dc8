"""viewer: a window that shows a simulation of Rumbas, and lets a person drive, clean, dock, pause, reset.

It listens to topics, so it can be opened, closed and opened twice while the simulation runs, on any machine.
F1 shows its keys. docs/viewer.md tells more.

Subscribes, for each robot that publishes a ground_truth, below its name:
  ground_truth     nav_msgs/Odometry          bumper           rumba_msg/Bumper
  battery_status   rumba_msg/BatteryStatus    battery_state    sensor_msgs/BatteryState
  cleaning_status  rumba_msg/CleaningStatus   mission_status   rumba_msg/MissionStatus
for the selected one also
  coverage         nav_msgs/OccupancyGrid     scan             sensor_msgs/LaserScan, while the laser is shown
and to /map (nav_msgs/OccupancyGrid) and /diagnostics (diagnostic_msgs/DiagnosticArray)
Publishes for the selected robot
  cmd_vel          geometry_msgs/Twist, while a key drives
Calls
  the actions clean, dock, undock and go_to of its cleaner; set_brushes_up and teleport of robots; pause, resume, step,
  reset and tuning/set_parameters of the simulator
Serves
  ~save_png        std_srvs/Trigger, saves a picture of the window and answers with its path

Parameters, as in `rosrun rumba_viewer viewer _robot:=rumba2 _laser:=true`:
"""

import dataclasses
from typing import Any

import rospy

from rumba_sim.model.config import setting
from rumba_sim.model.errors import ConfigError, WorldError
from rumba_sim.ros.common import node
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.teleop_key import ANGULAR_RANGE, LINEAR_RANGE
from rumba_viewer.window import display

STYLES = ('auto', 'light', 'dark')


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    robot: str = setting('rumba', 'name of the robot to drive and to tell of, to begin with')
    laser: bool = setting(False, 'whether to show what the laser sees, to begin with')
    linear: float = setting(0.3, 'driving speed of the keys', 'm/s', *LINEAR_RANGE)
    angular: float = setting(1.5, 'turning speed of the keys', 'rad/s', *ANGULAR_RANGE)
    strategies: str = setting('', 'further cleaning strategies to offer, with commas between them')
    style: str = setting('auto', 'light, dark, or auto: as the desktop has it')
    width: int = setting(1180, 'of the window', 'pixels', 320, 10000)
    height: int = setting(720, 'of the window', 'pixels', 240, 10000)
    folder: str = setting('', 'where pictures are saved; empty: ~/Pictures, or home where there is none')
    save_png: str = setting('', 'path: save one picture there as soon as all is there to be seen, and end')
    where_possible: bool = setting(False, 'whether to end without complaint where no window can be opened')

    def __post_init__(self) -> None:
        """Names of topics are made of the robot's name, and a style is one of three."""
        check_names(self, 'robot')
        if self.style not in STYLES:
            raise ConfigError(f'style is {self.style!r}: must be one of {", ".join(STYLES)}')


def main() -> None:
    """Run the node."""
    viewer = Viewer()
    node.run('viewer', Settings, viewer.run, own_clock=True, before=viewer.open)


class Viewer:
    """The node; Qt is imported once it is known that a window can be opened."""

    def __init__(self) -> None:
        """Touch nothing yet."""
        self._trouble = ''
        self._application: Any = None

    def open(self) -> None:
        """Reach for the display, and wait in the window for a master."""
        with display.reached() as self._trouble:
            if not self._trouble:
                from rumba_viewer.ros.application import Application
                self._application = Application()
        if self._application is not None:
            self._application.wait_for_master()

    def run(self, settings: Settings) -> None:
        """Show the window until it is closed, or ROS shuts down.

        Raises:
            WorldError: no window can be opened, or the picture that was asked for cannot be saved.
        """
        if settings.save_png:  # an order for once; parameters outlive a node
            rospy.delete_param('~save_png')
        if not self._trouble:
            self._application.run(settings)
        elif settings.where_possible:
            rospy.loginfo(f'no window, the simulation goes on without: {self._trouble}')
        else:
            raise WorldError(f'no window: {self._trouble}')
