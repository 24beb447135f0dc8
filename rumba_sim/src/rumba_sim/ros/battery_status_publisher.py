"""battery_status_publisher: the node of the lesson. A Rumba that stands still while its battery drains.

Publishes:
  rumba/battery_status   rumba_msg/BatteryStatus, at ~rate, not latched: the message has no stamp, so it must be new
                         when it arrives

Parameters, as in `rosrun rumba_sim battery_status_publisher _rate:=10 _drain:=60`:
"""

import contextlib
import dataclasses
from typing import Optional

import rospy

from rumba_msg.msg import BatteryStatus
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.settings.battery import Battery, BatteryConfig
from rumba_sim.ros.common import conversions
from rumba_sim.ros.running import node

LEAP = 3600.0  # [s] from one message to the next: no time has passed, but the clock is another one


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    rate: float = setting(5.0, 'messages per second', 'Hz', low=0.01, high=1000.0)
    percentage: float = setting(100.0, 'charge at the start', '%', low=0.0, high=100.0)
    drain: float = setting(1.0, 'factor by which the battery drains faster than a real one', low=0.0, high=1e4)
    location_x: float = setting(0.0, 'x of the robot in the map frame', 'm')
    location_y: float = setting(0.0, 'y of the robot in the map frame', 'm')
    orientation_theta: float = setting(0.0, 'heading of the robot, counter-clockwise from the x axis', 'rad')
    brushes_up: bool = setting(False, 'whether the brushes are lifted; on the floor they draw current')


def main() -> None:
    """Run the node."""
    node.run('battery_status_publisher', Settings, publish)


def publish(settings: Settings) -> None:
    """Drain the battery and publish its state until ROS shuts down."""
    config = BatteryConfig(drain=settings.drain)
    battery = Battery(config, settings.percentage / 100.0)
    load = config.idle_current + (0.0 if settings.brushes_up else config.brush_current)
    pose = Pose(settings.location_x, settings.location_y, wrap_angle(settings.orientation_theta))
    publisher = rospy.Publisher('rumba/battery_status', BatteryStatus, queue_size=10)
    rate = rospy.Rate(settings.rate, reset=True)
    before = None
    while not rospy.is_shutdown():
        now = rospy.get_time()
        battery.step(passed(before, now), load)
        before = now
        publisher.publish(conversions.battery_status(battery, pose, settings.brushes_up))
        pause(rate)


def pause(rate: rospy.Rate) -> None:
    """Sleep until the next message is due."""
    with contextlib.suppress(TypeError):  # rospy has computed a time before 0: /clock went back while it did
        rate.sleep()


def passed(before: Optional[float], now: float) -> float:
    """The time that has passed between two times of ROS [s]; 0 if that is not known.

    Simulated time is 0 until the first message on /clock, which may begin anywhere. It begins again when a simulator or
    a recording does.
    """
    if not before or not 0.0 <= now - before < LEAP:
        return 0.0
    return now - before
