"""The window shows the picture pixel by pixel; if no window can be opened, a few words say why."""

import subprocess
import sys

import pytest
from PIL import Image, ImageChops

from turtlesim import window
from turtlesim.model.field import Field

SHOW = '''
import sys
from PIL import Image
from turtlesim.window import Window
shown = Window('a field')
for path in sys.argv[2:]:
    shown.show(Image.open(path).convert('RGB'))
    shown.poll()
shown._label.grab().save(sys.argv[1])
assert shown.is_open
shown._label.close()
assert not shown.is_open
'''


@pytest.fixture(autouse=True)
def no_display(monkeypatch):
    """An environment without a display."""
    for name in window.DISPLAYS:
        monkeypatch.delenv(name, raising=False)


def test_it_shows_the_last_picture_pixel_by_pixel(tmp_path, monkeypatch):
    monkeypatch.setenv('QT_QPA_PLATFORM', 'offscreen')
    assert window.why_none() == ''
    field = Field((10, 20, 200))
    field.picture().save(tmp_path / 'first.png')
    field.teleport('turtle1', 2.0, 9.0, 0.5)
    field.picture().save(tmp_path / 'second.png')
    paths = [str(tmp_path / name) for name in ('shown.png', 'first.png', 'second.png')]
    # In a process of its own: Qt ends a process if it cannot use its display.
    subprocess.run([sys.executable, '-c', SHOW, *paths], check=True, timeout=60.0)
    shown = Image.open(paths[0]).convert('RGB')
    assert shown.size == (500, 500)
    assert ImageChops.difference(shown, field.picture()).getbbox() is None
    assert shown.getpixel((450, 450)) == (10, 20, 200) and shown.getpixel((90, 94)) != (10, 20, 200)


def test_without_a_display_there_is_none(monkeypatch):
    assert window.why_none() == 'there is no display'
    assert not window.is_unseen()


def test_a_display_that_does_not_answer_is_a_reason(monkeypatch):
    monkeypatch.setenv('DISPLAY', ':987')
    assert window.why_none() == 'Qt cannot use the display :987'


def test_without_qt_there_is_none(monkeypatch):
    monkeypatch.setenv('QT_QPA_PLATFORM', 'offscreen')
    monkeypatch.setattr(window.importlib.util, 'find_spec', lambda _: None)
    assert window.why_none() == 'PyQt5 is not installed'


@pytest.mark.parametrize('platform, is_unseen', [('offscreen', True), ('minimal:x', True), ('xcb', False)])
def test_platforms_that_show_nothing_are_known(monkeypatch, platform, is_unseen):
    monkeypatch.setenv('QT_QPA_PLATFORM', platform)
    assert window.is_unseen() == is_unseen


def test_qt_s_platform_is_taken_off_the_command_line(monkeypatch):
    monkeypatch.setenv('QT_QPA_PLATFORM', 'xcb')
    arguments = ['turtlesim_node', '-platform', 'offscreen', '_speed:=2']
    window.take_platform(arguments)
    assert arguments == ['turtlesim_node', '_speed:=2'] and window.is_unseen()
    window.take_platform(arguments)
    assert arguments == ['turtlesim_node', '_speed:=2']
