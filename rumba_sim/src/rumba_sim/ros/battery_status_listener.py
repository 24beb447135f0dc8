"""battery_status_listener: prints the BatteryStatus of a Rumba as one line that stays up to date.

If the output is not a terminal (a pipe, a file), it prints one line for each message.

Subscribes:
  rumba/battery_status   rumba_msg/BatteryStatus

Parameters: none.
"""

import dataclasses
import math
import sys

import rospy

from rumba_msg.msg import BatteryStatus
from rumba_sim.model.common.errors import one_line
from rumba_sim.ros.running import node
from rumba_sim.ros.running.terminal import TO_LINE_START_AND_ERASE, width


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters: none."""


def main() -> None:
    """Run the node."""
    node.run('battery_status_listener', Settings, listen)


def listen(_: Settings) -> None:
    """Print each message, until ROS shuts down."""
    subscriber = rospy.Subscriber('rumba/battery_status', BatteryStatus, lambda status: _show(describe(status)))
    _show(f'waiting for {subscriber.resolved_name}')
    rospy.spin()
    if sys.stdout.isatty():
        print()


def describe(status: BatteryStatus) -> str:
    """One line for a person: battery [%], position [m], heading [deg], brushes, and the message of the robot."""
    return (f'battery {status.percentage_battery:3d} %   at ({status.location_x:.2f}, {status.location_y:.2f}) m, '
            f'{math.degrees(status.orientation_theta):.0f} deg   brushes {"up" if status.brushes_up else "down"}   '
            f'{one_line(status.debug_message)}')


def _show(line: str) -> None:
    if sys.stdout.isatty():
        print(TO_LINE_START_AND_ERASE + line[:width() - 1], end='', flush=True)
    else:
        print(line, flush=True)
