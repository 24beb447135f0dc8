"""Draws floor plans and writes them as maps of map_server.

Lengths are in metres, x points to the right and y up. A cell belongs to a shape if the shape covers its centre, so that
every version of the libraries draws the same cells.
"""

import math
import pathlib
from typing import Any, Dict, List, Sequence, Tuple

import numpy as np
from PIL import Image

OCCUPIED, UNKNOWN, FREE = 0, 205, 254  # brightness, as map_saver writes it
ROBOT_AT_WALL = 0.205  # [m] the radius of a robot, and 3 cm for the plate of the dock

Mask = Any  # bool (rows, columns), row 0 at the bottom: the cells of a shape
Pose = Tuple[float, float, float]  # x, y [m], theta [rad]


class Drawing:
    """A map that is being drawn: its floor, and its layers of cliffs and carpets."""

    def __init__(self, left: float, bottom: float, right: float, top: float, resolution: float) -> None:
        """Start with unknown cells of size `resolution` [m] between these edges [m]."""
        self.origin = (left, bottom)
        self.resolution = resolution
        columns, rows = round((right - left) / resolution), round((top - bottom) / resolution)
        self.x = left + (np.arange(columns) + 0.5) * resolution
        self.y = (bottom + (np.arange(rows) + 0.5) * resolution)[:, np.newaxis]
        self.floor = np.full((rows, columns), UNKNOWN, np.uint8)
        self.layers: Dict[str, Mask] = {}

    def box(self, left: float, bottom: float, right: float, top: float) -> Mask:
        """The cells of a rectangle."""
        return (self.x > left) & (self.x < right) & (self.y > bottom) & (self.y < top)

    def turned_box(self, x: float, y: float, length: float, width: float, degrees: float) -> Mask:
        """The cells of a rectangle with centre (x, y), turned counter-clockwise by some degrees."""
        cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        along, across = cos * (self.x - x) + sin * (self.y - y), cos * (self.y - y) - sin * (self.x - x)
        return (abs(along) < length / 2.0) & (abs(across) < width / 2.0)

    def disc(self, x: float, y: float, radius: float) -> Mask:
        """The cells of a disc."""
        return np.hypot(self.x - x, self.y - y) < radius

    def paint(self, mask: Mask, brightness: int = OCCUPIED) -> None:
        """Fill a shape with a brightness."""
        self.floor[mask] = brightness

    def furniture(self, *masks: Mask) -> None:
        """Draw the outlines of shapes, one over the other; their inside is unknown, as in a map from a laser."""
        for mask in masks:
            self.paint(mask)
            inner = mask[1:-1, 1:-1] & mask[:-2, 1:-1] & mask[2:, 1:-1] & mask[1:-1, :-2] & mask[1:-1, 2:]
            self.floor[1:-1, 1:-1][inner] = UNKNOWN

    def legs(self, left: float, bottom: float, right: float, top: float, side: float = 0.04) -> None:
        """Draw four legs in the corners of a rectangle."""
        for x in (left, right - side):
            for y in (bottom, top - side):
                self.paint(self.box(x, y, x + side, y + side))

    def save(self, folder: pathlib.Path, name: str, title: str, poses: Dict[str, Pose]) -> None:
        """Write the YAML file, which begins with the title, and the images of the floor and the layers."""
        self._describe(folder, name, name, [f'# {title}'], [f'{key}: {_listed(pose)}' for key, pose in poses.items()])
        for file, pixels in self._images(name).values():
            Image.fromarray(np.ascontiguousarray(pixels[::-1])).save(str(folder / file), optimize=True)

    def save_with_docks(self, folder: pathlib.Path, name: str, images: str, title: str, docks: Sequence[Pose]) -> None:
        """Write another YAML file, with several docks, for the images that were saved under a name."""
        self._describe(folder, name, images, [f'# {title}'],
                       ['docks:', *(f'  - {_listed(dock)}' for dock in docks)])

    def _images(self, name: str) -> Dict[str, Tuple[str, Any]]:
        """File and pixels of each image, by its key in the YAML file."""
        images = {'image': (f'{name}.png', self.floor)}
        for layer, mask in self.layers.items():
            images[layer] = (f'{name}_{layer}.png', np.where(mask, 0, 255).astype(np.uint8))
        return images

    def _describe(self, folder: pathlib.Path, name: str, images: str, lines: List[str], poses: List[str]) -> None:
        """Write a YAML file."""
        lines += [f'{key}: {file}' for key, (file, _) in self._images(images).items()]
        lines += [f'resolution: {self.resolution}', f'origin: [{self.origin[0]}, {self.origin[1]}, 0.0]', 'negate: 0',
                  'occupied_thresh: 0.65', 'free_thresh: 0.196']
        (folder / f'{name}.yaml').write_text('\n'.join(lines + poses) + '\n')


def _listed(pose: Pose) -> str:
    """A pose as YAML."""
    x, y, theta = pose
    return f'[{x:.6f}, {y:.6f}, {theta:.6f}]'
