"""The live line stays in the last row of a terminal, and nothing that others print is glued to it or lost."""

import os
import re

import pytest

from rumba_viewer.ros.console.bottom_line import BottomLine

TOKEN = re.compile('\x1b\\[[0-9;]*[A-Za-z]|\x1b[78]|.', re.DOTALL)


class Screen:
    """A small terminal: what it shows of what is written to it."""

    def __init__(self, columns, rows):
        self.columns, self.rows = columns, [''] * rows
        self.row = self.column = 0
        self.top, self.bottom = 0, rows - 1
        self.saved = (0, 0)

    def feed(self, text):
        for token in TOKEN.findall(text):
            if token == '\x1b7':
                self.saved = self.row, self.column
            elif token == '\x1b8':
                self.row, self.column = self.saved
            elif token.startswith('\x1b['):
                self._control(token[-1], [int(number) for number in re.findall(r'\d+', token)])
            elif token == '\r':
                self.column = 0
            elif token == '\n':
                self._down()
            else:
                assert self.column < self.columns, 'the line is broken'
                line = self.rows[self.row].ljust(self.column)
                self.rows[self.row] = line[:self.column] + token + line[self.column + 1:]
                self.column += 1

    def _down(self):
        self.column = 0
        if self.row == self.bottom:
            del self.rows[self.top]
            self.rows.insert(self.bottom, '')
        else:
            self.row = min(self.row + 1, len(self.rows) - 1)

    def _control(self, letter, numbers):
        if letter == 'H':
            self.row, self.column = numbers[0] - 1, numbers[1] - 1
        elif letter == 'A':
            self.row = max(self.row - numbers[0], 0)
        elif letter == 'K':
            self.rows[self.row] = '' if numbers == [2] else self.rows[self.row][:self.column]
        else:
            assert letter == 'r'
            self.top, self.bottom = (numbers[0] - 1, numbers[1] - 1) if numbers else (0, len(self.rows) - 1)
            self.row = self.column = 0


@pytest.fixture
def terminal(monkeypatch):
    """A function that opens a terminal of a size: the screen, the bottom line, and what updates the screen."""
    def opened(columns, rows):
        monkeypatch.setenv('COLUMNS', str(columns))
        monkeypatch.setenv('LINES', str(rows))
        screen = Screen(columns, rows)
        theirs, ours = os.pipe()
        ends.extend([theirs, ours])
        return screen, BottomLine(ours), lambda: screen.feed(os.read(theirs, 65536).decode())
    ends = []
    yield opened
    for end in ends:
        os.close(end)


@pytest.mark.parametrize('before', [0, 2, 9])
def test_log_lines_scroll_above_the_live_line(terminal, before):
    screen, bottom, update = terminal(20, 6)
    screen.feed(''.join(f'old {number}\n' for number in range(before)))
    for number in range(8):
        bottom.show([f'live {number}'])
        update()
        screen.feed(f'log {number}\n')
        assert screen.rows[-1] == f'live {number}'
        assert f'log {number}' in screen.rows[:-1]
    assert screen.rows == ['log 4', 'log 5', 'log 6', 'log 7', '', 'live 7']


def test_the_longest_live_line_that_fits_is_shown_or_one_is_cut(terminal):
    screen, bottom, update = terminal(12, 5)
    bottom.show(['99.0 % swept and more'])
    update()
    assert screen.rows[-1] == '99.0 % swep'
    bottom.show(['99.0 % swept and more', '99.0 % now', '99 %'])
    update()
    assert screen.rows[-1] == '99.0 % now'


def test_a_report_stays_above_the_live_line(terminal):
    screen, bottom, update = terminal(20, 6)
    bottom.show(['live'])
    bottom.say(['one', 'two'])
    update()
    assert [line for line in screen.rows if line] == ['one', 'two', 'live'] and screen.rows[-1] == 'live'


def test_at_the_end_the_row_is_given_back(terminal):
    screen, bottom, update = terminal(20, 5)
    bottom.show(['live'])
    bottom.close()
    update()
    screen.feed(''.join(f'{number}\n' for number in range(9)))
    assert screen.rows == ['5', '6', '7', '8', '']


def test_a_terminal_that_changes_its_size_gets_the_line_in_its_new_last_row(terminal, monkeypatch):
    screen, bottom, update = terminal(20, 6)
    bottom.show(['live'])
    update()
    monkeypatch.setenv('LINES', '8')
    screen.rows += ['', '']
    bottom.show(['live again'])
    update()
    screen.feed('log\n' * 9)
    assert screen.rows[-1] == 'live again' and screen.rows[:2] == ['log'] * 2


def test_a_terminal_of_few_rows_has_no_live_line(terminal):
    screen, bottom, update = terminal(20, 3)
    bottom.show(['live'])
    bottom.say(['said'])
    update()
    assert screen.rows == ['said', '', '']
