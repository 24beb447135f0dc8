"""A terminal of some columns, and the last line that a program shows in it."""

import codecs
import fcntl
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import threading

CODES = re.compile('\x1b\\][^\x07]*\x07|\x1b[78]|\x1b\\[[0-9;?]*[A-Za-z]')  # titles, colours, places
ROWS = 24


class Terminal:
    """A program in a terminal of its own."""

    def __init__(self, command, columns):
        """Start a command in a terminal of so many columns; end it with `close`."""
        self.columns, self._shown = columns, ''
        self._master, side = pty.openpty()
        fcntl.ioctl(side, termios.TIOCSWINSZ, struct.pack('HHHH', ROWS, columns, 0, 0))
        self._process = subprocess.Popen(command, stdin=side, stdout=side, stderr=side, start_new_session=True,
                                         env={**os.environ, 'TERM': 'xterm'})
        os.close(side)
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        decoder = codecs.getincrementaldecoder('utf-8')('replace')
        while True:
            try:
                self._shown += decoder.decode(os.read(self._master, 4096))
            except OSError:  # the program has ended
                return

    def line(self):
        """The last line that it shows."""
        lines = [line.strip() for line in re.split('[\r\n]', CODES.sub('\n', self._shown))]
        return next((line for line in reversed(lines) if line), '')

    def close(self):
        """End the program."""
        self._process.send_signal(signal.SIGINT)
        self._process.wait()
        os.close(self._master)
