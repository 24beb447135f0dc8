"""The consoles of a lesson: what its README says that a reader types, and what the terminals then show.

A fence with `file=PATH` after its language is for the reader's editor: test/edits.py says what it means.

Each ```console fence is a terminal of its own; they are played in order, and all stay open until the last is done.
  $ COMMAND   is typed into a shell; what follows is all that the command prints
  > ANSWER    a prompt of the command, and what is typed there
  ^C          Ctrl-C is pressed
  ...         on a line of its own: any lines, or none; within a line: any text
The next command, or fence, begins when all of that has been seen. A command whose last line is `...` may run on until
the lesson is over; any other must have ended. Every command must end well, exit code 0, unless Ctrl-C ended it.
"""

import codecs
import contextlib
import os
import pathlib
import pty
import re
import shlex
import signal
import threading
from typing import Callable, List, NamedTuple, Union

from edits import edited
from workspaces import BUILD_TIMEOUT, ROOT, TIMEOUT, Space

FENCE = re.compile(r'^```(?:console|\w+ file=(\S+))\n(.*?)^```$', re.MULTILINE | re.DOTALL)
MARK = '\x1d'  # no program prints it: on both sides of the last exit code, it is the shell's prompt
PROMPT = re.compile(f'{MARK}(\\d+){MARK}')
OF_TERMINALS = re.compile('\x1b\\][^\x07]*\x07|\x1b\\[[0-9;?]*[A-Za-z]')  # titles and colours
REPORTED = 40  # lines at the beginning, and at the end
BUILDS = re.compile('catkin_make|catkin build|pip install')  # commands that take longer than others
ANY_LINES, CTRL_C, ANSWER = '...', '^C', '> '


class Command(NamedTuple):
    """A command of a fence, and the lines that stand below it."""

    text: str
    lines: List[str]


class Edit(NamedTuple):
    """A part of a file as a reader writes it, and the path of the file, which may begin with ~."""

    path: str
    box: str


def sessions(readme: pathlib.Path) -> List[List[Command]]:
    """The commands of each console fence of a README."""
    return [step for step in steps(readme) if not isinstance(step, Edit)]


def steps(readme: pathlib.Path) -> List[Union[List[Command], Edit]]:
    """The console fences and the edits of a README, in order."""
    return [Edit(path, text) if path else _commands(text) for path, text in FENCE.findall(readme.read_text())]


def _commands(fence: str) -> List[Command]:
    commands: List[Command] = []
    for line in fence.splitlines():
        if line.startswith('$ '):
            commands.append(Command(line[2:], []))
        else:
            commands[-1].lines.append(line.rstrip())
    return commands


def play(readme: pathlib.Path, space: Space) -> None:
    """Do what a README says, as its reader does; raises AssertionError if a terminal shows something else."""
    with contextlib.ExitStack() as stack:
        terminals = []
        for step in steps(readme):
            if isinstance(step, Edit):
                _edit(step, space)
                continue
            terminals.append(stack.enter_context(contextlib.closing(Terminal(space))))
            for command in step:
                terminals[-1].run(command)
        # The first ends last: as a rule the master runs there.
        for some in (terminals[1:], terminals[:1]):
            for terminal in some:
                terminal.interrupt()
            for terminal in some:
                terminal.wait_for_end()


def _edit(edit: Edit, space: Space) -> None:
    """Write a file of the reader as a box shows it."""
    path = pathlib.Path(space.run(f'echo {edit.path}').strip())
    path.write_text(edited(path.read_text() if path.exists() else '', edit.box))


class Terminal:
    """An interactive shell on a terminal of its own."""

    def __init__(self, space: Space) -> None:
        """Open it in the root of the repository."""
        self._keyboard, theirs = pty.openpty()
        shell = f'env HISTFILE= PS1={shlex.quote(MARK + "$?" + MARK)} setsid --ctty bash --norc --noediting -i'
        self._shell = space.start(shell, cwd=ROOT, stdin=theirs, stdout=theirs, stderr=theirs)
        os.close(theirs)
        self._command = Command('', [])
        self._screen = ''
        self._news = threading.Condition()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def run(self, command: Command) -> None:
        """Type a command, and see that the terminal shows what it should.

        Raises:
            AssertionError: it shows something else, or the command failed.
        """
        self._wait_until(self._has_ended, 'a prompt of the shell')
        self._command = command
        with self._news:
            self._screen = ''
        self._type(command.text + '\n')
        for number, line in enumerate(command.lines):
            if line.startswith(ANSWER):
                self._wait_for(self._pattern(number) + re.escape(ANSWER))
                self._type(line[len(ANSWER):] + '\n')
            elif line.startswith(CTRL_C):
                self._wait_for(self._pattern(number))
                self._type('\x03')
        if self._may_run_on():
            self._wait_for(self._pattern())
        else:
            self._wait_until(self._has_ended, 'the end of the command, or `...` as its last line')
        self._check_end()

    def interrupt(self) -> None:
        """Press Ctrl-C, if the command, which must not have failed, still runs."""
        self._check_end()
        if not self._has_ended():
            self._type('\x03')

    def wait_for_end(self) -> None:
        """Wait until nothing runs there."""
        self._wait_until(self._has_ended, 'the end of the command, by Ctrl-C')

    def close(self) -> None:
        """End the shell, and by force whatever does not end."""
        if not self._has_ended():
            self._signal(signal.SIGINT)
            with contextlib.suppress(AssertionError):
                self._wait_until(self._has_ended, 'the end')
        self._signal(signal.SIGKILL)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._shell.pid, signal.SIGKILL)
        self._shell.wait()
        self._reader.join()
        os.close(self._keyboard)

    def _signal(self, number: int) -> None:
        """To the group of processes in the foreground."""
        with contextlib.suppress(OSError):
            group = os.tcgetpgrp(self._keyboard)
            if group > 0:  # 0: the shell has gone, and killpg would take it for our own group
                os.killpg(group, number)

    def _read(self) -> None:
        decoder = codecs.getincrementaldecoder('utf-8')('replace')
        with contextlib.suppress(OSError):  # all that had the terminal open has ended
            while True:
                text = decoder.decode(os.read(self._keyboard, 65536))
                with self._news:
                    self._screen += text
                    self._news.notify()

    def _type(self, keys: str) -> None:
        os.write(self._keyboard, keys.encode())

    def _shown(self) -> str:
        """What the command has printed."""
        text = OF_TERMINALS.sub('', self._screen).replace('\r\n', '\n')
        return PROMPT.split(text)[0].partition(self._command.text + '\n')[2]

    def _has_ended(self) -> bool:
        return PROMPT.search(self._screen) is not None

    def _may_run_on(self) -> bool:
        return self._command.lines[-1:] == [ANY_LINES]

    def _pattern(self, number: int = -1) -> str:
        """The lines that stand below the command, or the first of them, as a pattern."""
        return ''.join(map(_as_pattern, self._command.lines if number < 0 else self._command.lines[:number]))

    def _wait_for(self, pattern: str) -> None:
        compiled = re.compile(pattern)
        self._wait_until(lambda: self._has_ended() or compiled.match(self._shown()), 'what the README shows')
        assert compiled.match(self._shown()), self._report('what the README shows')

    def _wait_until(self, condition: Callable[[], object], what: str) -> None:
        limit = BUILD_TIMEOUT if BUILDS.search(self._command.text) else TIMEOUT
        with self._news:
            assert self._news.wait_for(condition, limit), self._report(what)

    def _check_end(self) -> None:
        """See that a command that has ended has printed no more than it should, and ended well."""
        ended = PROMPT.search(self._screen)
        if ended:
            shown = self._shown()
            shown += '' if shown.endswith('\n') or not shown else '\n'
            code = ended.group(1)
            assert re.fullmatch(self._pattern(), shown), self._report('what the README shows, and no more')
            was_interrupted = any(line.startswith(CTRL_C) for line in self._command.lines)
            assert code == '0' or was_interrupted, self._report(f'exit code 0 instead of {code}')

    def _report(self, what: str) -> str:
        shown = self._shown().splitlines()
        if len(shown) > 2 * REPORTED:
            shown[REPORTED:-REPORTED] = [f'({len(shown) - 2 * REPORTED} lines)']
        return '\n'.join([f'wanted: {what}', f'$ {self._command.text}', *self._command.lines,
                          '--- the terminal shows:', *shown])


def _as_pattern(line: str) -> str:
    if line == ANY_LINES:
        return '(?:.*\n)*?'
    before = '.*' if line.startswith(CTRL_C) else ''
    return before + '.*'.join(map(re.escape, line.split('...'))) + '[ \t]*\n'
