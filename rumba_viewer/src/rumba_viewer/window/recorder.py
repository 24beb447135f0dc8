"""Records pictures of the floor as an animated GIF."""

import pathlib
from typing import List

from PIL import Image
from PyQt5.QtCore import Qt
from PyQt5.QtGui import QImage

RATE = 8  # [Hz]
WIDTH = 640  # [pixels] at most
MAX_FRAMES = 60 * RATE  # Pillow keeps all frames until the file is written, about 300 kB each
COLOURS = 128


class Recorder:
    """Collects pictures until it is full, and writes them to a file."""

    def __init__(self) -> None:
        """Start with no picture."""
        self._frames: List[Image.Image] = []

    @property
    def is_full(self) -> bool:
        """Whether it takes no more pictures."""
        return len(self._frames) >= MAX_FRAMES

    @property
    def duration(self) -> float:
        """How long the record is [s]."""
        return len(self._frames) / RATE

    def add(self, picture: QImage) -> None:
        """Add a picture."""
        if self._frames:
            width, height = self._frames[0].size
            picture = picture.scaled(width, height, Qt.KeepAspectRatio, Qt.SmoothTransformation)
        elif picture.width() > WIDTH:
            picture = picture.scaledToWidth(WIDTH, Qt.SmoothTransformation)
        frame = _image(picture)
        if self._frames and frame.size != self._frames[0].size:  # the window was resized
            sheet = Image.new('RGB', self._frames[0].size)
            sheet.paste(frame)
            frame = sheet
        self._frames.append(frame.quantize(COLOURS, method=Image.FASTOCTREE, dither=0))

    def write(self, path: pathlib.Path) -> None:
        """Write the pictures as a GIF.

        Raises:
            OSError: the file cannot be written.
        """
        first, *rest = self._frames
        first.save(str(path), save_all=True, append_images=rest, duration=1000 // RATE, loop=0)


def _image(picture: QImage) -> Image.Image:
    """The same picture as an image of Pillow."""
    picture = picture.convertToFormat(QImage.Format_RGB888)
    bits = picture.constBits()
    bits.setsize(picture.bytesPerLine() * picture.height())
    return Image.frombytes('RGB', (picture.width(), picture.height()), bytes(bits), 'raw', 'RGB',
                           picture.bytesPerLine())
