"""Map files in the format of map_server: a YAML file that names an image, with some more keys for Rumba."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, List, Optional, Tuple, TypeVar, Union

import numpy as np
from scipy import ndimage

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.maps import map_image
from rumba_sim.model.maps.crop import Window, window
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN, Bounds, FloorPlan, check_size
from rumba_sim.model.maps.map_header import Header, read_header
from rumba_sim.model.maps.map_image import Alpha, Picture
from rumba_sim.model.maps.specks import specks
from rumba_sim.model.settings.robot_config import DriveConfig

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

ROUNDING = 1e-6  # [cells] so that a quarter turn does not add a row
SPECK = 0.05  # [m^2] up to which unknown areas are counted that the file leaves as walls: half of what a robot covers

Cell = TypeVar('Cell', bound=np.generic)


def load(path: Union[str, os.PathLike[str]], radius: float = DriveConfig().radius) -> FloorPlan:
    """Read a map, and crop it to the part that robots can use.

    The origin changes with the crop, so that all coordinates stay the same. If the origin has a yaw, the map is
    resampled parallel to the axes.

    Args:
        path: path of the YAML file.
        radius: of the robots that are to drive there [m]: free cells far from where they can stand are left out.

    Raises:
        MapError: the file, or a file that it names, cannot be used; the message begins with the path.
    """
    header = read_header(os.fspath(path))
    picture = read_image(header)
    occupancy = whole_occupancy(header, picture)
    remarks = list(header.remarks)
    if header.fill_unknown:
        remarks += _filled(header, occupancy)
    part = window(occupancy == FREE, header.resolution, radius, _places(header))
    occupancy = occupancy[part]
    remarks += _left_unknown(header, occupancy)
    cliff = _layer(header, 'cliff', header.cliff, picture, part)
    carpet = _layer(header, 'carpet', header.carpet, picture, part)
    origin = _moved(header.origin, part[1].start * header.resolution, part[0].start * header.resolution)
    if origin.theta != 0.0:
        box = _box(origin.theta, occupancy.shape)
        check_size(f'{header.path}, turned by its yaw', _shape(box))
        origin = Pose(origin.x + box.left * header.resolution, origin.y + box.bottom * header.resolution, 0.0)
        occupancy = _turned(occupancy, header.origin.theta, box, UNKNOWN)
        cliff = None if cliff is None else _turned(cliff, header.origin.theta, box, 0)
        carpet = None if carpet is None else _turned(carpet, header.origin.theta, box, 0)
    return FloorPlan(header.path, occupancy, header.resolution, (origin.x, origin.y), cliff=cliff, carpet=carpet,
                     dock=header.docks[0] if header.docks else None, further_docks=header.docks[1:],
                     start=header.start, remarks=remarks)


def read_image(header: Header) -> Picture:
    """The image of a map.

    Raises:
        MapError: it cannot be used; the message begins with the path of the YAML file.
    """
    return _read(header, 'image', header.image, Alpha.AVERAGE if header.mode == 'trinary' else Alpha.IGNORE)


def _read(header: Header, key: str, path: str, alpha: Alpha, like: Optional[Picture] = None) -> Picture:
    """The image that a key of a map names."""
    try:
        return map_image.read(path, alpha, like)
    except MapError as error:
        raise MapError(f'{header.path}: {key}: {error}') from None


def _places(header: Header) -> List[Tuple[float, float]]:
    """Row and column, which may have fractions, of the docks and of the start, on the whole map."""
    poses = [*header.docks, *([] if header.start is None else [header.start])]
    on_map = [compose(inverse(header.origin), pose) for pose in poses]
    return [(pose.y / header.resolution, pose.x / header.resolution) for pose in on_map]


def _filled(header: Header, occupancy: NDArray[np.int8]) -> List[str]:
    """Make the specks free that the file says; a line that counts them."""
    found = specks(occupancy, _cells(header, header.fill_unknown))
    occupancy[found > 0] = FREE
    area = np.count_nonzero(found) * header.resolution ** 2
    return [f'{header.path}: fill_unknown: {found.max()} specks of unknown cells, {area:.2f} m2 in all, are floor']


def _left_unknown(header: Header, occupancy: NDArray[np.int8]) -> List[str]:
    """A line that counts the specks that remain walls, if there are any."""
    found = specks(occupancy, _cells(header, SPECK))
    if not found.any():
        return []
    area = np.count_nonzero(found) * header.resolution ** 2
    return [f'{header.path}: {found.max()} specks of unknown cells, {area:.2f} m2 in all, count as walls: with '
            f'fill_unknown: {SPECK} they are floor']


def _cells(header: Header, area: float) -> int:
    """How many cells fit into an area [m^2]."""
    return math.floor(area / header.resolution ** 2 + ROUNDING)


def whole_occupancy(header: Header, picture: Picture) -> NDArray[np.int8]:
    """All cells of a map, as they are: int8 (rows, columns), row 0 at the bottom, by the rules of map_server in Noetic.

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


def _layer(header: Header, key: str, path: Optional[str], picture: Picture,
           part: Window) -> Optional[NDArray[np.bool_]]:
    """The dark pixels of a layer in a part of the map: bool (rows, columns), row 0 at the bottom."""
    if path is None:
        return None
    layer = _read(header, key, path, Alpha.ON_WHITE, like=picture)
    return np.asarray(layer.levels[::-1][part] <= (layer.white - 1) // 2)


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
