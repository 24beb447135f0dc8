"""Makes the record of a mission from the messages of one robot in a bag; times are those of the robot's clock."""

import math
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np
import rosbag
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import BatteryState

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_evaluation.report.mission_record import NOTHING, Grid, MissionRecord, MissionState, Series, series

FAR = 1e7  # [m] larger coordinates are not valid
FAR_OFF = 60.0  # [s] a stamp so long before or after all of the robot's clock is of another clock, or latched
BACK = 1.0  # [s] if stamps go back farther, the clock was reset
FINEST = 1e-4  # [m] smallest edge of a cell
GRIDS = 200  # about as many are read for the curve of the coverage
UPRIGHT = 1e-3  # largest z of the quaternion of a grid that is not rotated
GRID = 'nav_msgs/OccupancyGrid'

Topics = Dict[str, List[str]]  # the topics in the bag, by their name relative to the robot


def _position(x: float, y: float) -> Tuple[float, float]:
    return (x, y) if abs(x) < FAR and abs(y) < FAR else (math.nan, math.nan)


def _battery(message: BatteryState) -> Sequence[float]:
    """Charge [%], power [W], whether it is charging, whether it is docked."""
    status = message.power_supply_status
    is_docked = status in (BatteryState.POWER_SUPPLY_STATUS_CHARGING, BatteryState.POWER_SUPPLY_STATUS_FULL)
    is_charging = status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    is_known = status != BatteryState.POWER_SUPPLY_STATUS_UNKNOWN
    return (100.0 * message.percentage, message.voltage * message.current,
            *((float(is_charging), float(is_docked)) if is_known else (math.nan, math.nan)))


# The type of each topic, and the values that are read of a message. Not coverage: most of its messages are skipped.
ROWS: Dict[str, Tuple[str, Callable[[Any], Sequence[Any]]]] = {
    'ground_truth': ('nav_msgs/Odometry', lambda m: _position(m.pose.pose.position.x, m.pose.pose.position.y)),
    'battery_status': ('rumba_msg/BatteryStatus', lambda m: (
        m.percentage_battery, *_position(m.location_x, m.location_y))),
    'battery_state': ('sensor_msgs/BatteryState', _battery),
    'bumper': ('rumba_msg/Bumper', lambda m: (m.is_left_pressed or m.is_right_pressed,)),
    'cliff': ('rumba_msg/Cliff', lambda m: (m.is_wheel_dropped,)),
    'dock_status': ('rumba_msg/DockStatus', lambda m: (m.is_docked,)),
    'cleaning_status': ('rumba_msg/CleaningStatus', lambda m: (
        m.coverage, m.cleaned_area, m.reachable_area, m.dirt)),
    'mission_status': ('rumba_msg/MissionStatus', lambda m: (m.state, m.strategy, m.message)),
    'clean/goal': ('rumba_msg/CleanActionGoal', lambda m: (m.goal.target_coverage,))}
TYPES = {**{name: kind for name, (kind, _) in ROWS.items()}, 'coverage': GRID}
CLOCKS = ('ground_truth', 'battery_state', 'bumper', 'cliff', 'dock_status', 'cleaning_status')  # never latched
STARTS = ('ground_truth', 'battery_status', 'battery_state')


class Samples(NamedTuple):
    """The messages of a topic in the order of recording: time of recording [s], stamp [s], and values of each."""

    recorded: List[float]
    stamps: List[float]
    rows: List[Sequence[Any]]


NONE = Samples([], [], [])


class RecordedRobot:
    """The messages of a robot in a bag; grids are read when they are needed.

    Times are those of the robot's clock, and count from its first pose or reading of the battery.
    """

    def __init__(self, bag: rosbag.Bag, topics: Topics) -> None:
        """Read the topics of a robot."""
        self._bag = bag
        self._topics = topics
        self._samples = {name: Samples([], [], []) for name in topics if name in ROWS}
        names = {topic: name for name in self._samples for topic in topics[name]}
        self._publishers: Dict[str, Set[str]] = {topic: set() for topic in names}

        def is_read(topic: str, kind: str, _: str, __: str, header: Dict[str, bytes]) -> bool:
            if kind == TYPES[names[topic]]:
                self._publishers[topic].add(header.get('callerid', b'').decode(errors='replace'))
            return kind == TYPES[names[topic]]
        for topic, message, time in bag.read_messages(list(names), connection_filter=is_read):
            recorded, stamps, rows = self._samples[names[topic]]
            recorded.append(time.to_sec())
            stamps.append(message.header.stamp.to_sec() if hasattr(message, 'header') else 0.0)
            rows.append(ROWS[names[topic]][1](message))
        self._clock = next((self._samples[name] for name in CLOCKS if any(self._samples.get(name, NONE).stamps)), NONE)
        self._was_set_back = bool((np.diff(self._clock.stamps) < -BACK).any())
        if self._was_set_back:
            self._clock = NONE
        self._began = 0.0
        self._began = min((float(self._times(name).min()) for name in STARTS if name in self._samples), default=0.0)

    # --- time -------------------------------------------------------------------------------------------------------

    def _on_clock(self, recorded: Sequence[float]) -> Any:
        """Times of recording [s] as times of the robot's clock, by the stamps that were recorded before and after."""
        times = _spread(recorded)
        if self._clock is not NONE:
            marks, stamps = _spread(self._clock.recorded), np.maximum.accumulate(self._clock.stamps)
            span = marks[-1] - marks[0]
            rate = (stamps[-1] - stamps[0]) / span if span > 0.0 else 1.0
            beyond = np.minimum(times - marks[0], 0.0) + np.maximum(times - marks[-1], 0.0)
            times = np.interp(times, marks, stamps) + rate * beyond
        return times - self._began

    def _on_time(self, recorded: Sequence[float], stamps: Sequence[float]) -> Any:
        """Times of messages: their stamps, if these are of the robot's clock, else as _on_clock.

        How late a message was recorded says nothing about its stamp: the recorder's own clock can be seconds behind.
        """
        times, own = self._on_clock(recorded), np.array(stamps)
        if self._clock is NONE:
            return times
        first, last = min(self._clock.stamps), max(self._clock.stamps)
        is_own = (own > 0.0) & (first - FAR_OFF < own) & (own < last + FAR_OFF)
        return np.where(is_own, own - self._began, times)

    def _times(self, topic: str) -> Any:
        recorded, stamps, _ = self._samples[topic]
        return self._on_time(recorded, stamps)

    # --- values -----------------------------------------------------------------------------------------------------

    def _column(self, topic: str, *columns: int) -> Series:
        """Columns of the rows of a topic, without rows that are not finite; empty if there are none."""
        rows = self._samples.get(topic, NONE).rows
        if not rows:
            return NOTHING
        found = series(self._times(topic), [[row[column] for column in columns] for row in rows])
        return found if len(columns) > 1 else Series(found.times, found.values[:, 0])

    def _path(self) -> Series:
        """Positions x and y (n, 2) [m]."""
        return _first(self._column('ground_truth', 0, 1), self._column('battery_status', 1, 2))

    def _charge(self) -> Series:
        """Charge of the battery [%]."""
        return _first(self._column('battery_state', 0), self._column('battery_status', 0))

    def _states(self) -> List[MissionState]:
        samples = self._samples.get('mission_status', NONE)
        times = self._times('mission_status').tolist() if samples.rows else []
        return sorted((MissionState(max(time, 0.0), *row) for time, row in zip(times, samples.rows)),
                      key=lambda state: state.time)

    def _grids(self, topics: Sequence[str], most: int) -> Iterator[Tuple[float, Grid]]:
        """About `most` of the grids of topics, always with the last one, with their times [s]."""
        count = self._bag.get_message_count(list(topics)) if topics else 0
        for index, (_, raw, time) in enumerate(self._bag.read_messages(list(topics), raw=True) if count else []):
            if (count - 1 - index) % -(-count // most) == 0 and raw[0] == GRID:
                message = raw[-1]()
                message.deserialize(raw[1])
                cells = grid_of(message)
                if cells is not None:
                    yield float(self._on_time([time.to_sec()], [message.header.stamp.to_sec()])[0]), cells

    def record(self, source: str, name: str, floor: Optional[Grid], known: Optional[Grid], remarks: Sequence[str],
               target: float) -> MissionRecord:
        """The record of the mission on a map; path and charge can be empty.

        A target of 0 is that of the last goal that names one, or else the cleaner's default.
        """
        remarks = list(remarks)
        remarks += [f'{topic} was published by {" and ".join(sorted(nodes))}: the figures mix their messages.'
                    for topic, nodes in self._publishers.items() if len(nodes) > 1]
        if self._was_set_back:
            remarks.append('The clock was set back during the recording: times are those of the recorder.')
        coverage, areas, swept = self._cleaning()
        dirt = self._column('cleaning_status', 3).values
        return MissionRecord(
            source=source, robot=name, path=self._path(), charge=self._charge(), began=self._began,
            power=self._column('battery_state', 1), charging=self._column('battery_state', 2),
            docked=_first(self._column('dock_status', 0), self._column('battery_state', 3)),
            pressed=self._column('bumper', 0), fallen=self._column('cliff', 0), coverage=coverage,
            areas=areas, dirt=float(dirt[-1]) if len(dirt) else None, target=target or self._target(),
            states=self._states(), floor=floor, known=known, swept=swept,
            remarks=remarks)

    def _target(self) -> float:
        """The share of the floor that the last goal asked for [0..1]."""
        goals = [target for target, in self._samples.get('clean/goal', NONE).rows if 0.0 < target <= 1.0]
        return float(goals[-1]) if goals else CleaningConfig().target_coverage

    def _cleaning(self) -> Tuple[Series, Optional[Tuple[float, float]], Optional[Grid]]:
        """Coverage [0..1], areas swept and within reach [m^2], last grid; without cleaning_status from the grids."""
        status = self._column('cleaning_status', 0, 1, 2)
        grids = list(self._grids(self._topics.get('coverage', []), 1 if len(status.times) else GRIDS))
        last = grids[-1][1] if grids else None
        if len(status.times):
            swept, reachable = status.values[-1, 1:].tolist()
            return Series(status.times, status.values[:, 0]), (swept, reachable), last
        if last is None:
            return NOTHING, None, None
        counts = [(0.01 * np.clip(cells.cells, 0, 100).sum(), np.count_nonzero(cells.cells >= 0)) for _, cells in grids]
        coverage = series([time for time, _ in grids], [part / max(whole, 1) for part, whole in counts])
        area = last.resolution ** 2
        return coverage, (counts[-1][0] * area, counts[-1][1] * area), last


def _spread(recorded: Sequence[float]) -> Any:
    """Times of recording [s], in order; messages with the same time are spread evenly until the next one.

    A recorder whose clock advances in steps gives one time to all that it gets in between.
    """
    times = np.asarray(recorded, float)
    steps, firsts = np.unique(times, return_index=True)
    if not 1 < len(steps) < len(times):
        return times
    last = steps[-1] + (len(times) - firsts[-1]) * (steps[-1] - steps[0]) / firsts[-1]
    return np.interp(np.arange(len(times)), [*firsts, len(times)], [*steps, last])


def _first(*choices: Series) -> Series:
    """The first series that is not empty."""
    return next((choice for choice in choices if len(choice.times)), NOTHING)


def grid_of(message: OccupancyGrid) -> Optional[Grid]:
    """The cells of a message; None if they are rotated against the axes, or their number or position is not valid."""
    info, origin = message.info, message.info.origin
    is_valid = (0 < info.width * info.height == len(message.data) and FINEST < info.resolution < FAR
                and abs(origin.position.x) < FAR and abs(origin.position.y) < FAR)
    if not is_valid or not abs(origin.orientation.z) < UPRIGHT:
        return None
    cells = np.array(message.data, np.int8).reshape(info.height, info.width)
    return Grid(cells, info.resolution, origin.position.x, origin.position.y)
