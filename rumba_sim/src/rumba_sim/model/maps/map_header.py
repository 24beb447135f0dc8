"""The YAML file of a map: its keys, each checked; docs/maps.md has them in one table.

Keys of map_server: image, resolution [m/pixel], origin [x, y, yaw] of the lower left corner, negate,
occupied_thresh, free_thresh, mode (trinary, scale or raw). Optional keys of Rumba: dock and start, each
[x, y, theta], or docks, a list of these, in place of dock; cliff and carpet, images of the same size whose dark
pixels mark the cells; and fill_unknown, an area.
"""

from __future__ import annotations

import math
import ntpath
import os
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

from rumba_sim.model.common.config import closest
from rumba_sim.model.common.errors import MapError, one_line, quoted
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.common.yaml_file import read_mapping

REQUIRED = ('image', 'resolution', 'origin', 'negate', 'occupied_thresh', 'free_thresh')
OPTIONAL = ('mode', 'dock', 'docks', 'start', 'cliff', 'carpet', 'fill_unknown')
MODES = ('trinary', 'scale', 'raw')
MOST_DOCKS = 100  # each costs time in each tick
FAR = 1e9  # [m] the largest coordinate; those of national grids reach 1e7
RESOLUTIONS = (1e-4, 10.0)  # [m]
MOST_UNKNOWN = 10.0  # [m^2] that fill_unknown can fill at one place: more is a room that nobody has seen


class Header(NamedTuple):
    """The checked values of the YAML file of a map."""

    path: str
    image: str
    resolution: float
    origin: Pose
    negate: bool
    occupied_thresh: float
    free_thresh: float
    mode: str
    docks: Tuple[Pose, ...]
    start: Optional[Pose]
    cliff: Optional[str]
    carpet: Optional[str]
    fill_unknown: float
    remarks: Tuple[str, ...]  # what is odd and no error, a line each


def read_header(path: str) -> Header:
    """Read and check the YAML file of a map, but not its images.

    Raises:
        MapError: the file cannot be read, or a key is missing or misspelt, or a value is not allowed.
    """
    entries = _Entries(path, read_mapping(path, MapError))
    header = Header(
        path=path, image=entries.file('image') or '', resolution=entries.number('resolution', *RESOLUTIONS, unit=' m'),
        origin=entries.pose('origin') or Pose(0.0, 0.0, 0.0), negate=bool(entries.choice('negate', (0, 1))),
        occupied_thresh=entries.number('occupied_thresh', 0.0, 1.0),
        free_thresh=entries.number('free_thresh', 0.0, 1.0), mode=entries.choice('mode', MODES),
        docks=entries.docks(), start=entries.pose('start'),
        cliff=entries.file('cliff'), carpet=entries.file('carpet'),
        fill_unknown=entries.number('fill_unknown', 0.0, MOST_UNKNOWN, unit=' m2'), remarks=())
    if header.free_thresh > header.occupied_thresh:
        raise MapError(f'{path}: free_thresh is {header.free_thresh:g}: '
                       f'must not be above occupied_thresh, {header.occupied_thresh:g}')
    return header._replace(remarks=tuple(entries.remarks))


class _Entries:
    """The values of the YAML file of a map; each method checks the value that it returns.

    Attributes:
        remarks: what is odd and no error, a line each.
    """

    def __init__(self, path: str, values: Dict[Any, Any]) -> None:
        self._path = path
        self._values = {'mode': MODES[0], 'fill_unknown': 0.0, **values}
        self.remarks: List[str] = []
        known = [*REQUIRED, *OPTIONAL]
        ignored = [key for key in values if key not in known]
        for key in ignored:
            meant = closest(key, known)
            if meant is not None:
                raise MapError(f'{path}: {quoted(key)} is unknown: did you mean {meant!r}?')
        if ignored:  # map_server ignores them too, and other programs have keys of their own
            self._remark(f'unknown keys are ignored: {", ".join(map(quoted, ignored))}')
        for key in REQUIRED:
            if key not in values:
                raise MapError(f'{path}: {key} is missing')

    def _remark(self, text: str) -> None:
        self.remarks.append(one_line(f'{self._path}: {text}'))

    def _wrong(self, key: str, right: str) -> MapError:
        return MapError(f'{self._path}: {key} is {quoted(self._values[key])}: must be {right}')

    def number(self, key: str, low: float, high: float, unit: str = '') -> float:
        value = _number(self._values[key])
        if value is None or not low <= value <= high:
            raise self._wrong(key, f'{low:g} to {high:g}{unit}')
        return value

    def pose(self, key: str) -> Optional[Pose]:
        values: Any = self._values.get(key)
        if values is None and key in OPTIONAL:
            return None
        found = _pose(values)
        if found is None:
            raise self._wrong(key, '[x, y, angle] in m, m, rad')
        return found

    def docks(self) -> Tuple[Pose, ...]:
        several: Any = self._values.get('docks')
        if several is None:
            one = self.pose('dock')
            return () if one is None else (one,)
        if 'dock' in self._values:
            raise MapError(f'{self._path}: dock and docks: must be one of them')
        found = [_pose(values) for values in several] if isinstance(several, list) else []
        poses = tuple(pose for pose in found if pose is not None)
        if not 0 < len(poses) == len(found) <= MOST_DOCKS:
            raise self._wrong('docks', f'a list of [x, y, angle] in m, m, rad, of {MOST_DOCKS} at most')
        return poses

    def choice(self, key: str, allowed: Tuple[Any, ...]) -> Any:
        value = self._values[key]
        if value not in allowed:
            raise self._wrong(key, ' or '.join(str(word) for word in allowed))
        return value

    def file(self, key: str) -> Optional[str]:
        value = self._values.get(key)
        if value is None and key in OPTIONAL:
            return None
        if not isinstance(value, str) or not value:
            raise self._wrong(key, 'the path of an image')
        folder = os.path.dirname(self._path)
        path, beside = os.path.join(folder, value), os.path.join(folder, ntpath.basename(value))
        if beside == path or _is_there(path) or not _is_there(beside):
            return path
        self._remark(f'{key} is {quoted(value)}, which is not there: taking {beside}')
        return beside


def _pose(values: Any) -> Optional[Pose]:
    """[x, y, angle] as a pose, else None."""
    numbers = [_number(value) for value in values] if isinstance(values, list) else []
    good = [number for number in numbers if number is not None and abs(number) <= FAR]
    return Pose(good[0], good[1], wrap_angle(good[2])) if len(numbers) == len(good) == 3 else None


def _number(value: Any) -> Optional[float]:
    """The value as a finite number, also if YAML 1.1 reads it as text, for example 5e-2; else None."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None


def _is_there(path: str) -> bool:
    """Whether there is a file at a path, which may hold characters that no path can have."""
    try:
        return os.path.isfile(path)
    except ValueError:
        return False
