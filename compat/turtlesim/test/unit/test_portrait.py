"""The picture of a turtle shows its heading, and consecutive turtles differ in colour."""

import math

import pytest
from PIL import ImageChops

from turtlesim.model.field import Field
from turtlesim.model.portrait import SHELLS, portrait
from turtlesim.model.turtles import METRE


def skin(picture):
    """Return the mean of the light green pixels, head and legs: column and row from the middle of the picture."""
    found = [(column + 0.5 - METRE / 2.0, row + 0.5 - METRE / 2.0) for column in range(METRE) for row in range(METRE)
             if picture.getpixel((column, row))[3] > 200 and picture.getpixel((column, row))[1] > 180]
    return [sum(position[axis] for position in found) / len(found) for axis in (0, 1)]


@pytest.mark.parametrize('theta', [0.0, 0.7, math.pi / 2.0, 2.5, math.pi, -1.2])
def test_the_head_points_along_theta_with_y_up(theta):
    column, row = skin(portrait(0, theta))
    assert math.remainder(math.atan2(-row, column) - theta, 2.0 * math.pi) == pytest.approx(0.0, abs=0.2)


def test_consecutive_turtles_differ_in_colour():
    middle = METRE // 2
    colours = {portrait(number, 0.0).getpixel((middle, middle)) for number in range(len(SHELLS))}
    assert len(colours) == len(SHELLS)


def test_a_turtle_is_drawn_at_its_position_with_y_up():
    field = Field((1, 2, 3))
    empty = field.picture()
    field.spawn('other', 2.0, 8.0, 0.0)
    left, top, right, bottom = ImageChops.difference(empty, field.picture()).getbbox()
    assert (left + right) / 2.0 == pytest.approx(2.0 * METRE, abs=1.5)
    assert (top + bottom) / 2.0 == pytest.approx(499 - 8.0 * METRE, abs=1.5)
    assert 35 < right - left <= METRE


def test_the_turtle_that_came_last_is_on_top():
    field = Field((1, 2, 3))
    field.spawn('over', *field.pose('turtle1'))
    colour = field.picture().getpixel((252, 250))
    field.kill('turtle1')
    assert field.picture().getpixel((252, 250)) == colour
    field.reset((1, 2, 3))
    assert field.picture().getpixel((252, 250)) != colour
