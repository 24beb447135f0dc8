"""The window without a display: what it shows and saves, in several sizes and both styles."""

import re

import numpy as np
import pytest
from PIL import Image
from PyQt5.QtCore import Qt
from pytest import approx
from windows import MISSING, Opened, count, robot, snapshot

from rumba_sim.model.geometry import Pose
from rumba_viewer.scene.acts import ACTS, legend
from rumba_viewer.scene.snapshot import Battery, Snapshot
from rumba_viewer.scene.theme import DARK, LIGHT
from rumba_viewer.window.recorder import WIDTH


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
