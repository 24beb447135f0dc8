"""What a node printed: whether a person at its terminal can live with it."""

import re

from stress.failure import Failure

LINES = 200  # that one blow may cause, beside those that its inputs are worth
LINES_PER_INPUT = 3
LONGEST = 2000  # [characters] of a line
SHOWN = 12  # lines, for a person
ESCAPES = re.compile(r'\x1b(?!\[K|\[\d*m)')  # colours, and clearing the rest of a line, are all right
LOGGED = re.compile(r'^(\x1b\[\d*m)*\[ ?(DEBUG|INFO|WARN|ERROR|FATAL)\]')  # the first line of a message
TRACEBACK = 'Traceback (most recent call last)'
ERROR = re.compile(r'^[\w.]+(:|$)')  # the last line of a traceback; another line may be one of another thread
FRAME = re.compile(r'^ *File "([^"]+)", line')
# Python's own, ROS's, and what ROS generates; what these print of a broken connection is none of the project's.
FOREIGN = re.compile(r'/usr/lib/python3|/opt/ros/|<|.*/(msg|srv)/_\w+\.py$')
THREAD = '_bootstrap_inner'  # in a traceback: it ended a thread ...
CONNECTION = '/rospy/impl/tcpros'  # ... that was there for one connection
CHAINED = 'During handling of the above exception, another exception occurred:'
# ROS repeats in these what a client sent, whatever that is.
ECHOES = ('Could not process inbound connection', 'Inbound TCP/IP connection failed', 'Unable to ')


def tail(lines):
    """The last lines, for a person."""
    return _joined(lines[-SHOWN:]) or 'it printed nothing'


def _joined(lines):
    return ' | '.join(line.strip()[:400] for line in lines)[:4000]


def check(who, lines, most=None):
    """Raise what is wrong with lines that a node printed.

    Args:
        who: name of the node.
        lines: what it printed.
        most: how many lines it may print, beside tracebacks of others; None for one that prints all the time.

    Raises:
        Failure: a traceback of the project's code or of a thread that ended, a flood, or what confuses a terminal.
    """
    is_echo = False
    for number, line in enumerate(lines):
        if TRACEBACK in line and _is_ours(lines[number + 1:]):
            raise Failure('traceback', who, _joined(lines[max(number - 1, 0):number + 40]))
        if LOGGED.match(line):
            is_echo = any(echo in line[:100] for echo in ECHOES)
        if is_echo:
            continue
        if len(line) > LONGEST:
            raise Failure('long line', who, f'{len(line)} characters: {line[:200]}...')
        if ESCAPES.search(line):
            raise Failure('escape', who, repr(line[:200]))
    if most is not None:
        told = list(_told(lines))
        if len(told) > most:
            raise Failure('flood', who, f'{len(told)} lines: {tail(told[-3:])}')


def _told(lines):
    """The lines that are no part of a traceback."""
    is_inside = False
    for line in lines:
        if TRACEBACK in line:
            is_inside = True
        elif is_inside:
            is_inside = not ERROR.match(line)
        elif line and line != CHAINED:
            yield line


def _is_ours(lines):
    """Whether a traceback goes through the project's code, or ended a thread that is needed."""
    has_ended_thread = False
    for line in lines:
        frame = FRAME.match(line)
        if frame and not FOREIGN.match(frame.group(1)):
            return True
        if frame and CONNECTION in line:
            return False
        has_ended_thread |= THREAD in line
        if ERROR.match(line):
            break
    return has_ended_thread
