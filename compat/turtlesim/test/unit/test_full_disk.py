"""A log that cannot be written."""

import errno
import logging
import os

from turtlesim.ros import node


class FullDisk:
    """A file that cannot grow."""

    def write(self, _):
        """Fail."""
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_full_disk_gives_one_line_instead_of_a_traceback_for_each_message(monkeypatch, capfd):
    monkeypatch.setattr(logging.Handler, 'handleError', logging.Handler.handleError)
    node._log_trouble_once('turtlesim')
    handler = logging.StreamHandler(FullDisk())
    for _ in range(3):
        handler.handle(logging.makeLogRecord({'msg': 'text'}))
    assert capfd.readouterr().err == ('turtlesim: cannot write the log: [Errno 28] No space left on device; the node '
                                      'goes on without it\n')
