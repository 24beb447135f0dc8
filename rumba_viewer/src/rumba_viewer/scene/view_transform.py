"""From the map [m], y upward, to a picture [pixels], y downward, and back."""

import dataclasses
from typing import Tuple

from rumba_viewer.scene.snapshot import Box

MARGIN = 14.0  # [pixels] around a map that fills the picture
SCALES = (2.0, 4000.0)  # [pixels/m]
MIN_SIZE = 1e-3  # [m] of a map, to avoid a division by zero


@dataclasses.dataclass(frozen=True)
class ViewTransform:
    """The part of the map that a picture shows.

    Attributes:
        width, height: size of the picture [pixels].
        x, y: the point of the map in its centre [m].
        scale: [pixels/m].
    """

    width: float
    height: float
    x: float
    y: float
    scale: float

    @staticmethod
    def fitted(box: Box, width: float, height: float, top: float = 0.0, bottom: float = 0.0) -> 'ViewTransform':
        """A whole box, as large as possible, without the uppermost and lowest rows of the picture [pixels]."""
        across, up = max(box.right - box.left, MIN_SIZE), max(box.top - box.bottom, MIN_SIZE)
        scale = min(max(width - 2.0 * MARGIN, 1.0) / across, max(height - top - bottom - 2.0 * MARGIN, 1.0) / up)
        return ViewTransform(width, height, 0.5 * (box.left + box.right),
                             0.5 * (box.bottom + box.top) + 0.5 * (top - bottom) / scale, scale)

    def to_pixel(self, x: float, y: float) -> Tuple[float, float]:
        """The pixel at which a point of the map [m] is shown."""
        return 0.5 * self.width + (x - self.x) * self.scale, 0.5 * self.height - (y - self.y) * self.scale

    def to_map(self, across: float, down: float) -> Tuple[float, float]:
        """The point of the map [m] that a pixel shows."""
        return self.x + (across - 0.5 * self.width) / self.scale, self.y - (down - 0.5 * self.height) / self.scale

    def zoomed(self, factor: float, across: float, down: float) -> 'ViewTransform':
        """Larger by a factor; the point that a pixel shows stays there."""
        low, high = min(SCALES[0], self.scale), max(SCALES[1], self.scale)
        scale = min(max(self.scale * factor, low), high)
        x, y = self.to_map(across, down)
        shrunk = self.scale / scale
        return dataclasses.replace(self, scale=scale, x=x + (self.x - x) * shrunk, y=y + (self.y - y) * shrunk)

    def panned(self, across: float, down: float) -> 'ViewTransform':
        """Moved by a number of pixels, as a sheet of paper is moved."""
        return dataclasses.replace(self, x=self.x - across / self.scale, y=self.y + down / self.scale)

    def resized(self, width: float, height: float) -> 'ViewTransform':
        """The same centre and scale in a picture of another size."""
        return dataclasses.replace(self, width=width, height=height)
