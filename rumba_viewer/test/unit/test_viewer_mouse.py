"""The window without a display: what the mouse does, and which part of the map is shown."""

import math
import re

import numpy as np
import pytest
from PyQt5.QtCore import QEvent, Qt
from pytest import approx
from windows import Opened, count, plan, robot, snapshot

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene.theme import robot_colour


def pixel(opened, x, y):
    """The pixel of the floor that shows a point [m]."""
    return opened.window.floor.view.to_pixel(x, y)


def test_a_click_shows_a_target_and_how_to_go_there_and_sends_nothing(opened):
    before = opened.window.floor.grab().toImage()
    opened.click(*pixel(opened, 1.5, 2.5))
    assert opened.window.snapshot.target == approx((1.5, 2.5), abs=0.01)
    assert re.fullmatch(r'Target 1\.\d+, 2\.\d+ m: double click or Enter sends rumba there, Esc clears it',
                        opened.window.floor.notice)
    across, down = (round(coordinate) for coordinate in pixel(opened, 1.5, 2.5))
    area = across - 20, down - 20, across + 20, down + 20
    colour = robot_colour('rumba')
    assert count(opened.window.floor.grab().toImage(), colour, *area) > count(before, colour, *area) + 60
    assert opened.actor.done == []


GO_THERE = pytest.mark.parametrize('go', [
    lambda opened: opened.double_click(*pixel(opened, 1.5, 2.5)),
    lambda opened: (opened.click(*pixel(opened, 1.5, 2.5)), opened.type(Qt.Key_Return)),
    lambda opened: (opened.click(*pixel(opened, 1.5, 2.5)), opened.type(Qt.Key_Enter, Qt.KeypadModifier)),
    lambda opened: (opened.click(*pixel(opened, 1.5, 2.5)), opened.window.panel.buttons['go_there'].click())],
    ids=['double click', 'return', 'enter', 'button'])


@GO_THERE
def test_a_double_click_enter_or_the_button_sends_the_robot_there_once(opened, go):
    go(opened)
    [(name, x, y)] = opened.actor.done
    assert (name, x, y) == ('go_to', approx(1.5, abs=0.01), approx(2.5, abs=0.01))
    assert 'Sent rumba to 1.5' in opened.window.floor.notice
    assert 'Go there: Resume cleaning [R] continues the cleaning later' in opened.window.floor.notice
    assert opened.window.snapshot.target is None
    opened.type(Qt.Key_Return)
    assert len(opened.actor.done) == 1


@GO_THERE
def test_without_a_cleaner_there_is_no_target_and_the_window_tells_why(go):
    opened = Opened(snapshot(robot(has_cleaner=False)))
    go(opened)
    assert opened.actor.done == [] and opened.window.snapshot.target is None
    assert 'Go there: no cleaner is running' in opened.window.floor.notice


def test_another_click_moves_the_target_and_it_stays_when_there_are_news(opened):
    opened.click(*pixel(opened, 1.5, 2.5))
    opened.click(*pixel(opened, 0.5, 3.0))
    opened.show(snapshot(robot()))
    assert opened.window.snapshot.target == approx((0.5, 3.0), abs=0.01)
    assert opened.window.floor.notice.count('Target') == 1


def test_escape_clears_the_target_first_and_cancels_only_the_second_time(opened):
    opened.click(*pixel(opened, 1.5, 2.5))
    opened.type(Qt.Key_Escape)
    assert opened.window.snapshot.target is None and opened.actor.done == []
    assert opened.window.floor.notice == ''
    opened.type(Qt.Key_Escape)
    assert opened.actor.done == [('cancel',)]


def test_a_double_click_on_a_robot_selects_it():
    opened = Opened(snapshot(robot(), robot('rumba2', Pose(1.8, 2.5, 1.0))))
    opened.double_click(*pixel(opened, 1.8, 2.5))
    assert set(opened.actor.done) == {('select', 'rumba2')}


def test_a_dragged_robot_is_put_there_turned_by_the_wheel(opened):
    start, end = pixel(opened, 0.5, 4.0), pixel(opened, 1.5, 2.5)
    opened.mouse(QEvent.MouseButtonPress, *start)
    opened.mouse(QEvent.MouseMove, *end)
    opened.wheel(*end, 2)
    opened.mouse(QEvent.MouseButtonRelease, *end)
    [(name, who, pose)] = opened.actor.done
    assert (name, who) == ('teleport', 'rumba')
    assert pose == approx((1.5, 2.5, math.radians(30.0)), abs=0.01)


def test_escape_ends_a_drag_without_effect(opened):
    opened.mouse(QEvent.MouseButtonPress, *pixel(opened, 0.5, 4.0))
    opened.mouse(QEvent.MouseMove, *pixel(opened, 1.5, 2.5))
    opened.type(Qt.Key_Escape)
    opened.mouse(QEvent.MouseButtonRelease, *pixel(opened, 1.5, 2.5))
    assert opened.actor.done == []


def test_a_click_on_a_robot_and_t_select_it():
    opened = Opened(snapshot(robot(), robot('rumba2', Pose(1.8, 2.5, 1.0))))
    opened.drag(pixel(opened, 1.8, 2.5), pixel(opened, 1.8, 2.5))
    assert (opened.source.selected, opened.actor.done) == ([('rumba2', False)], [('select', 'rumba2')])
    opened.show(snapshot(robot(), robot('rumba2'), selected='rumba2'))
    opened.type(Qt.Key_T)
    assert opened.source.selected[-1] == ('rumba', False)
    opened.show(snapshot(robot(), robot('rumba2'), selected='gone'))
    opened.type(Qt.Key_T)
    assert opened.source.selected[-1] == ('rumba', False)


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


def test_another_map_is_shown_whole_and_without_the_target(opened):
    opened.click(*pixel(opened, 1.5, 2.5))
    opened.wheel(200, 150, 5)
    other = plan(number=5)
    other.cells.setflags(write=True)
    opened.show(snapshot(robot(), plan=type(other)(np.tile(other.cells, (2, 2)), 0.1, 0.0, 0.0, 6), coverage=None))
    assert opened.window.snapshot.target is None
    assert opened.window.floor.view.to_map(0, 0)[0] < 0.0 < 8.0 < opened.window.floor.view.to_map(
        opened.window.floor.width(), 0)[0]
