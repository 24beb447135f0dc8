"""The window without a display: what keys, buttons and mouse have done, and what it shows; no ROS runs here."""

import math
import re
import time

import numpy as np
import pytest
from PIL import Image
from pytest import approx

from rumba_sim.model.geometry import Pose
from rumba_sim.viewer.acts import ACTS, legend
from rumba_sim.viewer.recorder import WIDTH
from rumba_sim.viewer.snapshot import Battery, Dock, Place, Simulation, Snapshot
from rumba_sim.viewer.theme import DARK, LIGHT
from windows import APPLICATION, Opened, count, plan, robot, snapshot

from python_qt_binding.QtCore import QEvent, Qt

MISSING = 'Waiting for a simulator\nTo start one, in another terminal:\nroslaunch rumba_sim simulator.launch'


@pytest.fixture
def opened():
    """A window that shows one robot."""
    opened = Opened(snapshot(robot()))
    yield opened
    opened.window.close()


def drives(opened):
    """The commands so far [m/s], [rad/s], each once where it was repeated."""
    commands = [done[1:] for done in opened.actor.done if done[0] == 'drive']
    return [command for index, command in enumerate(commands) if index == 0 or commands[index - 1] != command]


@pytest.mark.parametrize('key, command', [
    (Qt.Key_Up, (0.3, 0.0)), (Qt.Key_W, (0.3, 0.0)), (Qt.Key_Down, (-0.3, 0.0)), (Qt.Key_S, (-0.3, 0.0)),
    (Qt.Key_Left, (0.0, 1.5)), (Qt.Key_A, (0.0, 1.5)), (Qt.Key_Right, (0.0, -1.5)), (Qt.Key_D, (0.0, -1.5))])
def test_a_key_drives_until_it_is_let_go(opened, key, command):
    opened.press(key)
    assert drives(opened) == [command]
    opened.release(key)
    assert drives(opened) == [command, (0.0, 0.0)]


def test_two_keys_drive_an_arc_and_backward_along_the_arc_that_forward_came_on(opened):
    opened.press(Qt.Key_Up)
    opened.press(Qt.Key_Left)
    opened.release(Qt.Key_Up, stays=False)
    while len(drives(opened)) < 3:
        APPLICATION.processEvents()
    opened.press(Qt.Key_Down)
    assert drives(opened) == [(0.3, 0.0), (0.3, 1.5), (0.0, 1.5), (-0.3, -1.5)]


def test_a_key_that_repeats_does_not_stop_in_between(opened):
    opened.press(Qt.Key_Up)
    opened.press(Qt.Key_Space)
    for _ in range(20):
        for key in (Qt.Key_Up, Qt.Key_Space):
            opened.release(key, stays=False)
            opened.press(key)
        time.sleep(0.005)
        APPLICATION.processEvents()
    assert drives(opened) == [(0.3, 0.0)]
    assert opened.actor.done.count(('pause',)) == 1
    opened.release(Qt.Key_Space, stays=False)
    opened.release(Qt.Key_Up)
    assert drives(opened) == [(0.3, 0.0), (0.0, 0.0)]


def test_a_key_counts_by_what_it_was_when_it_went_down_whatever_is_held_beside_it_later(opened):
    opened.press(Qt.Key_W)
    opened.release(Qt.Key_W, stays=False)
    opened.press(Qt.Key_W, modifiers=Qt.ControlModifier)
    opened.release(Qt.Key_W)
    assert drives(opened) == [(0.3, 0.0), (0.0, 0.0)]
    assert opened.window.isVisible()
    opened.type(Qt.Key_W, Qt.ControlModifier)
    assert not opened.window.isVisible()


def test_after_the_last_key_zero_is_said_a_few_times_then_nothing(opened):
    opened.press(Qt.Key_Up)
    opened.release(Qt.Key_Up)
    for _ in range(10):
        opened.window._command()
    zeros = [done for done in opened.actor.done if done == ('drive', 0.0, 0.0)]
    assert len(zeros) == 3


def test_a_window_that_is_no_longer_in_front_or_closes_stops_the_robot(opened):
    for leave in (lambda: opened.window.event(QEvent(QEvent.WindowDeactivate)), opened.window.close):
        opened.actor.done.clear()
        opened.press(Qt.Key_Up)
        leave()
        assert drives(opened) == [(0.3, 0.0), (0.0, 0.0)]
        opened.release(Qt.Key_Up)


def test_who_drives_takes_the_robot_over_from_the_cleaner_once(opened):
    opened.press(Qt.Key_Up)
    opened.release(Qt.Key_Up)
    assert [done[0] for done in opened.actor.done][0] == 'cancel'
    opened.actor.done.clear()
    opened.show(snapshot(robot(mission=None)))
    opened.type(Qt.Key_Up)
    assert ('cancel',) not in opened.actor.done


def test_nobody_drives_where_there_is_no_robot():
    opened = Opened(Snapshot(plan=plan(), missing=MISSING))
    opened.type(Qt.Key_Up)
    assert opened.actor.done == []


@pytest.mark.parametrize('key, modifiers, done', [
    (Qt.Key_C, Qt.NoModifier, ('clean', '')), (Qt.Key_H, Qt.NoModifier, ('dock',)),
    (Qt.Key_U, Qt.NoModifier, ('undock',)), (Qt.Key_Escape, Qt.NoModifier, ('cancel',)),
    (Qt.Key_Space, Qt.NoModifier, ('pause',)), (Qt.Key_B, Qt.NoModifier, ('set_brushes_up', True)),
    (Qt.Key_R, Qt.ControlModifier, ('reset',)), (Qt.Key_Plus, Qt.ShiftModifier, ('set_speed', 5.0)),
    (Qt.Key_Equal, Qt.NoModifier, ('set_speed', 5.0)), (Qt.Key_Minus, Qt.NoModifier, ('set_speed', 1.0)),
    (Qt.Key_R, Qt.NoModifier, None), (Qt.Key_S, Qt.AltModifier, ('drive', -0.3, 0.0)), (Qt.Key_X, Qt.NoModifier, None)])
def test_each_key_has_its_deed(opened, key, modifiers, done):
    opened.press(key, modifiers=modifiers)
    assert [one for one in opened.actor.done if one != ('cancel',) or done == one] == ([done] if done else [])


@pytest.mark.parametrize('name, done', [
    ('clean', ('clean', 'spiral')), ('dock', ('dock',)), ('undock', ('undock',)), ('cancel', ('cancel',)),
    ('pause', ('pause',)), ('brushes', ('set_brushes_up', True)), ('reset', ('reset',))])
def test_each_button_has_its_deed(opened, name, done):
    opened.window.panel.strategies.setCurrentText('spiral')
    opened.window.panel.buttons[name].click()
    assert opened.actor.done == [done]


def test_while_time_stands_still_it_can_be_stepped_and_goes_on(opened):
    assert not opened.window.panel.buttons['step'].isEnabled()
    opened.show(snapshot(robot(), simulation=Simulation(0.0, 2.0, True, True, 83.0, True)))
    opened.window.panel.buttons['step'].click()
    assert opened.window.panel.buttons['pause'].text() == 'Resume'
    opened.type(Qt.Key_Space)
    assert opened.actor.done == [('step',), ('resume',)]


def test_brushes_that_are_up_come_down(opened):
    opened.show(snapshot(robot(brushes_up=True)))
    opened.type(Qt.Key_B)
    assert opened.actor.done == [('set_brushes_up', False)]


@pytest.mark.parametrize('wanted, key, speed', [
    (0.0, Qt.Key_Minus, 50.0), (50.0, Qt.Key_Plus, 0.0), (0.0, Qt.Key_Plus, 0.0), (0.5, Qt.Key_Minus, 0.5),
    (3.0, Qt.Key_Plus, 5.0), (7.0, Qt.Key_Minus, 5.0)])
def test_plus_and_minus_go_through_the_speeds_and_all_it_can_is_the_last(opened, wanted, key, speed):
    opened.show(snapshot(robot(), simulation=Simulation(2.0, wanted, False, True, 83.0, True)))
    opened.type(key)
    assert opened.actor.done == [('set_speed', speed)]


def test_the_list_of_speeds_shows_what_is_wanted_and_sets_it(opened):
    speeds = opened.window.panel.speeds
    assert speeds.currentText() == '2 \u00d7'
    speeds.activated.emit(speeds.findText('all it can'))
    assert opened.actor.done == [('set_speed', 0.0)]


NO_DOCK = Place(is_known=True)
DOCK = Place(Dock(Pose(0.0, 0.0, 0.0), np.zeros((3, 2)), np.zeros((3, 2))), is_known=True)
REAL = Simulation(1.0, 1.0, False, False, 83.0, True)


@pytest.mark.parametrize('shown, name, reason', [
    (Snapshot(), 'clean', 'no simulator is running: roslaunch rumba_sim simulator.launch'),
    (Snapshot(), 'pause', 'no simulator is running: roslaunch rumba_sim simulator.launch'),
    (snapshot(robot(has_cleaner=False)), 'clean', 'no cleaner is running: rosrun rumba_sim cleaner'),
    (snapshot(robot('rumba2', has_cleaner=False), selected='rumba2'), 'undock', '_robot:=rumba2'),
    (snapshot(robot('rumba2')), 'brushes', 'there is no rumba: Tab takes another robot'),
    (snapshot(robot(), place=NO_DOCK), 'dock', 'this map has no dock'),
    (snapshot(robot(mission=None)), 'cancel', 'the cleaner does nothing'),
    (snapshot(robot()), 'step', 'time is running: pause it first'),
    (snapshot(robot()), 'next_robot', 'there is no other robot')])
def test_what_cannot_be_done_is_grey_and_says_why_by_button_and_by_key(shown, name, reason):
    opened = Opened(shown)
    button = opened.window.panel.buttons[name]
    assert not button.isEnabled()
    assert reason in button.toolTip()
    opened.window.act(name)
    assert opened.actor.done == []
    assert reason in opened.window.floor.notice


@pytest.mark.parametrize('shown, name', [
    (snapshot(robot(), place=DOCK), 'dock'), (snapshot(robot()), 'dock'), (snapshot(robot()), 'cancel'),
    (snapshot(robot(), robot('rumba2')), 'next_robot'), (snapshot(robot(mission=None)), 'clean')])
def test_what_can_be_done_is_not_grey(shown, name):
    assert Opened(shown).window.panel.buttons[name].isEnabled()


def test_speed_can_change_only_where_time_is_simulated():
    opened = Opened(snapshot(robot(), simulation=REAL))
    assert not opened.window.panel.speeds.isEnabled()
    assert 'time is real: start the simulator with another speed' in opened.window.panel.speeds.toolTip()
    opened.type(Qt.Key_Minus)
    assert opened.actor.done == [] and 'time is real' in opened.window.floor.notice


# --- the mouse -----------------------------------------------------------------------------------------------------

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


# --- what is shown -------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('style, theme', [('light', LIGHT), ('dark', DARK)])
@pytest.mark.parametrize('share, state, colour', [
    (0.6, 'on battery', 'good'), (0.2, 'on battery', 'warning'), (0.05, 'on battery', 'bad'),
    (0.05, 'charging', 'good')])
@pytest.mark.parametrize('size', [(640, 480), (1920, 1080)])
def test_the_bar_of_the_battery_is_as_long_as_its_charge(share, state, colour, style, theme, size):
    opened = Opened(snapshot(robot(battery=Battery(share, 15.0, -1.0, state))), style, size)
    card = opened.window.panel.card
    image = card.grab().toImage()
    wanted = getattr(theme, colour)
    rows = [count(image, wanted, 0, row, None, row + 1) for row in range(40, 110)]
    assert max(rows) == approx(share * (card.width() - 24), abs=4)


def test_the_card_and_the_floor_fill_a_small_window_and_all_buttons_can_be_reached():
    opened = Opened(snapshot(robot()), size=(640, 480))
    assert opened.window.floor.width() > 300
    panel = opened.window.panel
    last = panel.buttons['legend']
    assert last.mapTo(panel.widget(), last.rect().bottomLeft()).y() < panel.widget().height()
    panel.ensureWidgetVisible(last)
    assert panel.viewport().rect().contains(last.mapTo(panel.viewport(), last.rect().center()))


@pytest.mark.parametrize('style, theme', [('light', LIGHT), ('dark', DARK)])
@pytest.mark.parametrize('size', [(640, 480), (1180, 720)])
def test_the_legend_comes_and_goes_with_its_key(style, theme, size):
    opened = Opened(snapshot(robot()), style, size)
    without = opened.picture()
    opened.type(Qt.Key_F1)
    shown = opened.window.floor.grab().toImage()
    assert count(shown, theme.card, tolerance=20) > 0.2 * shown.width() * shown.height()
    opened.type(Qt.Key_F1)
    assert opened.picture() == without


def test_every_act_has_a_key_of_its_own_and_stands_in_the_legend():
    keys = [act.key for act in ACTS]
    assert len(set(keys)) == len(keys)
    assert {act.tip for act in ACTS} <= {text for _, text in legend()}


def test_what_the_actor_has_to_say_is_shown(opened):
    before = opened.window.floor.grab().toImage()
    opened.actor.notices.put('dock: done')
    opened.window.update_picture()
    assert opened.window.floor.notice == 'dock: done'
    assert count(opened.window.floor.grab().toImage(), LIGHT.text) > count(before, LIGHT.text) + 500


def test_what_is_missing_is_shown_until_it_is_there():
    opened = Opened(Snapshot(missing=MISSING))
    empty = opened.window.floor.grab().toImage()
    assert count(empty, LIGHT.text, tolerance=40) > 100
    opened.show(snapshot(robot()))
    assert count(opened.window.floor.grab().toImage(), LIGHT.swept) > 10_000


# --- pictures ------------------------------------------------------------------------------------------------------

def test_a_picture_is_saved_under_a_new_name_each_time(tmp_path):
    opened = Opened(snapshot(robot()), folder=str(tmp_path))
    opened.type(Qt.Key_S, Qt.ControlModifier)
    assert re.fullmatch(rf'saved {tmp_path}/rumba-[\d-]+.png', opened.window.floor.notice)
    opened.window.save_anywhere()
    pictures = list(tmp_path.iterdir())
    assert len(pictures) == 2
    assert {Image.open(picture).size for picture in pictures} == {(900, 600)}


def test_where_a_picture_cannot_be_saved_the_window_says_so(tmp_path):
    (tmp_path / 'file').write_text('')
    opened = Opened(snapshot(robot()), folder=str(tmp_path / 'file'))
    opened.type(Qt.Key_S, Qt.ControlModifier)
    assert opened.window.floor.notice.startswith('not saved: ')


def test_a_record_is_a_gif_of_the_floor_as_it_was(tmp_path):
    opened = Opened(snapshot(robot()), folder=str(tmp_path), size=(1300, 700))
    opened.type(Qt.Key_G, Qt.ControlModifier)
    assert opened.window.panel.buttons['record'].isChecked()
    for x in (0.0, 1.0, 2.0):
        opened.show(snapshot(robot(pose=Pose(x, 3.5, 0.0))))
        opened.window._record_picture()
    opened.window.resize(700, 700)
    opened.window._record_picture()
    opened.type(Qt.Key_G, Qt.ControlModifier)
    [(_, recorder, path)] = [done for done in opened.actor.done if done[0] == 'write']
    recorder.write(path)
    gif = Image.open(path)
    assert (gif.n_frames, gif.size[0]) == (4, WIDTH)
    frames = []
    for index in range(3):
        gif.seek(index)
        frames.append(np.asarray(gif.convert('RGB')).astype(int))
    middles = [np.argwhere(abs(frame - (52, 59, 69)).max(axis=2) < 25)[:, 1].mean() for frame in frames]
    assert middles[0] < middles[1] < middles[2]
