"""Records pictures of the floor as an animated GIF."""

import pathlib
from typing import List

from PIL import Image
from PyQt5.QtCore import Qt
from PyQt5.QtGui import QImage

RATE = 8  # [Hz]
WIDTH = 640  # [pixels] at most
MOST = 60 * RATE  # pictures: Pillow keeps all of them until the file is written, some 300 kB each
COLOURS = 128


class Recorder:
    """Takes pictures until it is full, then writes them."""

    def __init__(self) -> None:
        """Begin with none."""
        self._frames: List[Image.Image] = []

    @property
    def is_full(self) -> bool:
        """Whether it takes no more."""
        return len(self._frames) >= MOST

    def add(self, picture: QImage) -> None:
        """Take a picture."""
        if self._frames:
            width, height = self._frames[0].size
            picture = picture.scaled(width, height, Qt.KeepAspectRatio, Qt.SmoothTransformation)
        elif picture.width() > WIDTH:
            picture = picture.scaledToWidth(WIDTH, Qt.SmoothTransformation)
        frame = _image(picture)
        if self._frames and frame.size != self._frames[0].size:  # the window has another shape now
            sheet = Image.new('RGB', self._frames[0].size)
            sheet.paste(frame)
            frame = sheet
        self._frames.append(frame.quantize(COLOURS, method=Image.FASTOCTREE, dither=0))

    def write(self, path: pathlib.Path) -> None:
        """Write what was taken.

        Raises:
            OSError: the file cannot be written.
        """
        first, *rest = self._frames
        first.save(str(path), save_all=True, append_images=rest, duration=1000 // RATE, loop=0)


def _image(picture: QImage) -> Image.Image:
    """The same picture for Pillow."""
    picture = picture.convertToFormat(QImage.Format_RGB888)
    bits = picture.constBits()
    bits.setsize(picture.bytesPerLine() * picture.height())
    return Image.frombytes('RGB', (picture.width(), picture.height()), bytes(bits), 'raw', 'RGB',
                           picture.bytesPerLine())
