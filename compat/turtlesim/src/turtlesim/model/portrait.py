"""The picture of a turtle, seen from above."""

import functools
import math
from typing import Iterable, List, Tuple

from PIL import Image, ImageDraw

from turtlesim.model.turtles import METRE

SHELLS = ('#3f8f4f', '#c8693a', '#b0a030', '#8a5fb0', '#3a9a9a', '#c25073', '#7a6a55', '#d8d8d0')
SKIN, EYE, SEAM = '#8fcf6a', '#20301c', '#24402a'
FINER = 3  # the picture is drawn this many times larger, then reduced, for smooth edges
HEADINGS = 120  # pictures of one turtle, one for each heading
# In a square from -1 to 1, heading along x, y up: left, bottom, right, top.
LEGS = [(x - 0.22, y - 0.18, x + 0.22, y + 0.18) for x in (0.42, -0.45) for y in (0.52, -0.52)]
TAIL = [(-0.6, 0.1), (-0.95, 0.0), (-0.6, -0.1)]
HEAD = (0.5, -0.24, 0.98, 0.24)
EYES = [(0.78, y - 0.05, 0.88, y + 0.05) for y in (0.12, -0.12)]
BODY = (-0.68, -0.55, 0.62, 0.55)
PLATE = [(0.3, 0.0), (0.12, 0.26), (-0.22, 0.26), (-0.4, 0.0), (-0.22, -0.26), (0.12, -0.26)]
SEAMS = [((0.3, 0.0), (0.6, 0.0)), ((0.12, 0.26), (0.26, 0.5)), ((-0.22, 0.26), (-0.36, 0.48)),
         ((-0.4, 0.0), (-0.66, 0.0)), ((-0.22, -0.26), (-0.36, -0.48)), ((0.12, -0.26), (0.26, -0.5))]


def portrait(number: int, theta: float) -> Image.Image:
    """Return the picture of a turtle with a heading.

    Args:
        number: number of the turtle; consecutive numbers differ in colour.
        theta: [rad] heading, counter-clockwise from the right.

    Returns:
        RGBA image of METRE x METRE pixels, transparent around the turtle.
    """
    return _portrait(number % len(SHELLS), round(theta * HEADINGS / (2.0 * math.pi)) % HEADINGS)


@functools.lru_cache(maxsize=len(SHELLS) * HEADINGS)
def _portrait(shell: int, heading: int) -> Image.Image:
    rotated = _heading_right(SHELLS[shell]).rotate(360.0 * heading / HEADINGS, Image.BILINEAR)
    return rotated.resize((METRE, METRE), Image.BOX)


@functools.lru_cache(maxsize=len(SHELLS))
def _heading_right(shell: str) -> Image.Image:
    image = Image.new('RGBA', (METRE * FINER, METRE * FINER))
    draw = ImageDraw.Draw(image)
    for leg in LEGS:
        draw.ellipse(_box(leg), SKIN)
    draw.polygon(_points(TAIL), SKIN)
    draw.ellipse(_box(HEAD), SKIN)
    for eye in EYES:
        draw.ellipse(_box(eye), EYE)
    draw.ellipse(_box(BODY), shell, SEAM, FINER)
    draw.polygon(_points(PLATE), None, SEAM)
    for seam in SEAMS:
        draw.line(_points(seam), SEAM, FINER // 2)
    return image


def _points(points: Iterable[Tuple[float, float]]) -> List[Tuple[float, float]]:
    half = METRE * FINER / 2.0
    return [(half * (1.0 + x), half * (1.0 - y)) for x, y in points]


def _box(sides: Tuple[float, float, float, float]) -> List[Tuple[float, float]]:
    left, bottom, right, top = sides
    return _points([(left, top), (right, bottom)])
