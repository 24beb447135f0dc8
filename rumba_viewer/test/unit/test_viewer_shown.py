"""The window without a display: what it shows and saves, in several sizes and both styles."""

import math
import re

import numpy as np
import pytest
from PIL import Image
from PyQt5.QtCore import Qt
from PyQt5.QtGui import QFontMetrics, QFontMetricsF
from pytest import approx
from windows import BOTTOM, LEFT, MISSING, Opened, count, robot, simulation, snapshot

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.painting import paint_status
from rumba_viewer.scene.acts import ACTS, legend
from rumba_viewer.scene.snapshot import YIELDING, Battery, Cleaning, Mission, Snapshot
from rumba_viewer.scene.theme import DARK, LIGHT
from rumba_viewer.window import notices
from rumba_viewer.window.recorder import WIDTH


@pytest.mark.parametrize('style, theme', [('light', LIGHT), ('dark', DARK)])
@pytest.mark.parametrize('share, state, colour', [
    (0.6, 'on battery', 'good'), (0.2, 'on battery', 'warning'), (0.05, 'on battery', 'bad'),
    (0.05, 'charging', 'good')])
@pytest.mark.parametrize('size', [(640, 480), (1920, 1080)])
def test_the_length_of_the_battery_bar_is_the_charge(share, state, colour, style, theme, size):
    opened = Opened(snapshot(robot(battery=Battery(share, 15.0, -1.0, state))), style, size)
    card = opened.window.panel.card
    image = card.grab().toImage()
    wanted = getattr(theme, colour)
    rows = [count(image, wanted, 0, row, None, row + 1) for row in range(40, 110)]
    assert max(rows) == approx(share * (card.width() - 24), abs=4)


def test_a_small_window_shows_card_and_floor_and_its_panel_scrolls_to_every_button():
    opened = Opened(snapshot(robot()), size=(640, 480))
    assert opened.window.floor.width() > 300
    panel = opened.window.panel
    last = panel.buttons['legend']
    assert last.mapTo(panel.widget(), last.rect().bottomLeft()).y() < panel.widget().height()
    panel.ensureWidgetVisible(last)
    assert panel.viewport().rect().contains(last.mapTo(panel.viewport(), last.rect().center()))


@pytest.mark.parametrize('size', [(640, 480), (1180, 720)])
def test_the_text_of_every_button_fits(size):
    opened = Opened(snapshot(robot(), simulation=simulation(is_paused=True)), size=size)
    opened.window.act('record')
    opened.window.act('laser')
    for button in opened.window.panel.buttons.values():
        icon = 0 if button.icon().isNull() else button.iconSize().width() + 4
        assert QFontMetrics(button.font()).horizontalAdvance(button.text()) + icon + 2 <= button.width(), button.text()


@pytest.mark.parametrize('style, theme', [('light', LIGHT), ('dark', DARK)])
@pytest.mark.parametrize('size', [(640, 480), (1180, 720)])
def test_the_legend_is_shown_and_hidden_by_its_key(style, theme, size):
    opened = Opened(snapshot(robot()), style, size)
    without = opened.picture()
    opened.type(Qt.Key_F1)
    shown = opened.window.floor.grab().toImage()
    assert count(shown, theme.card, tolerance=20) > 0.2 * shown.width() * shown.height()
    opened.type(Qt.Key_F1)
    assert opened.picture() == without


def test_every_act_has_its_own_key_and_is_in_the_legend():
    keys = [act.key for act in ACTS]
    assert len(set(keys)) == len(keys)
    assert {act.tip for act in ACTS} <= {text for _, text in legend()}


def test_notices_of_the_actor_are_shown(opened):
    before = opened.window.floor.grab().toImage()
    opened.actor.notices.put('dock: done')
    opened.window.update_picture()
    assert opened.window.floor.notice == 'dock: done'
    assert count(opened.window.floor.grab().toImage(), LIGHT.text) > count(before, LIGHT.text) + 500


def test_the_last_notices_are_shown_below_each_other_and_each_only_once(opened):
    for notice in ('one', 'two', 'one', 'three'):
        opened.window.tell(notice)
    assert opened.window.floor.notice == 'one\nthree'


def test_a_notice_ends_after_a_while(opened, monkeypatch):
    opened.window.tell('lasts')
    monkeypatch.setattr(notices, 'DURATION', -1.0)
    opened.window.tell('ends')
    opened.window.update_picture()
    assert opened.window.floor.notice == 'lasts'


@pytest.mark.parametrize('shown, colour', [
    (robot(mission=Mission(YIELDING, True, 'bounce', 'a person drives')), 'warning'),
    (robot(), 'good'), (robot(has_fallen=True), 'bad')])
def test_the_pill_of_the_card_has_the_colour_of_the_state(shown, colour):
    image = Opened(snapshot(shown)).window.panel.card.grab().toImage()
    found = {name: count(image, getattr(LIGHT, name), 120, 0, None, 30) for name in ('good', 'warning', 'bad')}
    assert found[colour] > 500
    assert sum(found.values()) == found[colour]


@pytest.mark.parametrize('state, colour', [('charging', 'good'), ('full', 'good'), ('on battery', 'faint_text')])
def test_an_idle_robot_that_is_charged_says_so_in_its_pill(state, colour):
    idle = robot(mission=Mission('idle', False, '', ''), battery=Battery(0.6, 15.0, 1.0, state))
    image = Opened(snapshot(idle)).window.panel.card.grab().toImage()
    assert count(image, getattr(LIGHT, colour), 120, 0, None, 30) > 400


def test_the_list_of_speeds_shows_a_present_speed_that_it_does_not_offer():
    opened = Opened(snapshot(robot(), simulation=simulation(wanted=15.0)))
    speeds = opened.window.panel.speeds
    assert (speeds.currentText(), speeds.count()) == ('15 \u00d7', 9)
    speeds.activated.emit(speeds.findText('20 \u00d7'))
    assert opened.actor.done == [('set_speed', '/simulator', 20.0)]
    opened.show(snapshot(robot(), simulation=simulation(wanted=20.0)))
    assert (speeds.currentText(), speeds.count()) == ('20 \u00d7', 8)


HIGHEST = LEFT, BOTTOM + 3.0  # [m] a corner of the map
REPORT = ('rumba: 99.0 % of the floor is swept', '42:48, 294.1 m driven')


def test_the_report_of_a_mission_is_a_card_until_it_is_dismissed():
    opened = Opened(snapshot(robot(report=REPORT)))
    shown = opened.window.floor.grab().toImage()
    assert count(shown, LIGHT.card, 60, 12, None, 120) > 20_000
    top = opened.window.floor.view.to_pixel(*HIGHEST)[1]
    assert count(shown, LIGHT.card, 60, math.ceil(top), None, math.ceil(top) + 60) < 100, 'it covers the map'
    opened.click(300, 40)
    assert opened.window.snapshot.target is None, 'the click went to the floor'
    hidden = opened.window.floor.grab().toImage()
    assert hidden == Opened(snapshot(robot())).window.floor.grab().toImage() != shown
    opened.show(snapshot(robot(report=(*REPORT, 'another'))))
    assert opened.window.floor.grab().toImage() != hidden
    opened.type(Qt.Key_Escape)
    assert opened.window.floor.grab().toImage() == hidden and ('cancel',) not in opened.actor.done


def test_the_button_shows_how_long_the_record_is(opened):
    opened.window.act('record')
    for _ in range(17):
        opened.window.pictures.add_frame()
    opened.window.update_picture()
    assert opened.window.panel.buttons['record'].text() == '0:02'
    opened.window.act('record')
    assert opened.window.panel.buttons['record'].text() == 'Record'


def test_the_rows_of_the_card_are_never_cut():
    """With the widest values of a day: what stands on the left and on the right leaves a gap."""
    far = Pose(-123.45, -123.45, math.radians(-179.0))
    day = robot(pose=far, elapsed=86399.0, left=7199.0, cleaning=Cleaning(1.0, 2888.8, 2888.8, 0.8, 8888.8),
                mission=Mission('cleaning', True, 'boustrophedon', ''))
    opened = Opened(snapshot(day, simulation=simulation(time=86399.0, speed=188.8, wanted=50.0)))
    card = opened.window.panel.card
    metrics = QFontMetricsF(paint_status._fonts(card.font())[1])
    for name, value in paint_status._rows(day, opened.window.snapshot.simulation):
        assert metrics.horizontalAdvance(f'{name} {value}') <= card.width() - 2.0 * paint_status.EDGE, (name, value)


def test_volts_and_amperes_are_shown_once_and_a_trouble_is_shown():
    cards = [Opened(snapshot(robot(message=message))).window.panel.card.grab().toImage()
             for message in ('15.5 V, 1.70 A, discharging', '', 'bumper pressed left')]
    assert cards[0] == cards[1] != cards[2]


def test_a_yielding_robot_is_told_in_the_card_in_place_of_its_last_message():
    missions = [Mission(state, True, 'bounce', message) for state, message in (
        (YIELDING, 'drives straight'), (YIELDING, 'turns'), ('cleaning', 'drives straight'))]
    cards = [Opened(snapshot(robot(mission=mission))).window.panel.card.grab().toImage() for mission in missions]
    assert cards[0] == cards[1] != cards[2]


def test_what_the_window_waits_for_is_shown_until_it_is_there():
    opened = Opened(Snapshot(missing=MISSING))
    empty = opened.window.floor.grab().toImage()
    assert count(empty, LIGHT.text, tolerance=40) > 100
    opened.show(snapshot(robot()))
    assert count(opened.window.floor.grab().toImage(), LIGHT.floor.swept) > 10_000


# --- pictures ------------------------------------------------------------------------------------------------------

def test_each_picture_is_saved_under_a_new_name(tmp_path):
    opened = Opened(snapshot(robot()), folder=str(tmp_path))
    opened.type(Qt.Key_S, Qt.ControlModifier)
    assert re.fullmatch(rf'saved {tmp_path}/rumba-[\d-]+.png', opened.window.floor.notice)
    opened.window.pictures.save_anywhere()
    pictures = list(tmp_path.iterdir())
    assert len(pictures) == 2
    assert {Image.open(picture).size for picture in pictures} == {(900, 600)}


def test_a_picture_that_cannot_be_saved_is_told(tmp_path):
    (tmp_path / 'file').write_text('')
    opened = Opened(snapshot(robot()), folder=str(tmp_path / 'file'))
    opened.type(Qt.Key_S, Qt.ControlModifier)
    assert opened.window.floor.notice.startswith('not saved: ')


def test_a_record_is_a_gif_of_the_floor(tmp_path):
    opened = Opened(snapshot(robot()), folder=str(tmp_path), size=(1300, 700))
    for timer in opened.window._timers:  # they would add frames on a busy machine
        timer.stop()
    opened.type(Qt.Key_G, Qt.ControlModifier)
    assert opened.window.panel.buttons['record'].isChecked()
    for x in (0.0, 1.0, 2.0):
        opened.show(snapshot(robot(pose=Pose(x, 3.5, 0.0))))
        opened.window.pictures.add_frame()
    opened.window.resize(700, 700)
    opened.window.pictures.add_frame()
    opened.type(Qt.Key_G, Qt.ControlModifier)
    [(_, recorder, path)] = [done for done in opened.actor.done if done[0] == 'write']
    recorder.write(path)
    gif = Image.open(path)
    assert (gif.n_frames, gif.size[0]) == (4, WIDTH)
    frames = []
    for index in range(3):
        gif.seek(index)
        frames.append(np.asarray(gif.convert('RGB')).astype(int))
    middles = [np.argwhere(abs(frame - (52, 59, 69)).max(axis=2) < 8)[:, 1].mean() for frame in frames]
    assert middles[0] < middles[1] < middles[2]


# --- the text of the card --------------------------------------------------------------------------------------------

@pytest.fixture
def written(monkeypatch):
    """A function that shows a snapshot, and returns the texts of the card."""
    def write(shown):
        texts = []
        monkeypatch.setattr(paint_status._Card, '_text', lambda _, area, text, *rest: texts.append(text))
        opened = Opened(shown)
        texts.clear()
        opened.window.panel.card.grab()
        return texts
    return write


@pytest.mark.parametrize('speed, wanted, text', [
    (1.94, 2.0, '1.9 of 2 \u00d7 real time'), (0.0, 0.004, '0.004 \u00d7 real time'),
    (0.02, 0.004, '0.004 \u00d7 real time'), (0.0, 2.0, '0.0 of 2 \u00d7 real time'),
    (140.2, 0.0, '140 (maximum) \u00d7 real time')])
def test_the_speed_is_never_shown_as_zero_only_because_a_tick_takes_longer_than_a_second(written, speed, wanted, text):
    assert text in written(snapshot(robot(), simulation=simulation(speed=speed, wanted=wanted)))


def test_of_what_the_mission_says_the_account_of_its_own_is_left_out(written, monkeypatch):
    lines = []
    monkeypatch.setattr(paint_status._Card, '_small_lines', lambda _, text, *rest: lines.append(text))
    for message in ('98.9 % swept; 31 m of the plan to go', '98.9 % swept', 'planning'):
        written(snapshot(robot(mission=Mission('cleaning', True, 'bounce', message))))
    assert {line for line in lines if '31' in line or 'swept' in line or 'plan' in line} == {
        '31 m of the plan to go', 'planning'}


def test_what_is_unknown_is_a_dash(written):
    unknown = robot(battery=Battery(math.nan, math.nan, math.nan, ''),
                    cleaning=Cleaning(math.nan, math.nan, math.nan, math.nan, math.nan))
    texts = written(snapshot(unknown))
    assert {'- V  ', '- of - m\u00b2', '- m, brushes down'} <= set(texts)
    assert not [text for text in texts if 'nan' in text]
