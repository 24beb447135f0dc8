"""The record of a mission as plain arrays, and the parts of its time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.stages import State

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

NAMES: Dict[int, str] = {state: state.name.lower().replace('_', ' ') for state in State}
JUMP = 0.5  # [m] from one pose to the next: somebody put the robot elsewhere, ...
FASTEST = 1.0  # [m/s] ... unless it can have driven there in that time; twice the speed of a Rumba
MOVING = 0.01  # [m/s] at a lower speed the robot stands or turns
BREAK = 2.0  # [s] shorter interruptions of docking or charging are ignored
FULL = 99.9  # [%]

Span = Tuple[float, float]


class Series(NamedTuple):
    """Samples in order of time: times (n,) [s], values (n,) or (n, k). Empty if nothing was recorded."""

    times: Floats
    values: Floats

    def at(self, time: Any) -> Any:
        """The values at times [s]: those of the last sample before each time, or of the first sample of all."""
        return self.values[np.maximum(np.searchsorted(self.times, time, side='right') - 1, 0)]


NOTHING = Series(np.zeros(0), np.zeros(0))


def series(times: Sequence[float], values: Any) -> Series:
    """Samples sorted by time, without those that are not finite."""
    if not len(times):
        return NOTHING
    stamps, samples = np.asarray(times, float), np.asarray(values, float)
    good = np.isfinite(stamps) & np.isfinite(samples.reshape(len(stamps), -1)).all(axis=1)
    order = np.argsort(stamps[good], kind='stable')
    return Series(stamps[good][order], samples[good][order])


class Grid(NamedTuple):
    """Cells of a nav_msgs/OccupancyGrid.

    Attributes:
        cells: int8 (rows, columns), row 0 at the bottom; -1: unknown.
        resolution: edge of a cell [m].
        left: x of the outer edge of column 0 [m].
        bottom: y of the outer edge of row 0 [m].
    """

    cells: NDArray[np.int8]
    resolution: float
    left: float
    bottom: float


class MissionState(NamedTuple):
    """The content of a rumba_msg/MissionStatus at a time [s]."""

    time: float
    state: int
    strategy: str
    message: str

    @property
    def name(self) -> str:
        """The state in words; its number if it is none of the known states."""
        return NAMES.get(self.state, f'state {self.state}')


@dataclass(frozen=True)
class MissionRecord:
    """A mission of one robot. Time 0 is the first pose or reading of the battery, whichever came first.

    Attributes:
        source: name of the recording.
        robot: name of the robot.
        path: x and y (n, 2) [m], map frame; not empty.
        charge: of the battery [%]; not empty.
        began: stamp of time 0 [s].
        power: into the battery [W], negative while it is used.
        charging: 1 while the battery is charged, else 0.
        docked: 1 while the contacts are closed, else 0.
        pressed: 1 while the bumper is pressed, else 0.
        fallen: 1 while a wheel hangs over a cliff, else 0.
        coverage: share of the floor that is swept [0..1].
        areas: swept, and within reach [m^2], at the end.
        dirt: share of the dirt that is left [0..1], at the end.
        target: share of the floor that the mission was to sweep [0..1].
        states: the mission's states, in order of time.
        floor: the map: 0 free, 100 wall.
        known: what the robot's own map shows in each cell of the map, likewise; None if the map is its own.
        swept: at the end: 100 swept, 0 missed, -1 out of reach.
        remarks: sentences about the recording for the reader.
        mates: the records of the other robots, without maps.
    """

    source: str
    robot: str
    path: Series
    charge: Series
    began: float = 0.0
    power: Series = NOTHING
    charging: Series = NOTHING
    docked: Series = NOTHING
    pressed: Series = NOTHING
    fallen: Series = NOTHING
    coverage: Series = NOTHING
    areas: Optional[Tuple[float, float]] = None
    dirt: Optional[float] = None
    target: float = CleaningConfig().target_coverage
    states: Sequence[MissionState] = ()
    floor: Optional[Grid] = None
    known: Optional[Grid] = None
    swept: Optional[Grid] = None
    remarks: Sequence[str] = field(default_factory=tuple)
    mates: Sequence[MissionRecord] = ()

    @property
    def duration(self) -> float:
        """Time from the first to the last pose or reading of the battery [s]."""
        return max(float(part.times[-1]) for part in (self.path, self.charge))


# --- parts of the time ----------------------------------------------------------------------------------------------

def spans(flags: Series) -> List[Span]:
    """When flags were 1: from the first sample that is 1 to the next that is 0; breaks up to BREAK are ignored."""
    found: List[Span] = []
    up = flags.values > 0.5
    edges = np.flatnonzero(np.diff(np.concatenate([[False], up, [False]]).astype(np.int8)))
    for first, after in zip(edges[::2], edges[1::2]):
        begin, end = float(flags.times[first]), float(flags.times[min(after, len(up) - 1)])
        if found and begin - found[-1][1] <= BREAK:
            begin = found.pop()[0]
        found.append((begin, end))
    return found


def rises(flags: Series) -> Floats:
    """Times [s] at which flags changed from 0 to 1; a first sample of 1 does not count."""
    up = flags.values > 0.5
    return flags.times[1:][up[1:] & ~up[:-1]]


def charging_spans(record: MissionRecord) -> List[Span]:
    """When the battery was charged: by its own status; else while docked and not full; else while its charge rose."""
    if len(record.charging.times):
        return spans(record.charging)
    if len(record.docked.times):
        times, docked = record.docked
        return spans(Series(times, docked * (record.charge.at(times) < FULL)))
    return _rising(record.charge)


def _rising(charge: Series) -> List[Span]:
    """Times in which a charge rose: from the last sample before a rise to the last sample of that rise."""
    found: List[Span] = []
    was_rising = False
    for before in np.flatnonzero(np.diff(charge.values)):
        is_rising = bool(charge.values[before + 1] > charge.values[before])
        if is_rising:
            begin = found.pop()[0] if was_rising else float(charge.times[before])
            found.append((begin, float(charge.times[before + 1])))
        was_rising = is_rising
    return found


def state_spans(record: MissionRecord) -> List[Tuple[float, float, MissionState]]:
    """Begin [s], end [s] and first message of each state, one after another."""
    changes = [state for index, state in enumerate(record.states)
               if index == 0 or state.state != record.states[index - 1].state]
    ends = [state.time for state in changes[1:]] + [max(record.duration, changes[-1].time)] if changes else []
    return [(state.time, end, state) for state, end in zip(changes, ends)]


def jumps(path: Series) -> NDArray[np.intp]:
    """Indices of the poses that the robot cannot have reached by driving from the pose before."""
    step, gap = steps(path)
    return np.flatnonzero((step > JUMP) & (step > FASTEST * gap)) + 1


def steps(path: Series) -> Tuple[Floats, Floats]:
    """Distance [m] and time [s] from each pose to the next."""
    return np.hypot(*np.diff(path.values, axis=0).T), np.diff(path.times)


def clock(seconds: float) -> str:
    """A time since the beginning [s] as h:mm:ss, rounded."""
    whole = max(int(round(seconds)), 0)
    return f'{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}'
