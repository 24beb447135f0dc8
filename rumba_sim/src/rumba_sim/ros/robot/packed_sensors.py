"""What a robot senses at each control tick, as packed messages."""

import math
from typing import Sequence

import rospy
from std_msgs.msg import Header

from rumba_msg.msg import Bumper, Cliff, DockStatus
from rumba_sim.model.settings.battery import Battery, BatteryConfig
from rumba_sim.model.simulation.robot import Infrared, Robot
from rumba_sim.ros.common import conversions
from rumba_sim.ros.robot.packed import NumbersPacker


class SensorPackers:
    """Makes the messages of one robot."""

    def __init__(self, frame: str) -> None:
        """Tell what is sensed in a frame."""
        header = Header(frame_id=frame)
        self._battery = NumbersPacker(conversions.battery_state(Battery(BatteryConfig(), 1.0), False, header))
        self._bumper, self._cliff, self._dock = (
            NumbersPacker(kind(header=header)) for kind in (Bumper, Cliff, DockStatus))

    def battery_state(self, robot: Robot, stamp: rospy.Time) -> rospy.AnyMsg:
        """The battery, as `conversions.battery_state`."""
        numbers = conversions.battery_numbers(robot.battery, robot.is_docked)
        return self._battery.message(stamp, *(numbers.get(name, math.nan) for name in self._battery.names))

    def bumper(self, robot: Robot, stamp: rospy.Time) -> rospy.AnyMsg:
        """The contact switches."""
        return self._bumper.message(stamp, *robot.bumper)

    def cliff(self, robot: Robot, cliffs: Sequence[bool], stamp: rospy.Time) -> rospy.AnyMsg:
        """The floor sensors, from left to right, and the wheels of a robot."""
        return self._cliff.message(stamp, *cliffs, robot.has_fallen)

    def dock_status(self, robot: Robot, infrared: Infrared, stamp: rospy.Time) -> rospy.AnyMsg:
        """Contacts and infrared beams."""
        return self._dock.message(stamp, any(infrared), robot.is_docked, infrared.omni, infrared.left, infrared.right)
