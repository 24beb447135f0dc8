"""The window without a display: what keys and buttons have done; no ROS runs here."""

import time

import numpy as np
import pytest
from PyQt5.QtCore import QEvent, Qt
from windows import APPLICATION, MISSING, Opened, plan, robot, snapshot

from rumba_sim.model.geometry import Pose
from rumba_viewer.scene.snapshot import Dock, Place, Simulation, Snapshot


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
    (snapshot(robot(has_cleaner=False)), 'clean', 'no cleaner is running: rosrun rumba_cleaning cleaner'),
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
