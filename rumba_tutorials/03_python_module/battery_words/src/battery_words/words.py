"""What a BatteryStatus means, in words; needs no ROS, so that it can be tested, and used, without."""

LOW = 20  # [%] and below: time to go home


def level(percentage):
    """One word for a charge [%]: empty, low, good or full."""
    if percentage <= 0:
        return 'empty'
    if percentage <= LOW:
        return 'low'
    return 'good' if percentage < 100 else 'full'


def describe(status):
    """One line for a rumba_msg/BatteryStatus, or whatever has its fields."""
    brushes = 'lifted' if status.brushes_up else 'on the floor'
    return f'{level(status.percentage_battery)}: {status.percentage_battery} %, brushes {brushes}'
