"""Obstacle files: YAML that names what stands or moves on a floor without being on its map; docs/obstacles.md."""

import math
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Tuple

from rumba_sim.model.common.config import nearest
from rumba_sim.model.common.errors import ConfigError, WorldError, quoted
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.common.name import check_name
from rumba_sim.model.common.yaml_file import read_mapping
from rumba_sim.model.simulation.obstacle import Obstacle, Stop, door, walk

SIZES = (0.005, 20.0)  # [m] of a radius, a length or a width
HEIGHTS = (0.001, 10.0)  # [m]
SPEEDS = (0.01, 5.0)  # [m/s]
TIMES = (0.0, 86400.0)  # [s] of a pause
MOVES = (0.1, 86400.0)  # [s] of a door
FAR = 1e9  # [m] the largest coordinate
MOST_WAYPOINTS = 1000
SHAPES = ('radius', 'size')
KINDS = {'pose': ('pose',), 'waypoints': ('waypoints', 'speed', 'loop', 'pause'),
         'closed': ('closed', 'open', 'closed_for', 'open_for', 'moves_for')}
KNOWN = ['height', *SHAPES, *(key for keys in KINDS.values() for key in keys)]


class _Limits(NamedTuple):
    """What numbers are allowed."""

    low: float
    high: float
    unit: str


def load(path: str) -> List[Obstacle]:
    """Read the obstacles of a file.

    Args:
        path: path of the YAML file.

    Raises:
        ConfigError: the file cannot be read, or an obstacle in it is wrong; the message begins with the path.
    """
    found = []
    for name, values in read_mapping(path, ConfigError).items():
        try:
            found.append(obstacle(name, values))
        except (ConfigError, WorldError) as error:
            raise ConfigError(f'{path}: {error}') from None
    return found


def obstacle(name: Any, values: Any) -> Obstacle:
    """An obstacle from its name and what a file says about it.

    Raises:
        WorldError: the name is not valid.
        ConfigError: a key is unknown, missing, or does not fit to the others, or a value is not allowed.
    """
    check_name(name)
    entries = _Entries(name, values)
    height = entries.number('height', _Limits(*HEIGHTS, 'm'))
    radius, length, width = 0.0, 0.0, 0.0
    if entries.one_of(SHAPES) == 'radius':
        radius = entries.number('radius', _Limits(*SIZES, 'm'))
    else:
        length, width = entries.numbers('size', _Limits(*SIZES, 'm'), '[length, width]')
    stops = _stops(entries)
    pose = stops[0].pose if stops else entries.pose('pose')
    return Obstacle(name, pose, height, radius, length, width, stops)


def _stops(entries: '_Entries') -> Tuple[Stop, ...]:
    kind = entries.one_of(tuple(KINDS))
    entries.allow_only(kind)
    if kind == 'waypoints':
        return walk(entries.waypoints(), entries.number('speed', _Limits(*SPEEDS, 'm/s')),
                    entries.has('loop') and entries.truth('loop'), *_pause(entries))
    if kind == 'closed':
        times = _Limits(*TIMES, 's')
        return door(entries.pose('closed'), entries.pose('open'), entries.number('closed_for', times),
                    entries.number('open_for', times), entries.number('moves_for', _Limits(*MOVES, 's')))
    return ()


def _pause(entries: '_Entries') -> Tuple[float, float]:
    if not entries.has('pause'):
        return 0.0, 0.0
    least, most = entries.numbers('pause', _Limits(*TIMES, 's'), '[shortest, longest]')
    if least > most:
        raise entries.wrong('pause', '[shortest, longest], in this order')
    return least, most


class _Entries:
    """What a file says about one obstacle; each method checks the value that it returns."""

    def __init__(self, name: str, values: Any) -> None:
        self._name = name
        if not isinstance(values, Mapping):
            raise ConfigError(f'{name} is {quoted(values)}: must be a mapping of {", ".join(KNOWN)}')
        self._values: Dict[Any, Any] = dict(values)
        for key in values:
            if key not in KNOWN:
                raise ConfigError(f'{name}/{key if isinstance(key, str) else quoted(key)} is unknown: '
                                  f'{nearest(key, KNOWN)}')

    def wrong(self, key: str, right: str) -> ConfigError:
        """The error about the value of a key, and what would be right."""
        if key not in self._values:
            return ConfigError(f'{self._name}/{key} is missing: must be {right}')
        return ConfigError(f'{self._name}/{key} is {quoted(self._values[key])}: must be {right}')

    def has(self, key: str) -> bool:
        """Whether there is a key."""
        return key in self._values

    def one_of(self, keys: Tuple[str, ...]) -> str:
        """The one key of several that is there."""
        there = [key for key in keys if key in self._values]
        if len(there) != 1:
            raise ConfigError(f'{self._name} has {" and ".join(there) or "none"} of {", ".join(keys)}: '
                              'must have one of them')
        return there[0]

    def allow_only(self, kind: str) -> None:
        """Check that there is no key that belongs to another kind of obstacle."""
        for other, keys in KINDS.items():
            for key in keys:
                if other != kind and key in self._values:
                    raise ConfigError(f'{self._name}/{key} belongs to {other}: an obstacle with {kind} has no {key}')

    def number(self, key: str, limits: _Limits) -> float:
        """A number within limits."""
        value = _number(self._values.get(key))
        if value is None or not limits.low <= value <= limits.high:
            raise self.wrong(key, f'{limits.low:g} to {limits.high:g} [{limits.unit}]')
        return value

    def numbers(self, key: str, limits: _Limits, names: str) -> Tuple[float, float]:
        """Two numbers within limits; `names` says which they are."""
        good = _numbers(self._values.get(key), limits)
        if len(good) != 2:
            raise self.wrong(key, f'{names}, each {limits.low:g} to {limits.high:g} [{limits.unit}]')
        return good[0], good[1]

    def truth(self, key: str) -> bool:
        """true or false."""
        value = self._values[key]
        if not isinstance(value, bool):
            raise self.wrong(key, 'true or false')
        return value

    def pose(self, key: str) -> Pose:
        """[x, y, yaw], or [x, y] with the yaw 0."""
        pose = _pose(self._values.get(key))
        if pose is None:
            raise self.wrong(key, '[x, y, yaw] in m, m, rad, or [x, y]')
        return pose

    def waypoints(self) -> List[Pose]:
        """A list of such poses."""
        values = self._values.get('waypoints')
        poses = [_pose(value) for value in values[:MOST_WAYPOINTS + 1]] if isinstance(values, list) else []
        good = [pose for pose in poses if pose is not None]
        if len(good) != len(poses) or not 2 <= len(good) <= MOST_WAYPOINTS:
            raise self.wrong('waypoints', f'2 to {MOST_WAYPOINTS} times [x, y, yaw] in m, m, rad, or [x, y]')
        return good


def _pose(value: Any) -> Optional[Pose]:
    good = _numbers(value, _Limits(-FAR, FAR, 'm'))
    return Pose(good[0], good[1], wrap_angle(good[2] if len(good) == 3 else 0.0)) if len(good) in (2, 3) else None


def _numbers(value: Any, limits: _Limits) -> List[float]:
    """The numbers of a list, at most four; none if one of them is not a number within limits."""
    numbers = [_number(each) for each in value[:4]] if isinstance(value, list) else []
    good = [number for number in numbers if number is not None and limits.low <= number <= limits.high]
    return good if len(good) == len(numbers) else []


def _number(value: Any) -> Optional[float]:
    """The value as a finite number; else None."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None
