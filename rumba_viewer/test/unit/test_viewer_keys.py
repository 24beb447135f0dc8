"""The window without a display: what keys and buttons make the actor do; no ROS runs here."""

import time

import numpy as np
import pytest
from PyQt5.QtCore import QEvent, Qt
from windows import APPLICATION, MISSING, Opened, plan, robot, simulation, snapshot

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene.snapshot import YIELDING, Dock, MapFeatures, Mission, Snapshot
from rumba_viewer.window import window

IDLE = Mission('idle', False, '', 'waits for a goal')
RETURNING = Mission('returning', True, '', 'drives to the dock')
RUNNING = [('pause', '/simulator')]


def drives(opened):
    """The commands so far [m/s], [rad/s], without those that repeat the one before."""
    commands = [done[1:] for done in opened.actor.done if done[0] == 'drive']
    return [command for index, command in enumerate(commands) if index == 0 or commands[index - 1] != command]


@pytest.mark.parametrize('key, command', [
    (Qt.Key_Up, (0.3, 0.0)), (Qt.Key_W, (0.3, 0.0)), (Qt.Key_Down, (-0.3, 0.0)), (Qt.Key_S, (-0.3, 0.0)),
    (Qt.Key_Left, (0.0, 1.5)), (Qt.Key_A, (0.0, 1.5)), (Qt.Key_Right, (0.0, -1.5)), (Qt.Key_D, (0.0, -1.5))])
def test_a_key_drives_until_it_is_released(opened, key, command):
    opened.press(key)
    assert drives(opened) == [command]
    opened.release(key)
    assert drives(opened) == [command, (0.0, 0.0)]


def test_two_keys_drive_an_arc_and_backward_along_the_same_arc(opened):
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
    assert [done for done in opened.actor.done if done[0] == 'pause'] == RUNNING
    opened.release(Qt.Key_Space, stays=False)
    opened.release(Qt.Key_Up)
    assert drives(opened) == [(0.3, 0.0), (0.0, 0.0)]


def test_a_key_keeps_its_meaning_if_a_modifier_is_held_later(opened):
    opened.press(Qt.Key_W)
    opened.release(Qt.Key_W, stays=False)
    opened.press(Qt.Key_W, modifiers=Qt.ControlModifier)
    opened.release(Qt.Key_W)
    assert drives(opened) == [(0.3, 0.0), (0.0, 0.0)]
    assert opened.window.isVisible()
    opened.type(Qt.Key_W, Qt.ControlModifier)
    assert not opened.window.isVisible()


def test_after_the_last_key_a_few_zeros_are_published_then_nothing(opened):
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


def test_driving_cancels_no_goal_and_tells_that_the_cleaner_waits(opened):
    opened.press(Qt.Key_Up)
    opened.release(Qt.Key_Up)
    assert {done[0] for done in opened.actor.done} == {'drive'}
    assert opened.window.floor.notice == 'You drive: the cleaner waits, and goes on when you let go'


def test_driving_without_a_goal_tells_nothing():
    opened = Opened(snapshot(robot(mission=IDLE)))
    opened.type(Qt.Key_Up)
    assert drives(opened) and opened.window.floor.notice == ''


def test_driving_a_fallen_robot_tells_why_it_does_not_move():
    opened = Opened(snapshot(robot(has_fallen=True)))
    opened.press(Qt.Key_Up)
    assert opened.window.floor.notice == 'rumba has fallen over a cliff and cannot drive: drag it elsewhere'


def test_keys_drive_nothing_if_there_is_no_robot():
    opened = Opened(Snapshot(plan=plan(), missing=MISSING))
    opened.type(Qt.Key_Up)
    assert opened.actor.done == []


@pytest.mark.parametrize('key, modifiers, done', [
    (Qt.Key_C, Qt.NoModifier, ('clean', '')), (Qt.Key_R, Qt.NoModifier, ('resume_cleaning',)),
    (Qt.Key_H, Qt.NoModifier, ('dock',)), (Qt.Key_U, Qt.NoModifier, ('undock',)),
    (Qt.Key_Space, Qt.NoModifier, ('pause', '/simulator')), (Qt.Key_B, Qt.NoModifier, ('set_brushes_up', True)),
    (Qt.Key_Plus, Qt.ShiftModifier, ('set_speed', '/simulator', 5.0)),
    (Qt.Key_Equal, Qt.NoModifier, ('set_speed', '/simulator', 5.0)),
    (Qt.Key_Minus, Qt.NoModifier, ('set_speed', '/simulator', 1.0)),
    (Qt.Key_S, Qt.AltModifier, ('drive', -0.3, 0.0)), (Qt.Key_X, Qt.NoModifier, None)])
def test_each_key_does_what_it_stands_for(key, modifiers, done):
    opened = Opened(snapshot(robot(mission=IDLE)))
    opened.press(key, modifiers=modifiers)
    assert opened.actor.done == ([done] if done else [])


@pytest.mark.parametrize('name, done', [
    ('clean', ('clean', 'spiral')), ('resume_cleaning', ('resume_cleaning',)), ('dock', ('dock',)),
    ('undock', ('undock',)), ('pause', ('pause', '/simulator')), ('brushes', ('set_brushes_up', True))])
def test_each_button_does_what_it_stands_for(name, done):
    opened = Opened(snapshot(robot(mission=IDLE)))
    opened.window.panel.strategies.setCurrentText('spiral')
    opened.window.panel.buttons[name].click()
    assert opened.actor.done == [done]


def test_escape_and_the_button_cancel_a_goal(opened):
    opened.type(Qt.Key_Escape)
    opened.window.panel.buttons['cancel'].click()
    assert opened.actor.done == [('cancel',)] * 2


@pytest.mark.parametrize('name', ['dock', 'undock', 'cancel'])
def test_what_interrupts_a_cleaning_tells_how_to_continue_it(opened, name):
    hint = 'Resume cleaning [R] continues the cleaning later'
    opened.window.act(name)
    assert hint in opened.window.floor.notice
    other = Opened(snapshot(robot(mission=RETURNING)))
    other.window.act(name)
    assert hint not in other.window.floor.notice
    assert opened.actor.done == other.actor.done == [(name,)]


def test_reset_must_be_asked_for_twice(opened):
    opened.type(Qt.Key_R, Qt.ControlModifier)
    assert opened.actor.done == []
    assert opened.window.floor.notice == ('Reset: what was cleaned is forgotten and the robots are put back; '
                                          'press it again to confirm')
    opened.type(Qt.Key_R, Qt.ControlModifier)
    assert opened.actor.done == [('reset', '/simulator')]
    opened.window.panel.buttons['reset'].click()
    opened.window.panel.buttons['reset'].click()
    assert opened.actor.done == [('reset', '/simulator')] * 2


def test_a_second_reset_does_not_count_after_another_key_or_a_long_time(opened, monkeypatch):
    opened.window.act('reset')
    opened.window.act('brushes')
    opened.window.act('reset')
    monkeypatch.setattr(window, 'CONFIRM', -1.0)
    opened.window.act('brushes')
    opened.window.act('reset')
    opened.window.act('reset')
    assert ('reset', '/simulator') not in opened.actor.done


def test_while_time_is_paused_it_can_be_stepped_and_unpaused(opened):
    assert not opened.window.panel.buttons['step'].isEnabled()
    opened.show(snapshot(robot(), simulation=simulation(speed=0.0, is_paused=True)))
    opened.window.panel.buttons['step'].click()
    assert opened.window.panel.buttons['pause'].text() == 'Unpause'
    opened.type(Qt.Key_Space)
    assert opened.actor.done == [('step', '/simulator'), ('unpause', '/simulator')]


def test_services_are_those_of_the_node_that_tells_the_state():
    opened = Opened(snapshot(robot(), simulation=simulation(node='/house/sim2')))
    opened.type(Qt.Key_Space)
    opened.type(Qt.Key_Plus)
    assert opened.actor.done == [('pause', '/house/sim2'), ('set_speed', '/house/sim2', 5.0)]


def test_brushes_that_are_up_are_lowered(opened):
    opened.show(snapshot(robot(brushes_up=True)))
    opened.type(Qt.Key_B)
    assert opened.actor.done == [('set_brushes_up', False)]


@pytest.mark.parametrize('wanted, key, speed', [
    (0.0, Qt.Key_Minus, 50.0), (50.0, Qt.Key_Plus, 0.0), (0.0, Qt.Key_Plus, 0.0), (0.5, Qt.Key_Minus, 0.5),
    (3.0, Qt.Key_Plus, 5.0), (7.0, Qt.Key_Minus, 5.0)])
def test_plus_and_minus_go_through_the_speeds_and_the_maximum_is_the_last(opened, wanted, key, speed):
    opened.show(snapshot(robot(), simulation=simulation(wanted=wanted)))
    opened.type(key)
    assert opened.actor.done == [('set_speed', '/simulator', speed)]


def test_the_list_of_speeds_shows_the_wanted_speed_and_sets_another(opened):
    speeds = opened.window.panel.speeds
    assert speeds.currentText() == '2 \u00d7'
    speeds.activated.emit(speeds.findText('maximum'))
    assert opened.actor.done == [('set_speed', '/simulator', 0.0)]


NO_DOCK = MapFeatures(is_known=True)
DOCK = MapFeatures((Dock(Pose(0.0, 0.0, 0.0), np.zeros((3, 2)), np.zeros((3, 2))),), is_known=True)
REAL = simulation(speed=1.0, wanted=1.0, is_simulated=False)
TURTLE = simulation(node='/turtlesim_body', speed=1.0, wanted=None, services=frozenset({'reset'}))


@pytest.mark.parametrize('shown, name, reason', [
    (Snapshot(), 'clean', 'no simulator is running: roslaunch rumba_sim simulator.launch'),
    (Snapshot(), 'pause', 'no simulator is running: roslaunch rumba_sim simulator.launch'),
    (snapshot(robot(), simulation=TURTLE), 'pause', '/turtlesim_body has no service pause'),
    (snapshot(robot(), simulation=TURTLE), 'step', '/turtlesim_body has no service step'),
    (snapshot(robot(has_cleaner=False)), 'clean', 'no cleaner is running: rosrun rumba_cleaning cleaner'),
    (snapshot(robot('rumba2', has_cleaner=False), selected='rumba2'), 'undock', '_robot:=rumba2'),
    (snapshot(robot('rumba2')), 'brushes', 'there is no rumba: T selects another robot'),
    (snapshot(robot(), features=NO_DOCK), 'dock', 'this map has no dock'),
    (snapshot(robot()), 'clean', 'rumba is already cleaning: cancel that first'),
    (snapshot(robot()), 'resume_cleaning', 'rumba is already cleaning: cancel that first'),
    (snapshot(robot(mission=Mission(YIELDING, True, 'bounce', ''))), 'clean', 'rumba is already cleaning'),
    (snapshot(robot(mission=IDLE, can_resume=False)), 'resume_cleaning', 'no cleaning was interrupted'),
    (snapshot(robot()), 'go_there', 'there is no target: click on the floor first'),
    (snapshot(robot(mission=None)), 'cancel', 'the cleaner has no goal'),
    (snapshot(robot()), 'step', 'time is running: pause it first'),
    (snapshot(robot()), 'next_robot', 'there is no other robot')])
def test_what_is_not_available_is_grey_and_its_button_and_key_tell_why(shown, name, reason):
    opened = Opened(shown)
    button = opened.window.panel.buttons[name]
    assert not button.isEnabled()
    assert reason in button.toolTip()
    opened.window.act(name)
    assert opened.actor.done == []
    assert reason in opened.window.floor.notice


@pytest.mark.parametrize('shown, name', [
    (snapshot(robot(), features=DOCK), 'dock'), (snapshot(robot()), 'dock'), (snapshot(robot()), 'cancel'),
    (snapshot(robot(), robot('rumba2')), 'next_robot'), (snapshot(robot(mission=None)), 'clean'),
    (snapshot(robot(mission=IDLE)), 'resume_cleaning'),
    (snapshot(robot(mission=IDLE, can_resume=True)), 'resume_cleaning'),
    (snapshot(robot(mission=RETURNING, can_resume=True)), 'resume_cleaning'),
    (snapshot(robot(), simulation=TURTLE), 'reset')])
def test_what_is_available_is_not_grey(shown, name):
    assert Opened(shown).window.panel.buttons[name].isEnabled()


@pytest.mark.parametrize('time_of, reason', [
    (REAL, 'time is real: start the simulator with another speed'), (TURTLE, '/turtlesim_body has no service tuning')])
def test_the_speed_can_change_only_if_the_simulator_can_change_it(time_of, reason):
    opened = Opened(snapshot(robot(), simulation=time_of))
    assert not opened.window.panel.speeds.isEnabled()
    assert reason in opened.window.panel.speeds.toolTip()
    opened.type(Qt.Key_Minus)
    assert opened.actor.done == [] and reason in opened.window.floor.notice
