"""A made-up mission of 36 s as a bag: once around a rectangle of 4 m by 2 m, and back to the dock to charge.

    0 s   on the dock at (1, 1), fully charged
    2 s   leaves the dock, counter-clockwise at 0.5 m/s: 12 m; 3 bumps; the charge falls to 8 %
   15 s   a wheel hangs over a cliff for 1 s
   26 s   on the dock: the charge rises to 58 %
   36 s   the end; 90 % of 20 m^2 are swept
"""

import math

import genpy
import numpy as np
import rosbag
from nav_msgs.msg import OccupancyGrid, Odometry
from sensor_msgs.msg import BatteryState

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_record import Grid, MissionRecord, MissionState, series
from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, Cliff, DockStatus, MissionStatus

START = 100.0  # [s] stamp of the first message
OFF, HOME, END = 2.0, 26.0, 36.0
STATES = ((0.0, State.IDLE), (2.0, State.UNDOCKING), (3.0, State.CLEANING), (20.0, State.RETURNING),
          (24.0, State.DOCKING), (26.0, State.CHARGING), (36.0, State.IDLE))
SWEPT = np.array([[100, 100, 0], [-1, 100, -1]])
FLOOR = np.array([[0, 0, 0, 100], [100, 0, 100, -1], [-1, -1, -1, -1]])


def position(t):
    """Where the robot is [m]."""
    driven = 0.5 * min(max(t - OFF, 0.0), HOME - OFF)
    x, y = ((driven, 0.0) if driven < 4.0 else (4.0, driven - 4.0) if driven < 6.0
            else (10.0 - driven, 2.0) if driven < 10.0 else (0.0, 12.0 - driven))
    return 1.0 + x, 1.0 + y


def charge(t):
    """Charge of the battery [%]."""
    return 100.0 - 92.0 * min(max(t - OFF, 0.0) / (HOME - OFF), 1.0) + 5.0 * max(t - HOME, 0.0)


def grid(cells, resolution=0.5):
    """Cells as a message, the lower left corner at (-1, 2) m."""
    message = OccupancyGrid(data=cells.ravel().tolist())
    message.info.height, message.info.width = cells.shape
    message.info.resolution = resolution
    message.info.origin.position.x, message.info.origin.position.y = -1.0, 2.0
    message.info.origin.orientation.w = 1.0
    return message


def ground_truth(t):
    """Every 0.1 s."""
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = position(t)
    return message


def battery_state(t):
    """Every 0.1 s: 15 V, 2 A out of the battery while it drives, 1 A into it at the end."""
    is_off, is_charging = OFF <= t < HOME, t >= HOME
    status = (BatteryState.POWER_SUPPLY_STATUS_DISCHARGING if is_off
              else BatteryState.POWER_SUPPLY_STATUS_CHARGING if is_charging else BatteryState.POWER_SUPPLY_STATUS_FULL)
    return BatteryState(percentage=0.01 * charge(t), voltage=15.0, current=-2.0 if is_off else float(is_charging),
                        power_supply_status=status)


def battery_status(t):
    """Every 0.2 s; the debug message is never read."""
    x, y = position(t)
    return BatteryStatus(percentage_battery=math.ceil(charge(t) - 1e-6), location_x=x, location_y=y,
                         debug_message='a wheel hangs over a cliff')


def bumper(t):
    """Every 0.1 s: pressed in the first message, and three times later, once first left and then right."""
    return Bumper(is_left_pressed=t < 0.3 or 5.0 <= t < 5.4 or 10.0 <= t < 10.2,
                  is_right_pressed=5.4 <= t < 5.6 or 10.0 <= t < 10.2 or 20.0 <= t < 20.15)


def mission_status(t):
    """Every second."""
    state = max((begin, state) for begin, state in STATES if begin <= t)[1]
    return MissionStatus(state=state, strategy='spiral' if t >= OFF else '',
                         message='90.0 % swept <&>' if t >= END else 'working' if t >= 3.0 else '')


TOPICS = {  # by topic: period [s], and a function that makes the message of a time
    'ground_truth': (0.1, ground_truth), 'battery_state': (0.1, battery_state), 'battery_status': (0.2, battery_status),
    'bumper': (0.1, bumper), 'cliff': (0.1, lambda t: Cliff(is_wheel_dropped=15.0 <= t < 16.0)),
    'dock_status': (0.1, lambda t: DockStatus(is_docked=not OFF <= t < HOME)),
    'cleaning_status': (1.0, lambda t: CleaningStatus(
        coverage=t / 40.0, cleaned_area=t / 2.0, reachable_area=20.0, dirt=1.0 - t / 48.0)),
    'mission_status': (1.0, mission_status),
    'coverage': (1.0, lambda t: grid(SWEPT if t >= END else np.where(SWEPT == 100, 0, SWEPT)))}
ALL = tuple(TOPICS)
LEAST = ('ground_truth', 'battery_state')  # enough for a report
EVENTS = [  # of the mission, as a report tells them
    (0.0, 'The recording begins at (1.00, 1.00) m, battery 100 %.'),
    (2.0, 'Left the dock, battery 100 %.'),
    (3.0, 'Mission: cleaning (spiral)'),
    (5.0, 'Bump at (2.50, 1.00) m.'),
    (10.0, 'Bump at (5.00, 1.00) m.'),
    (15.0, 'A wheel hangs over a cliff at (4.50, 3.00) m.'),
    (20.0, 'Mission: returning'),
    (20.0, 'Bump at (2.00, 3.00) m.'),
    (25.5, 'Battery below 10 %.'),
    (26.0, 'Docked and charging, battery 8 %.'),
    (36.0, 'The mission ends: 90.0 % swept <&>'),
    (36.0, 'The recording ends at (1.00, 1.00) m, battery 58 %.')]


def without(*names):
    """All topics except some."""
    return [name for name in ALL if name not in names]


def recorded(t):
    """Time of a recorder that uses the clock of the simulation."""
    return START + t


def recorded_by_the_wall(t):
    """Time of a recorder that uses the wall clock, while the simulation is ten times faster."""
    return 1.7e9 + 0.1 * t


def write(path, topics=ALL, namespace='/rumba', when=recorded, until=END, maps=('/map',), change=None):
    """Write a bag; returns its path.

    Args:
        path: of the bag.
        topics: names below the namespace.
        namespace: of the robot.
        when: gives the time of recording for a time of the mission [s].
        until: time of the last message [s].
        maps: topics of the map.
        change: called with the name of a topic, a message and its time, before the message is written.
    """
    with rosbag.Bag(str(path), 'w') as bag:
        for topic in maps:
            bag.write(topic, grid(FLOOR), genpy.Time.from_sec(when(0.0)))
        add(bag, topics, namespace, when, until, change)
    return str(path)


def add(bag, topics=ALL, namespace='/rumba', when=recorded, until=END, change=None):
    """Write a robot's topics to a bag."""
    for name in topics:
        period, make = TOPICS[name]
        for tick in range(int(round(until / period)) + 1):
            t = round(tick * period, 6)
            message = make(t)
            if hasattr(message, 'header'):
                message.header.stamp = genpy.Time.from_sec(START + t)
            if change is not None:
                change(name, message, t)
            bag.write(f'{namespace}/{name}', message, genpy.Time.from_sec(when(t)))


# --- without a bag ---------------------------------------------------------------------------------------------------

CORNERS = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 3.0]])  # differs from all its mirror images and rotations


def record(**changes):
    """A record of 100 s in which every part has values."""
    parts = dict(
        source='/some/where/a.bag', robot='rumba', path=series([0, 40, 60, 100], CORNERS),
        charge=series([0, 100], [100, 50]), power=series([0, 100], [-36, -36]),
        charging=series([0, 10, 20, 30, 40], [0, 1, 0, 1, 0]), docked=series([0, 10, 20], [0, 1, 0]),
        pressed=series([0, 50, 51, 70, 71], [0, 1, 0, 1, 0]), coverage=series([0, 50, 100], [0.1, 0.3, 0.9]),
        states=[MissionState(0.0, State.CLEANING, 'spiral', ''),
                MissionState(80.0, State.STRANDED, 'spiral', 'the <end> & more')],
        areas=(9.0, 10.0), floor=Grid(np.array([[0, 0, 100], [0, -1, -1]], np.int8), 1.0, 0.0, 0.0),
        swept=Grid(np.array([[100, 0, -1]], np.int8), 1.0, 0.0, 0.0))
    return MissionRecord(**{**parts, **changes})
