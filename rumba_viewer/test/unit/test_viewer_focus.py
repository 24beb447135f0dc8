"""Tab leads through the buttons of the window, which leave the keys of the window to it; More shows rare ones."""

import pytest
from PyQt5.QtCore import QEvent, Qt
from PyQt5.QtGui import QKeyEvent
from windows import APPLICATION, Opened, count, robot, simulation, snapshot

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene.snapshot import Mission
from rumba_viewer.scene.theme import LIGHT

IDLE = Mission('idle', False, '', 'waits for a goal')


@pytest.fixture
def opened():
    """A window with two robots, in which nearly all buttons are available."""
    shown = Opened(snapshot(robot(mission=IDLE), robot('rumba2', Pose(1.8, 2.5, 1.0)), simulation=simulation()))
    shown.window.activateWindow()
    APPLICATION.processEvents()
    return shown


def type_key(opened, key, modifiers=Qt.NoModifier):
    """A key goes down and up in whatever has the focus."""
    for kind in (QEvent.KeyPress, QEvent.KeyRelease):
        APPLICATION.sendEvent(opened.window.focusWidget() or opened.window, QKeyEvent(kind, key, modifiers))
        APPLICATION.processEvents()


def tab_to(opened, widget):
    """Press Tab until something has the focus; returns whether that happened."""
    for _ in range(40):
        type_key(opened, Qt.Key_Tab)
        if opened.window.focusWidget() is widget:
            return True
    return False


def test_tab_reaches_each_button_that_is_available_and_each_list(opened):
    opened.window.act('more')
    panel = opened.window.panel
    wanted = [one for one in [*panel.buttons.values(), panel.strategies, panel.speeds] if one.isEnabled()]
    assert len(wanted) > 12
    for widget in wanted:
        assert tab_to(opened, widget), widget


@pytest.mark.parametrize('key', [Qt.Key_Space, Qt.Key_Return])
def test_space_and_enter_press_the_button_with_the_focus_and_nothing_else(opened, key):
    assert tab_to(opened, opened.window.panel.buttons['dock'])
    type_key(opened, key)
    assert [what for what, *_ in opened.actor.done] == ['dock']


def test_a_button_or_list_with_the_focus_leaves_the_arrows_and_letters_to_the_window(opened):
    panel = opened.window.panel
    for widget, keys in ((panel.buttons['dock'], (Qt.Key_Up, Qt.Key_W)), (panel.strategies, (Qt.Key_Left, Qt.Key_W))):
        assert tab_to(opened, widget)
        for key in keys:
            before = len(opened.actor.done)
            APPLICATION.sendEvent(widget, QKeyEvent(QEvent.KeyPress, key, Qt.NoModifier))
            assert opened.actor.done[before][0] == 'drive'
            assert opened.window.focusWidget() is widget
            opened.release(key)


def test_arrows_choose_in_a_list_with_the_focus(opened):
    assert tab_to(opened, opened.window.panel.strategies)
    type_key(opened, Qt.Key_Down)
    assert opened.window.panel.strategy == 'bounce' and opened.actor.done == []


def test_the_button_with_the_focus_has_a_frame(opened):
    clean = opened.window.panel.buttons['clean']
    before = count(clean.grab().toImage(), LIGHT.text)
    assert tab_to(opened, clean)
    assert count(clean.grab().toImage(), LIGHT.text) > before + clean.width()


def test_no_button_has_the_focus_before_tab_or_after_a_click(opened):
    assert opened.window.focusWidget() is opened.window
    opened.window.panel.buttons['path'].click()
    assert opened.window.focusWidget() is opened.window


def test_more_shows_the_buttons_for_time_and_robot_and_hides_them_again(opened):
    panel = opened.window.panel
    rare = [panel.buttons[name] for name in ('pause', 'step', 'brushes', 'next_robot', 'reset')] + [panel.speeds]
    assert not any(one.isVisible() for one in rare) and not panel.buttons['more'].isChecked()
    opened.type(Qt.Key_M)
    assert all(one.isVisible() for one in rare) and panel.buttons['more'].isChecked()
    APPLICATION.processEvents()
    assert not panel.buttons['reset'].visibleRegion().isEmpty()  # though the window is low
    opened.window.panel.buttons['more'].click()
    assert not any(one.isVisible() for one in rare)
