"""The lines that pens draw, as an image; this module knows nothing about turtles."""

import math
from typing import Any, NamedTuple, Sequence, Tuple

from PIL import Image, ImageDraw

from turtlesim.model.turtles import PIXELS

Colour = Tuple[int, int, int]  # red, green, blue: 0..255
Pixel = Sequence[int]  # column from the left, row from the top


def colour_part(value: Any, default: int) -> int:
    """Return red, green or blue of a parameter, as roscpp and Qt take it: rounded, its lowest byte.

    Args:
        value: what the parameter is.
        default: the answer if that is not a number.
    """
    if type(value) is float and math.isfinite(value):
        value = math.floor(value) if math.fmod(value, 1.0) < 0.5 else math.ceil(value)  # not symmetric, as in roscpp
    return int(value) % 256 if type(value) is int else default


class Pen(NamedTuple):
    """The pen of a turtle."""

    colour: Colour = (0xb3, 0xb8, 0xff)
    width: int = 3  # [pixels]
    is_down: bool = True


class Canvas:
    """The field as an image.

    Attributes:
        image: PIXELS x PIXELS, RGB.
    """

    def __init__(self, background: Colour) -> None:
        """Start with one colour everywhere."""
        self.clear(background)

    def clear(self, background: Colour) -> None:
        """Erase all lines."""
        self.image = Image.new('RGB', (PIXELS, PIXELS), background)
        self._draw = ImageDraw.Draw(self.image)
        self._pixels: Any = self.image.load()

    def line(self, start: Pixel, end: Pixel, pen: Pen) -> None:
        """Draw a straight line with round ends, so that there is no gap where two lines meet."""
        self._draw.line([*start, *end], pen.colour, pen.width)
        if pen.width > 1:
            # Of an ellipse two pixels wide, Pillow before 8 draws one pixel.
            end_of = self._draw.rectangle if pen.width == 2 else self._draw.ellipse
            for column, row in (start, end):
                left, top = column - (pen.width - 1) // 2, row - (pen.width - 1) // 2
                end_of([left, top, left + pen.width - 1, top + pen.width - 1], pen.colour)

    def colour(self, pixel: Pixel) -> Colour:
        """Return the colour of a pixel."""
        colour: Colour = self._pixels[tuple(pixel)]
        return colour
