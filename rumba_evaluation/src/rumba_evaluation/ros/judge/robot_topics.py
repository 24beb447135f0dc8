"""The topics of a robot by which conditions are judged, and what comes on them with each tick."""

from typing import Any, Callable, Dict, List, Tuple, Type

from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState

from rumba_evaluation.verdicts import conditions
from rumba_evaluation.verdicts.conditions import Condition
from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, DockStatus, Lockstep
from rumba_sim.ros.common import conversions

PLACE, CLEANING = 'ground_truth', 'cleaning_status'
Value = Callable[[Any], Any]
TOPICS: Dict[Type[Condition], List[Tuple[str, Any, Value]]] = {
    conditions.Coverage: [(CLEANING, CleaningStatus, lambda message: message.coverage)],
    conditions.Reach: [(PLACE, Odometry, lambda message: conversions.plane_pose(message.pose.pose))],
    conditions.Docked: [('dock_status', DockStatus, lambda message: message.is_docked)],
    conditions.Collisions: [
        ('bumper', Bumper, lambda message: message.is_left_pressed or message.is_right_pressed)],
    conditions.Battery: [
        ('battery_state', BatteryState, lambda message: 100.0 * message.percentage),
        ('battery_status', BatteryStatus, lambda message: float(message.percentage_battery))],
}
WITH_TICKS = (PLACE, 'dock_status', 'bumper', 'cliff', 'battery_state')  # sent with each control tick


def stamps(tick: Lockstep) -> Dict[str, float]:
    """Stamps [s] of the newest messages that were sent before a tick, by topic."""
    found = {**dict.fromkeys(WITH_TICKS, tick.header.stamp), CLEANING: tick.cleaning, 'odom': tick.odom,
             'scan': tick.scan}
    return {topic: stamp.to_sec() for topic, stamp in found.items()}
