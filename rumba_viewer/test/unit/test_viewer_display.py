"""Why no window can be opened: found out before Qt would end the process."""

import tempfile

import pytest

from rumba_viewer.window import display


@pytest.mark.parametrize('attempt, patience, reason', [
    ('print(flush=True); import sys; sys.stdin.read()', 20.0, ''),
    ('import PyQt5_that_is_not_there', 20.0, 'PyQt5 is not installed: apt-get install python3-pyqt5'),
    ('import sys; sys.exit("qt.qpa.xcb: could not connect to display")', 20.0, 'the display :7 cannot be opened'),
    ('import time; time.sleep(60.0)', 0.3, 'the display :7 has not answered for 0.3 s')])
def test_another_process_tries_whether_a_display_can_be_opened(attempt, patience, reason, monkeypatch):
    monkeypatch.setattr(tempfile, 'tempdir', '/dev/null/nowhere')  # as if no file could be made
    monkeypatch.delenv('QT_QPA_PLATFORM', raising=False)
    monkeypatch.setenv('DISPLAY', ':7')
    monkeypatch.setattr(display, 'TRY', attempt)
    monkeypatch.setattr(display, 'PATIENCE', patience)
    with display.reached() as trouble:
        assert trouble.startswith(reason) and bool(trouble) is bool(reason)


def test_without_a_display_no_process_is_started(monkeypatch):
    for name in ('QT_QPA_PLATFORM', 'DISPLAY', 'WAYLAND_DISPLAY'):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(display, 'TRY', 'print(flush=True)')
    with display.reached() as trouble:
        assert trouble == 'there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set'


@pytest.mark.parametrize('arguments, style', [
    (['_style:=dark'], 'dark'), (['_robot:=rumba2', '_style:=light'], 'light'), ([], 'auto'),
    (['_style:=pink'], 'auto')])
def test_before_there_is_a_master_the_style_of_the_command_line_counts(monkeypatch, arguments, style):
    from rumba_viewer.ros import application
    monkeypatch.setattr('sys.argv', ['viewer', *arguments])
    assert application._given_style() == style
