"""The window without a display: what the mouse has done, and which part of the map is shown."""

import math

import numpy as np
import pytest
from PyQt5.QtCore import QEvent, Qt
from pytest import approx
from windows import Opened, plan, robot, snapshot

from rumba_sim.model.geometry import Pose


def pixel(opened, x, y):
    """Where a place [m] is in the floor."""
    return opened.window.floor.view.to_pixel(x, y)


def test_a_click_sends_the_robot_there(opened):
    opened.drag(pixel(opened, 1.5, 2.5), pixel(opened, 1.5, 2.5))
    [(name, x, y)] = opened.actor.done
    assert (name, x, y) == ('go_to', approx(1.5, abs=0.01), approx(2.5, abs=0.01))
    opened.show(snapshot(robot(has_cleaner=False)))
    opened.drag(pixel(opened, 1.5, 2.5), pixel(opened, 1.5, 2.5))
    assert len(opened.actor.done) == 1 and 'no cleaner is running' in opened.window.floor.notice


def test_a_robot_that_is_dragged_is_put_there_turned_by_the_wheel(opened):
    start, end = pixel(opened, 0.5, 4.0), pixel(opened, 1.5, 2.5)
    opened.mouse(QEvent.MouseButtonPress, *start)
    opened.mouse(QEvent.MouseMove, *end)
    opened.wheel(*end, 2)
    opened.mouse(QEvent.MouseButtonRelease, *end)
    [(name, who, pose)] = opened.actor.done
    assert (name, who) == ('teleport', 'rumba')
    assert pose == approx((1.5, 2.5, math.radians(30.0)), abs=0.01)


def test_escape_lets_go_of_what_is_dragged(opened):
    opened.mouse(QEvent.MouseButtonPress, *pixel(opened, 0.5, 4.0))
    opened.mouse(QEvent.MouseMove, *pixel(opened, 1.5, 2.5))
    opened.type(Qt.Key_Escape)
    opened.mouse(QEvent.MouseButtonRelease, *pixel(opened, 1.5, 2.5))
    assert opened.actor.done == []


def test_a_click_on_a_robot_and_tab_take_it():
    opened = Opened(snapshot(robot(), robot('rumba2', Pose(1.8, 2.5, 1.0))))
    opened.drag(pixel(opened, 1.8, 2.5), pixel(opened, 1.8, 2.5))
    assert (opened.source.attended, opened.actor.done) == ([('rumba2', False)], [('attend', 'rumba2')])
    opened.show(snapshot(robot(), robot('rumba2'), selected='rumba2'))
    opened.type(Qt.Key_Tab)
    assert opened.source.attended[-1] == ('rumba', False)
    opened.show(snapshot(robot(), robot('rumba2'), selected='gone'))
    opened.type(Qt.Key_Tab)
    assert opened.source.attended[-1] == ('rumba', False)


@pytest.mark.parametrize('button', [Qt.MiddleButton, Qt.RightButton])
def test_the_map_moves_with_the_other_buttons_zooms_with_the_wheel_and_home_shows_all(opened, button):
    fitted = opened.window.floor.view
    opened.drag((100, 100), (130, 60), button)
    moved = opened.window.floor.view
    assert moved.to_pixel(0.0, 3.0) == approx([a + b for a, b in zip(fitted.to_pixel(0.0, 3.0), (30.0, -40.0))])
    opened.wheel(200, 150, 3)
    assert opened.window.floor.view.scale == approx(moved.scale * 1.2 ** 3)
    assert opened.window.floor.view.to_map(200, 150) == approx(moved.to_map(200, 150))
    opened.type(Qt.Key_Home)
    assert opened.window.floor.view == fitted
    assert opened.actor.done == []


def test_a_larger_window_shows_a_larger_map_unless_it_was_zoomed(opened):
    scale = opened.window.floor.view.scale
    opened.window.resize(1400, 1000)
    assert opened.window.floor.view.scale > 1.2 * scale
    opened.wheel(200, 150, 1)
    zoomed = opened.window.floor.view.scale
    opened.window.resize(900, 600)
    assert opened.window.floor.view.scale == zoomed


def test_another_map_is_shown_whole(opened):
    opened.wheel(200, 150, 5)
    other = plan(number=5)
    other.cells.setflags(write=True)
    opened.show(snapshot(robot(), plan=type(other)(np.tile(other.cells, (2, 2)), 0.1, 0.0, 0.0, 6), coverage=None))
    assert opened.window.floor.view.to_map(0, 0)[0] < 0.0 < 8.0 < opened.window.floor.view.to_map(
        opened.window.floor.width(), 0)[0]
