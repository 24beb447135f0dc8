"""Map files in the format of map_server: a YAML file that names an image, with some more keys for Rumba.

Keys of map_server: image, resolution [m/pixel], origin [x, y, yaw] of the lower left corner, negate,
occupied_thresh, free_thresh, mode (trinary, scale or raw). Optional keys of Rumba: dock and start, each
[x, y, theta], or docks, a list of these, in place of dock; and cliff and carpet, images of the same size whose dark
pixels mark the cells.
"""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any, Dict, NamedTuple, Optional, Tuple, TypeVar, Union

import numpy as np
from scipy import ndimage

from rumba_sim.model import map_image
from rumba_sim.model.config import nearest
from rumba_sim.model.errors import MapError, quoted
from rumba_sim.model.floor_plan import FREE, OCCUPIED, UNKNOWN, Bounds, FloorPlan, check_size
from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.map_image import Alpha, Picture
from rumba_sim.model.yaml_file import read_mapping

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

REQUIRED = ('image', 'resolution', 'origin', 'negate', 'occupied_thresh', 'free_thresh')
OPTIONAL = ('mode', 'dock', 'docks', 'start', 'cliff', 'carpet')
MODES = ('trinary', 'scale', 'raw')
MOST_DOCKS = 100  # each costs time in each tick
FAR = 1e9  # [m] the largest coordinate; those of national grids reach 1e7
RESOLUTIONS = (1e-4, 10.0)  # [m]
ROUNDING = 1e-6  # [cells] so that a quarter turn does not add a row

Cell = TypeVar('Cell', bound=np.generic)


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


def load(path: Union[str, os.PathLike[str]]) -> FloorPlan:
    """Read a map and crop it to its free cells and a border of one cell.

    Most cells of a map from SLAM are unknown, so that this saves time and memory. The origin changes with the crop, so
    that all coordinates stay the same. If the origin has a yaw, the map is resampled parallel to the axes.

    Args:
        path: path of the YAML file.

    Raises:
        MapError: the file, or a file that it names, cannot be used; the message begins with the path of that file.
    """
    header = read_header(os.fspath(path))
    picture = map_image.read(header.image, Alpha.AVERAGE if header.mode == 'trinary' else Alpha.IGNORE)
    occupancy = _occupancy(header, picture)
    part = _around_free(occupancy)
    occupancy = occupancy[part]
    cliff = _layer(header, header.cliff, picture, part)
    carpet = _layer(header, header.carpet, picture, part)
    origin = _moved(header.origin, part[1].start * header.resolution, part[0].start * header.resolution)
    if origin.theta != 0.0:
        box = _box(origin.theta, occupancy.shape)
        check_size(f'{header.path}, turned by its yaw', _shape(box))
        origin = Pose(origin.x + box.left * header.resolution, origin.y + box.bottom * header.resolution, 0.0)
        occupancy = _turned(occupancy, header.origin.theta, box, UNKNOWN)
        cliff = None if cliff is None else _turned(cliff, header.origin.theta, box, 0)
        carpet = None if carpet is None else _turned(carpet, header.origin.theta, box, 0)
    return FloorPlan(header.path, occupancy, header.resolution, (origin.x, origin.y), cliff=cliff, carpet=carpet,
                     dock=header.docks[0] if header.docks else None, further_docks=header.docks[1:], start=header.start)


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
        cliff=entries.file('cliff'), carpet=entries.file('carpet'))
    if header.free_thresh > header.occupied_thresh:
        raise MapError(f'{path}: free_thresh is {header.free_thresh:g}: '
                       f'must not be above occupied_thresh, {header.occupied_thresh:g}')
    return header


class _Entries:
    """The values of the YAML file of a map; each method checks the value that it returns."""

    def __init__(self, path: str, values: Dict[Any, Any]) -> None:
        self._path = path
        self._values = {'mode': MODES[0], **values}
        known = [*REQUIRED, *OPTIONAL]
        for key in values:
            if key not in known:
                raise MapError(f'{path}: {quoted(key)} is unknown: {nearest(key, known)}')
        for key in REQUIRED:
            if key not in values:
                raise MapError(f'{path}: {key} is missing')

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
        return os.path.join(os.path.dirname(self._path), value)


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


def _occupancy(header: Header, picture: Picture) -> NDArray[np.int8]:
    """int8 (rows, columns), row 0 at the bottom, by the rules of map_server in ROS Noetic.

    Values between free and occupied in the modes scale and raw become unknown here. In mode raw a pixel is the
    probability in percent, and a pixel above 100 is unknown.
    """
    value = np.arange(picture.white + 1) / (picture.white / 255.0)
    if header.negate:
        value = 255.0 - value
    probability = np.floor(value) / 100.0 if header.mode == 'raw' else (255.0 - value) / 255.0
    table = np.full(value.shape, UNKNOWN, np.int8)
    table[probability < header.free_thresh] = FREE
    table[(probability > header.occupied_thresh) & (probability <= 1.0)] = OCCUPIED
    return np.stack([table[row] for row in picture.levels[::-1]])  # the whole image at once takes 8 bytes per pixel


def _layer(header: Header, path: Optional[str], picture: Picture,
           part: Tuple[slice, slice]) -> Optional[NDArray[np.bool_]]:
    """The dark pixels of a layer in a part of the map: bool (rows, columns), row 0 at the bottom."""
    if path is None:
        return None
    layer = map_image.read(path, Alpha.ON_WHITE, like=picture)
    return np.asarray(layer.levels[::-1][part] <= (layer.white - 1) // 2)


def _around_free(occupancy: NDArray[np.int8]) -> Tuple[slice, slice]:
    """The rows and columns that contain a free cell, and one more on each side."""
    free = occupancy == FREE
    return _span(free.any(axis=1)), _span(free.any(axis=0))


def _span(used: NDArray[np.bool_]) -> slice:
    indices = np.flatnonzero(used)
    if indices.size == 0:
        return slice(0, 1)
    return slice(max(int(indices[0]) - 1, 0), int(indices[-1]) + 2)


def _moved(origin: Pose, x: float, y: float) -> Pose:
    """The origin of a grid that begins at the point (x, y) [m] of the grid with this origin."""
    cos, sin = math.cos(origin.theta), math.sin(origin.theta)
    return Pose(origin.x + cos * x - sin * y, origin.y + sin * x + cos * y, origin.theta)


def _box(theta: float, shape: Tuple[int, ...]) -> Bounds:
    """Edges [cells] of the rectangle, parallel to the axes, around a grid (rows, columns) turned about its origin."""
    corners = [_moved(Pose(0.0, 0.0, theta), x, y) for x in (0, shape[1]) for y in (0, shape[0])]
    left, bottom = min(corner.x for corner in corners), min(corner.y for corner in corners)
    columns = math.ceil(max(corner.x for corner in corners) - left - ROUNDING)
    rows = math.ceil(max(corner.y for corner in corners) - bottom - ROUNDING)
    return Bounds(left, bottom, left + columns, bottom + rows)


def _shape(box: Bounds) -> Tuple[int, int]:
    """Rows and columns of a grid with these edges [cells]."""
    return round(box.top - box.bottom), round(box.right - box.left)


def _turned(layer: NDArray[Cell], theta: float, box: Bounds, beyond: int) -> NDArray[Cell]:
    """Resample a turned layer parallel to the axes; cells whose centre is not on the layer become `beyond`."""
    cos, sin = math.cos(theta), math.sin(theta)
    x, y = box.left + 0.5, box.bottom + 0.5
    # Indices refer to the centre of a cell (-0.5), and the border that is added to the layer shifts them (+1).
    offset = (cos * y - sin * x + 0.5, sin * y + cos * x + 0.5)
    padded = np.pad(layer.astype(np.int8), 1, mode='constant', constant_values=beyond)
    resampled = ndimage.affine_transform(padded, [[cos, -sin], [sin, cos]], offset, _shape(box), order=0, cval=beyond)
    return np.asarray(resampled, dtype=layer.dtype)
