"""What to do about an exception of Python, by its kind, its message and the line in which it was raised."""

import re
from typing import NamedTuple

from rumba_evaluation.submissions.diagnosis.quotations import printable

SYNTAX = ('SyntaxError', 'IndentationError', 'TabError')
RENAMED = {'xrange': 'range', 'raw_input': 'input', 'unicode': 'str', 'basestring': 'str', 'long': 'int',
           'unichr': 'chr', 'file': 'open', 'reduce': 'functools.reduce', 'thread': 'threading',
           'iteritems': 'items', 'itervalues': 'values', 'iterkeys': 'keys', 'has_key': 'KEY in DICTIONARY',
           'urllib2': 'urllib.request', 'ConfigParser': 'configparser', 'Queue': 'queue', 'Tkinter': 'tkinter',
           'StringIO': 'io', 'cPickle': 'pickle'}  # by names of Python 2
PYTHON_2 = re.compile(  # lines of Python 2 that Python 3 cannot read
    r'''(?:print|exec)[ \t]+[^=( \t]|print[ \t]*>>|except\b[^:(]*,[ \t]*\w+[ \t]*:|raise[ \t]+[\w.]+,'''
    r'''|[^'"]*<>|[^'"]*`|[^'"]*\b0[0-7]+\b''')
WHEN_IT_ENDS = ('KeyboardInterrupt', 'ROSInterruptException')  # the test was over


class Raised(NamedTuple):
    """An exception that was printed."""

    kind: str  # class, without its module
    message: str
    path: str  # of the file in the submission, relative to it
    line: str
    source: str  # the line of the file, without spaces around it; empty if it is not known
    is_in_callback: bool = False  # of rospy: the node goes on


def sentence(raised: Raised) -> str:
    """What happened, where, and what to do."""
    source = f' in `{printable(raised.source)}`' if raised.source else ''
    where = f'{printable(raised.path)}, line {printable(raised.line)}' if raised.line else printable(raised.path)
    words = raised.message.partition(' (/')[0]  # without paths of this computer
    message = f' ({printable(words)})' if words else ''
    return f'{where}: {printable(raised.kind, 60)}{message}{source}: {_advice(raised)}'


def _advice(raised: Raised) -> str:
    if raised.kind in SYNTAX:
        return _of_syntax(raised)
    if raised.kind == 'NameError':
        return _of_name(raised)
    if raised.kind in ('ModuleNotFoundError', 'ImportError'):
        return _of_import(raised)
    if raised.kind == 'AttributeError':
        return _of_attribute(raised)
    if 'init_node()' in raised.message:
        return "call rospy.init_node('NAME') first, before all else that rospy does"
    if raised.kind == 'ROSSerializationException':
        return 'a field of the message has a value of another type: `rosmsg show TYPE` prints the types'
    if raised.is_in_callback:
        return 'the function ends here each time it is called: find out which value it does not expect'
    return 'the node ends here: find out which value it does not expect, for example by a print() before this line'


def _of_syntax(raised: Raised) -> str:
    if raised.kind == 'TabError' or 'inconsistent use of tabs' in raised.message:
        return 'some lines begin with tabs and some with spaces: replace each tab by four spaces'
    if raised.kind == 'IndentationError':
        return 'lines that belong together must begin with the same number of spaces, and those after : with more'
    if PYTHON_2.match(raised.source) or "call to 'print'" in raised.message or "call to 'exec'" in raised.message:
        return ('this is Python 2: write it in Python 3, for example print(x), except E as e, raise E(x), != '
                'for <>')
    if raised.message.startswith('Non-UTF-8'):
        return 'save the file as UTF-8'
    return 'Python cannot read this line: look at brackets, quotation marks and : here and in the line before'


def _quoted(message: str) -> str:
    """The first word in single quotation marks."""
    return (message.split("'") + ['', ''])[1]


def _of_name(raised: Raised) -> str:
    name = _quoted(raised.message)
    if name in RENAMED:
        return f'{name} is Python 2: write {RENAMED[name]} instead'
    if name in ('rospy', 'math', 'time', 'random', 'sys', 'os', 'tf', 'numpy'):
        return f'write import {name} at the top of the file'
    if name[:1].isupper():
        return f'look at the spelling; if it is a message, write from PACKAGE.msg import {printable(name)} at the top'
    return 'look at the spelling, and whether it gets a value before this line'


def _of_import(raised: Raised) -> str:
    name = _quoted(raised.message)
    if name in RENAMED:
        return f'{name} is Python 2: write import {RENAMED[name]} instead'
    if raised.message.startswith('cannot import name'):
        module = (raised.message.split("'") + ['', '', ''])[3]
        package, _, kind = module.partition('.')
        if kind in ('msg', 'srv'):
            listing = 'rosmsg' if kind == 'msg' else 'rossrv'
            return (f'the package {printable(package)} has no {printable(name)}: `{listing} package '
                    f'{printable(package)}` lists what it has; one of your own must be named in CMakeLists.txt')
        return f'{printable(module)} has no {printable(name)}: look at the spelling'
    package, dot, _ = name.partition('.')
    if dot or package.endswith(('_msgs', '_msg')) or re.search(r'\.(?:msg|srv)\b', raised.source):
        return (f'the messages of {printable(package)} are not installed here: look at the spelling; messages of your '
                'own need add_message_files and generate_messages in CMakeLists.txt')
    return (f'{printable(name)} is not installed here: look at the spelling; if it is a file of your own, put it '
            'beside this one, and hand it in too')


def _of_attribute(raised: Raised) -> str:
    names = raised.message.split("'")
    name = names[3] if len(names) > 3 else ''
    if name in RENAMED:
        return f'{name} is Python 2: write {RENAMED[name]} instead'
    if len(names) > 3 and names[1] == 'NoneType':
        return 'what is before the dot has no value yet: wait for it, or test `is not None` before'
    return 'look at the spelling behind the dot; `rosmsg show TYPE` prints the fields of a message'
