"""The field: turtles by name, their lines and their colour sensors."""

import math

import numpy as np
import pytest
from PIL import ImageChops

from turtlesim.model.canvas import Pen
from turtlesim.model.errors import TurtlesimError
from turtlesim.model.field import Field, topics
from turtlesim.model.turtles import EXTENT, METRE, PIXELS

BACKGROUND = (69, 86, 255)
PEN = (0xb3, 0xb8, 0xff)
RED = Pen((200, 10, 20), 5)
UP = Pen(is_down=False)


@pytest.fixture
def field():
    """A new field."""
    return Field(BACKGROUND)


def bare(field):
    """Return the drawing without turtles."""
    for name in field.names:
        field.kill(name)
    return field.picture()


def at(picture, x, y):
    """Return the colour of a picture at a position [m]."""
    return picture.getpixel((math.floor(METRE * x + 1e-6), math.floor(PIXELS - 1 - METRE * y + 1e-6)))


def drive(field, name, velocity, steps):
    """Drive a turtle for a number of steps."""
    for _ in range(steps):
        field.command(name, velocity)
        field.move()
        field.draw()


def coloured(picture, colour=BACKGROUND):
    """Return how many pixels differ from a colour."""
    return sum(1 for pixel in picture.getdata() if pixel != colour)


def test_turtle1_starts_in_the_middle(field):
    assert field.names == ['turtle1']
    assert field.pose('turtle1') == pytest.approx([5.544444, 5.544444, 0.0], abs=1e-6)
    assert field.readings().tolist() == [pytest.approx([5.544445, 5.544445, 0.0, 0.0, 0.0], abs=1e-5)]


def test_readings_hold_the_speed_in_any_direction_and_the_turn_rate(field):
    field.spawn('other', 2.0, 3.0, 1.0)
    field.command('other', (-3.0, 4.0, -0.5))
    field.move()
    assert field.readings()[1, 3:].tolist() == [5.0, -0.5]
    assert field.readings()[0, 3:].tolist() == [0.0, 0.0]


# --- names ------------------------------------------------------------------------------------------------------------

def test_names_are_numbered_and_numbers_are_not_used_twice(field):
    assert field.spawn('', 1.0, 1.0, 0.0) == 'turtle2'
    assert field.spawn('turtle3', 1.0, 1.0, 0.0) == 'turtle3'
    assert field.spawn('', 1.0, 1.0, 0.0) == 'turtle4'
    field.kill('turtle4')
    assert field.spawn('', 1.0, 1.0, 0.0) == 'turtle5'
    assert field.names == ['turtle1', 'turtle2', 'turtle3', 'turtle5']
    field.reset(BACKGROUND)
    assert field.names == ['turtle1'] and field.spawn('', 1.0, 1.0, 0.0) == 'turtle2'


@pytest.mark.parametrize('name, x, message', [
    ('turtle1', 1.0, r'A turtled named \[turtle1\] already exists'),
    ('turtle1/', 1.0, r'A turtled named \[turtle1/\] already exists'),
    ('two words', 1.0, "'two words' is not a valid name: must be at most 200 letters, digits, _ and /, and begin with "
                       'a letter or /'),
    ('7up', 1.0, "'7up' is not a valid name"), ('~x', 1.0, "'~x' is not a valid name"),
    (201 * 'x', 1.0, 'is not a valid name: must be at most 200'),
    ('schildkröte', 1.0, "'schildkröte' is not a valid name"),
    ('new', math.nan, 'spawn new: x is nan: must be a finite number')])
def test_a_bad_spawn_is_refused_and_changes_nothing(field, name, x, message):
    with pytest.raises(TurtlesimError, match=message):
        field.spawn(name, x, 1.0, 0.0)
    assert field.names == ['turtle1'] and field.spawn('', 1.0, 1.0, 0.0) == 'turtle2'


@pytest.mark.parametrize('name, prefix', [
    ('/abs', '/abs/'), ('a/', 'a/'), ('a//b', 'a/b/'), ('a/2', 'a/2/'), ('/', '/'), ('//a', '/a/')])
def test_slashes_in_names_are_accepted_as_by_turtlesim(field, name, prefix):
    assert field.spawn(name, 2.0, 3.0, 0.0) == name
    assert field.pose(name) == [2.0, 3.0, 0.0]
    assert topics(name) == prefix


def test_turtles_do_not_share_topics():
    field = Field(BACKGROUND, lambda name: name if name.startswith('/') else f'/{name}')
    with pytest.raises(TurtlesimError, match=r'A turtled named \[/turtle1\] already exists'):
        field.spawn('/turtle1', 1.0, 1.0, 0.0)
    field.spawn('/turtle2/', 1.0, 1.0, 0.0)
    assert field.spawn('', 1.0, 1.0, 0.0) == 'turtle3'


def test_an_unknown_turtle_is_refused_and_the_message_lists_the_turtles(field):
    field.spawn('bob', 1.0, 1.0, 0.0)
    with pytest.raises(TurtlesimError, match=(
            r'^Tried to kill turtle \[bib\], which does not exist: the turtles are turtle1, bob$')):
        field.kill('bib')
    message = r'^there is no turtle \[bib\]: the turtles are turtle1, bob$'
    for act in (lambda: field.teleport('bib', 1.0, 1.0, 0.0),
                lambda: field.set_pen('bib', UP), lambda: field.command('bib', (1.0, 0.0, 0.0))):
        with pytest.raises(TurtlesimError, match=message):
            act()
    assert 'bob' in field and 'bib' not in field


def test_the_others_keep_their_poses_pens_and_colours_when_one_is_killed(field):
    field.spawn('b', 2.0, 3.0, 0.0)
    field.spawn('c', 8.0, 9.0, 0.0)
    field.set_pen('c', RED)
    both = field.picture()
    field.kill('b')
    assert field.pose('c') == [8.0, 9.0, 0.0]
    assert at(field.picture(), 8.0, 9.0) == at(both, 8.0, 9.0) != BACKGROUND
    drive(field, 'c', (1.0, 0.0, 0.0), 60)
    assert at(bare(field), 8.5, 9.0) == RED.colour


# --- drawing ----------------------------------------------------------------------------------------------------------

def test_a_drive_draws_a_line_of_the_width_and_colour_of_the_pen_without_gaps(field):
    field.set_pen('turtle1', RED)
    drive(field, 'turtle1', (1.0, 0.0, 0.0), 125)
    picture = bare(field)
    start, end, row = 249, 249 + round(2.0 * METRE), 249
    for column in range(start, end + 1):
        assert [picture.getpixel((column, row + offset)) == RED.colour for offset in range(-3, 4)] == [
            False, True, True, True, True, True, False]
    assert picture.getpixel((start - 4, row)) == picture.getpixel((end + 4, row)) == BACKGROUND


def drawn_by_qt(steps, width):
    """Return where Qt draws lines as turtlesim has it do: array (PIXELS, PIXELS) of bool."""
    QtGui, QtCore = pytest.importorskip('PyQt5.QtGui'), pytest.importorskip('PyQt5.QtCore')
    image = QtGui.QImage(PIXELS, PIXELS, QtGui.QImage.Format_RGB32)
    image.fill(QtGui.QColor(*BACKGROUND))
    painter, pen = QtGui.QPainter(image), QtGui.QPen(QtGui.QColor(*PEN))
    pen.setWidth(width)
    painter.setPen(pen)
    points = [QtCore.QPointF(METRE * x, METRE * (EXTENT - y)) for x, y in steps]
    for start, end in zip(points, points[1:]):
        painter.drawLine(start, end)
    painter.end()
    data = image.constBits()
    data.setsize(image.byteCount())
    return (np.frombuffer(data, np.uint8).reshape(PIXELS, PIXELS, 4)[:, :, 2::-1] != BACKGROUND).any(axis=2)


@pytest.mark.parametrize('theta', [0.0, math.pi / 2, math.pi / 4, -math.pi / 4])
@pytest.mark.parametrize('width', [1, 3])
def test_a_line_is_where_turtlesim_draws_it(field, theta, width):
    field.set_pen('turtle1', Pen(PEN, width))
    field.teleport('turtle1', *field.pose('turtle1')[:2], theta)
    steps = [field.pose('turtle1')[:2]]
    for _ in range(63):
        drive(field, 'turtle1', (2.0, 0.0, 0.0), 1)
        steps.append(field.pose('turtle1')[:2])
    ours = (np.array(bare(field)) != BACKGROUND).any(axis=2)
    assert (ours ^ drawn_by_qt(steps, width)).sum() <= 8  # the ends differ


def test_a_slow_turtle_draws_the_same_line_as_a_fast_one(field):
    drive(field, 'turtle1', (0.05, 0.0, 0.0), 400)
    slow = bare(field)
    field.reset(BACKGROUND)
    drive(field, 'turtle1', (2.0, 0.0, 0.0), 10)
    assert ImageChops.difference(slow, bare(field)).getbbox() is None


def test_a_spawn_or_kill_between_move_and_draw_leaves_no_gap_in_the_lines_of_others(field):
    field.spawn('gone', 1.0, 1.0, 0.0)
    field.spawn('last', 1.0, 9.0, 0.0)
    field.command('last', (60.0, 0.0, 0.0))
    field.move()
    field.spawn('new', 9.0, 1.0, 0.0)
    field.kill('gone')
    field.draw()
    picture = bare(field)
    assert at(picture, 1.5, 9.0) == PEN
    assert coloured(picture) < 3 * 50


@pytest.mark.parametrize('width', [1, 2, 3, 8])
def test_a_curve_has_no_gap(field, width):
    field.set_pen('turtle1', Pen(PEN, width))
    positions = []
    for _ in range(200):
        drive(field, 'turtle1', (2.0, 0.0, 1.3), 1)
        positions.append(field.pose('turtle1')[:2])
    picture = bare(field)
    assert all(at(picture, x, y) == PEN for x, y in positions)


def test_a_pen_that_is_up_draws_nothing_and_starts_a_new_line_when_it_comes_down(field):
    field.set_pen('turtle1', UP)
    drive(field, 'turtle1', (1.0, 0.0, 0.7), 50)
    field.teleport('turtle1', 2.0, 9.0, 0.0)
    field.set_pen('turtle1', Pen())
    drive(field, 'turtle1', (1.0, 0.0, 0.0), 50)
    picture = bare(field)
    assert at(picture, 2.4, 9.0) == PEN
    assert coloured(picture) < 3 * METRE * 0.8 + 20


def test_a_teleport_draws_a_line_if_the_pen_is_down(field):
    field.teleport('turtle1', 8.0, 2.0, 1.0)
    assert field.pose('turtle1') == [8.0, 2.0, 1.0]
    middle = EXTENT / 2.0
    picture = bare(field)
    assert at(picture, 8.0, 2.0) == at(picture, middle, middle) == PEN
    assert at(picture, (8.0 + middle) / 2.0, (2.0 + middle) / 2.0) == PEN
    assert at(picture, 8.0, middle) == BACKGROUND


def test_a_relative_teleport_turns_first_then_goes(field):
    field.teleport('turtle1', 3.0, 4.0, 0.5)
    field.teleport_relative('turtle1', 2.0, 0.6)
    assert field.pose('turtle1') == pytest.approx([3.0 + 2.0 * math.cos(1.1), 4.0 + 2.0 * math.sin(1.1), 1.1])


@pytest.mark.parametrize('act, message', [
    (lambda field: field.teleport('turtle1', 1.0, math.inf, 0.0), '^teleport turtle1: y is inf: '),
    (lambda field: field.teleport_relative('turtle1', math.nan, 0.0), '^teleport turtle1: linear is nan: ')])
def test_a_teleport_with_a_bad_number_is_refused_and_changes_nothing(field, act, message):
    before = field.pose('turtle1')
    with pytest.raises(TurtlesimError, match=message):
        act(field)
    assert field.pose('turtle1') == before and coloured(bare(field)) == 0


def test_a_drive_spawn_or_teleport_beyond_a_wall_ends_there_and_is_a_hit(field):
    field.spawn('out', -3.0, 5.0, 0.0)
    field.teleport('turtle1', 99.0, 1.0, 0.0)
    assert field.hits == [('out', -3.0, EXTENT - 5.0), ('turtle1', 99.0, EXTENT - 1.0)]
    assert field.pose('out')[:2] == [0.0, 5.0] and field.pose('turtle1')[:2] == [EXTENT, 1.0]
    field.hits.clear()
    drive(field, 'turtle1', (0.0, -10.0, 0.0), 8)
    assert [hit.name for hit in field.hits] == ['turtle1'] * 2
    assert field.hits[0].y == pytest.approx(EXTENT - 1.0 + 7 * 0.16)  # from the top, as turtlesim has it
    assert at(bare(field), EXTENT, 0.0) == PEN


def test_a_line_along_every_wall_stays_in_the_picture(field):
    for x, y in ((0.0, 0.0), (EXTENT, 0.0), (EXTENT, EXTENT), (0.0, EXTENT), (0.0, 0.0)):
        field.teleport('turtle1', x, y, 0.0)
    picture = bare(field)
    assert {picture.getpixel(corner) for corner in ((0, 0), (0, 499), (499, 0), (499, 499), (250, 0))} == {PEN}


def test_clear_erases_lines_and_keeps_turtles_and_kill_keeps_lines(field):
    field.teleport('turtle1', 8.0, 2.0, 1.0)
    field.clear((1, 2, 3))
    assert field.pose('turtle1') == [8.0, 2.0, 1.0]
    assert coloured(bare(field), (1, 2, 3)) == 0
    field.reset(BACKGROUND)
    field.teleport('turtle1', 8.0, 2.0, 1.0)
    field.kill('turtle1')
    assert at(field.picture(), 8.0, 2.0) == PEN


def test_reset_restores_the_initial_field(field):
    field.set_pen('turtle1', RED)
    field.spawn('other', 1.0, 1.0, 0.0)
    drive(field, 'turtle1', (1.0, 0.0, 0.5), 20)
    field.reset((9, 8, 7))
    fresh = Field((9, 8, 7))
    assert (field.names, field.readings().tolist()) == (fresh.names, fresh.readings().tolist())
    assert ImageChops.difference(field.picture(), fresh.picture()).getbbox() is None
    drive(field, 'turtle1', (1.0, 0.0, 0.0), 5)
    assert at(bare(field), EXTENT / 2.0 + 0.04, EXTENT / 2.0) == PEN


# --- readings and pictures --------------------------------------------------------------------------------------------

def test_a_turtle_sees_the_colour_under_it(field):
    assert field.colour('turtle1') == BACKGROUND
    field.set_pen('turtle1', RED)
    field.teleport('turtle1', 8.0, 2.0, 0.0)
    field.spawn('other', 8.0, 9.0, -math.pi / 2.0)
    field.set_pen('other', UP)
    seen = {}
    for _ in range(450):
        drive(field, 'other', (1.0, 0.0, 0.0), 1)
        seen.setdefault(field.colour('other'), field.pose('other')[1])
    assert list(seen) == [BACKGROUND, RED.colour]
    assert seen[RED.colour] == pytest.approx(2.0, abs=0.1)


def test_a_turtle_that_moves_sees_the_colour_before_its_own_line(field):
    field.set_pen('turtle1', Pen(PEN, 2))
    field.command('turtle1', (10.0, 0.0, 0.0))
    field.move()
    assert field.colour('turtle1') == BACKGROUND
    field.draw()
    assert field.colour('turtle1') == PEN


def test_changes_grow_only_if_the_picture_may_have_changed(field):
    seen = field.changes
    for act in (lambda: drive(field, 'turtle1', (1.0, 0.0, 0.0), 1), lambda: field.spawn('b', 1.0, 1.0, 0.0),
                lambda: field.teleport('b', 2.0, 1.0, 0.0), lambda: field.kill('b'), lambda: field.clear(BACKGROUND),
                lambda: field.reset(BACKGROUND)):
        act()
        assert field.changes > seen
        seen = field.changes
    for _ in range(100):
        field.move()
        field.draw()
    assert field.changes == seen


# --- numbers ----------------------------------------------------------------------------------------------------------

def test_finite_numbers_of_any_size_are_obeyed(field):
    field.teleport('turtle1', 3e38, -3e38, 3e38)
    assert field.pose('turtle1')[:2] == [EXTENT, 0.0]
    assert abs(field.pose('turtle1')[2]) <= math.pi
    for velocity in ((1e308, 1e308, 0.0), (-1e308, 1e308, 1e308), (1e300, 0.0, -1e300)):
        drive(field, 'turtle1', velocity, 3)
        readings = field.readings()
        assert np.isfinite(readings).all()
        assert (readings[:, :2] >= 0.0).all() and (readings[:, :2] <= np.float32(EXTENT)).all()
    assert field.picture().size == (PIXELS, PIXELS)
