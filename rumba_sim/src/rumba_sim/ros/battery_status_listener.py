"""battery_status_listener: prints what a Rumba says of itself, one line that a terminal keeps up to date.

Where the output is no terminal (a pipe, a file), each message is a line of its own.

Subscribes:
  rumba/battery_status   rumba_msg/BatteryStatus

Parameters: none.
"""

import dataclasses
import math
import sys

import rospy

from rumba_msg.msg import BatteryStatus
from rumba_sim.ros.common import node
from rumba_sim.ros.common.terminal import TO_LINE_START_AND_ERASE, width


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node has no parameters."""


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
    """One line for a person: battery [%], place [m], heading [deg], brushes, and what the robot adds."""
    return (f'battery {status.percentage_battery:3d} %   at ({status.location_x:.2f}, {status.location_y:.2f}) m, '
            f'{math.degrees(status.orientation_theta):.0f} deg   brushes {"up" if status.brushes_up else "down"}   '
            f'{status.debug_message}')


def _show(line: str) -> None:
    if sys.stdout.isatty():
        print(TO_LINE_START_AND_ERASE + line[:width() - 1], end='', flush=True)
    else:
        print(line, flush=True)
