"""From the model to messages: pure functions."""

from rumba_msg.msg import BatteryStatus
from rumba_sim.model.battery import Battery
from rumba_sim.model.geometry import Pose


def battery_status(battery: Battery, pose: Pose, brushes_up: bool) -> BatteryStatus:
    """The lesson's message; its debug message tells what the battery does."""
    return BatteryStatus(
        percentage_battery=battery.percentage,
        location_x=pose.x,
        location_y=pose.y,
        orientation_theta=pose.theta,
        brushes_up=brushes_up,
        debug_message=_battery_in_words(battery))


def _battery_in_words(battery: Battery) -> str:
    if battery.percentage == 0:
        return 'battery empty'
    state = 'charging' if battery.current > 0.0 else 'discharging' if battery.current < 0.0 else 'resting'
    return f'{battery.voltage:.1f} V, {abs(battery.current):.2f} A, {state}'
