"""The meaning of a BatteryStatus in words; imports no ROS, so that it can be used and tested without it."""

LOW = 20  # [%] at this charge and below, the robot should go home


def level(percentage):
    """Return one word for a charge [%]: empty, low, good or full."""
    if percentage <= 0:
        return 'empty'
    if percentage <= LOW:
        return 'low'
    return 'good' if percentage < 100 else 'full'


def describe(status):
    """Return one line for a rumba_msg/BatteryStatus, or for any object with its fields."""
    brushes = 'lifted' if status.brushes_up else 'on the floor'
    return f'{level(status.percentage_battery)}: {status.percentage_battery} %, brushes {brushes}'
