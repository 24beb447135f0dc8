"""A window that waits for a master can be ended from the moment in which it shows."""

import os
import signal
import sys

import pytest
from windows import APPLICATION

from rumba_viewer.ros.application import Application
from rumba_viewer.window.window import Window


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_window_that_is_interrupted_as_it_shows_ends_without_a_traceback(monkeypatch, number):
    show = Window.show

    def interrupted(window):
        show(window)
        os.kill(os.getpid(), number)
    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:9')
    monkeypatch.setattr(Window, 'show', interrupted)
    monkeypatch.setattr(sys, 'excepthook', sys.excepthook)
    handlers = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    application = Application()
    try:
        with pytest.raises(SystemExit) as end:
            application.wait_for_master()
    finally:
        for each, handler in handlers.items():
            signal.signal(each, handler)
    assert end.value.code == 0 and application._qt is APPLICATION
