"""From the map [m], y upward, to a picture [pixels], y downward, and back."""

import dataclasses
from typing import Tuple

from rumba_viewer.scene.snapshot import Box

MARGIN = 14.0  # [pixels] around a map that just fits
SCALES = (2.0, 4000.0)  # [pixels/m]
LEAST = 1e-3  # [m] of a map that has next to no size


@dataclasses.dataclass(frozen=True)
class ViewTransform:
    """What part of the map a picture shows.

    Attributes:
        width, height: of the picture [pixels].
        x, y: the place in its middle [m].
        scale: [pixels/m].
    """

    width: float
    height: float
    x: float
    y: float
    scale: float

    @staticmethod
    def fitted(box: Box, width: float, height: float) -> 'ViewTransform':
        """The whole of a box, as large as it can be."""
        across, up = max(box.right - box.left, LEAST), max(box.top - box.bottom, LEAST)
        scale = min(max(width - 2.0 * MARGIN, 1.0) / across, max(height - 2.0 * MARGIN, 1.0) / up)
        return ViewTransform(width, height, 0.5 * (box.left + box.right), 0.5 * (box.bottom + box.top), scale)

    def to_pixel(self, x: float, y: float) -> Tuple[float, float]:
        """Where a place of the map [m] is in the picture."""
        return 0.5 * self.width + (x - self.x) * self.scale, 0.5 * self.height - (y - self.y) * self.scale

    def to_map(self, across: float, down: float) -> Tuple[float, float]:
        """Which place of the map [m] a pixel shows."""
        return self.x + (across - 0.5 * self.width) / self.scale, self.y - (down - 0.5 * self.height) / self.scale

    def zoomed(self, factor: float, across: float, down: float) -> 'ViewTransform':
        """Larger by a factor; the place at a pixel stays where it is."""
        low, high = min(SCALES[0], self.scale), max(SCALES[1], self.scale)
        scale = min(max(self.scale * factor, low), high)
        x, y = self.to_map(across, down)
        shrunk = self.scale / scale
        return dataclasses.replace(self, scale=scale, x=x + (self.x - x) * shrunk, y=y + (self.y - y) * shrunk)

    def panned(self, across: float, down: float) -> 'ViewTransform':
        """Moved by so many pixels, as a hand moves a sheet."""
        return dataclasses.replace(self, x=self.x - across / self.scale, y=self.y + down / self.scale)

    def resized(self, width: float, height: float) -> 'ViewTransform':
        """The same middle and scale in a picture of another size."""
        return dataclasses.replace(self, width=width, height=height)
