"""Mistakes that show when nodes run, by what they, roslaunch and rostest printed."""

from typing import Dict, List, NamedTuple, Optional, Sequence, Set, Tuple

from rumba_evaluation.submissions.diagnosis.mistakes_of_exceptions import SYNTAX, WHEN_IT_ENDS, Raised, sentence
from rumba_evaluation.submissions.diagnosis.quotations import COPY, lines_of, printable, within_copy

TRACE = 'Traceback (most recent call last):'
CHAINED = ('During handling of the above exception', 'The above exception was the direct cause')
LATE = ('publish() to a closed topic', 'closed file', 'rospy shutdown', 'ROS shutdown')  # after the end of the world
LAUNCH = 'cannot launch node of type ['
DIED, FINISHED, STARTED = '] process has died [', '] process has finished cleanly', ': start w/ args [['
ENV, NOT_FOUND = '/usr/bin/env: ', 'No such file or directory'
LONGEST_PATH = 1000  # characters
BUILT = '/devel/lib/'  # in the path of what catkin_make has built
SIGNALS = {
    -11: 'was stopped by a segmentation fault: it uses memory of others, often by an index behind the end of a '
         'vector, or a pointer that points to nothing',
    -9: 'was killed from outside, often because it took too much memory: does a list grow without end?',
    -8: 'divided an integer by 0', -7: 'used memory that does not exist'}


class _Ended(NamedTuple):
    """A process that ended by itself."""

    program: str  # file in the submission, or PACKAGE/NODE of what was built
    code: int


def of_output(output: str) -> List[str]:
    """What an output says about mistakes of a submission."""
    lines = lines_of(output)
    told = [*_launches(lines), *_first_lines(lines), *map(sentence, _exceptions(_unpacked(lines)))]
    ended = _processes(lines, _workspaces(output))
    told += _of_cpp(lines, ended)
    told += [f'{printable(each.program)} {SIGNALS[each.code]}' for each in ended if each.code in SIGNALS]
    if not told:
        told += [_of_end(each) for each in ended]
    return told


# --- nodes that do not start ---


def _launches(lines: Sequence[str]) -> List[str]:
    told = []
    for line in lines:
        found = line.partition(LAUNCH)[2]
        if found:
            node, _, reason = found.partition(']: ')
            package, _, name = map(printable, node.partition('/'))
            what = f'there is no package {package}'
            if reason.startswith('Cannot locate node'):
                what = (f'the package {package} has no node {name} that can run: is there a file with exactly this '
                        'name, and does it begin with #!')
            told.append(f'the node {name} cannot start: {what}')
        if line.startswith("If it is a script, you may be missing a '#!' declaration"):
            told.append('a script cannot start: its first line must begin with #!, such as #!/usr/bin/env python3')
    return told


def _first_lines(lines: Sequence[str]) -> List[str]:
    """What is wrong with first lines of scripts, as far as it shows only when they start."""
    told = []
    for number, line in enumerate(lines):
        if line.startswith(ENV) and NOT_FOUND in line:
            program = line[len(ENV):].partition(': ')[0].strip("'\u2018\u2019")
            if program.endswith(('\r', '\\r')):
                told.append('a script has Windows line ends (CR LF), so that its first line names a program that does '
                            'not exist: save it with Unix line ends (LF)')
            else:
                told.append(f"the first line of a script names the program '{printable(program)}', which does not "
                            'exist here: write #!/usr/bin/env python3')
        if line.startswith('ERROR: Roslaunch got a') and NOT_FOUND in line:
            path = within_copy(next(filter(None, lines[number + 1:number + 3]), '').partition(' ')[0])
            told.append(f'{printable(path)}: the program in its first line does not exist here: write '
                        '#!/usr/bin/env python3')
    return told


# --- exceptions of Python ---


def _unpacked(lines: Sequence[str]) -> List[str]:
    """The lines, with the tracebacks of services: rospy prints them as a list of strings."""
    found: List[str] = []
    for line in lines:
        if line.startswith("['" + TRACE):
            text = line[2:-2]
            for link in ("', '", "', \"", '", \'', '", "'):
                text = text.replace('\\n' + link, '\n')
            found += ['bad callback: of a service', *text.replace('\\n', '\n').replace("\\'", "'").split('\n')]
        else:
            found.append(line)
    return found


def _exceptions(lines: Sequence[str]) -> List[Raised]:
    """The exceptions of the nodes of a submission, except those by which nodes end with the test."""
    found: List[Raised] = []
    chain: List[Optional[Raised]] = []
    is_over = is_chained = False  # of the chain: by the end of the test; whether another traceback belongs to it
    number = 0
    while number < len(lines):
        is_chained = is_chained or lines[number].startswith(CHAINED)
        number, end, raised = _exception(lines, number)
        if not end:
            continue
        if not is_chained:
            found += [each for each in chain[-1:] if each and not is_over]
            chain, is_over = [], False
        chain.append(raised)
        is_over = is_over or any(each in end for each in (*WHEN_IT_ENDS, *LATE))
        is_chained = False
    return found + [each for each in chain[-1:] if each and not is_over]


def _exception(lines: Sequence[str], number: int) -> Tuple[int, str, Optional[Raised]]:
    """The exception that a line begins, if it does.

    Returns:
        The number of the line behind it; the last line of the exception, empty if there is none; and the exception, if
        it is of the submission.
    """
    line = lines[number]
    if line.startswith(tuple(f'{kind}: Non-UTF-8' for kind in SYNTAX)):
        return number + 1, line, _unreadable(line)
    if not (line.startswith(TRACE) or line.startswith('  File "')):
        return number + 1, '', None
    frame, is_trace = None, line.startswith(TRACE)
    after = number + is_trace
    while after < len(lines) and (lines[after].startswith(' ') or not lines[after]):
        frame = _frame(lines, after) or frame
        after += 1
    end = lines[after] if after < len(lines) else ''
    if not end or not is_trace and not end.startswith(SYNTAX):
        return after, '', None
    raised = _raised(end, frame, number > 0 and 'bad callback: ' in lines[number - 1]) if frame else None
    return after + 1, end, raised


def _frame(lines: Sequence[str], number: int) -> Optional[Tuple[str, str, str]]:
    """File in the submission, line and source of a frame."""
    line = lines[number]
    if not line.startswith('  File "'):
        return None
    path, _, rest = line[len('  File "'):].partition('", line ')
    if not within_copy(path):
        return None
    source = lines[number + 1] if number + 1 < len(lines) and lines[number + 1].startswith('    ') else ''
    return within_copy(path), rest.partition(',')[0], source.strip()


def _raised(end: str, frame: Tuple[str, str, str], is_in_callback: bool) -> Raised:
    kind, _, message = end.partition(': ')
    return Raised(kind.rpartition('.')[2], message, *frame, is_in_callback)


def _unreadable(line: str) -> Optional[Raised]:
    """A file that is no UTF-8: Python names it only in the message."""
    kind, _, message = line.partition(': ')
    path = within_copy(message.partition(' in file ')[2].partition(' on line ')[0])
    number = message.partition(' on line ')[2].partition(',')[0]
    return Raised(kind, message.partition(' in file ')[0], path, number, '') if path else None


# --- processes that end ---


def _processes(lines: Sequence[str], workspaces: Set[str]) -> List[_Ended]:
    """The processes of the submission that ended before the test was over."""
    programs: Dict[str, str] = {}  # by the names that roslaunch gives processes
    ended = []
    for line in lines:
        if STARTED in line:
            name, _, path = line.partition(STARTED)
            programs[name.rpartition('[')[2].rstrip(']')] = _program(path[1:].partition("'")[0], workspaces)
        elif DIED in line:
            code = line.partition('exit code ')[2].partition(',')[0]
            program = _program(line.partition(', cmd ')[2].partition(' ')[0], workspaces)
            if program and code.lstrip('-').isdigit():
                ended.append(_Ended(program, _signal(int(code[:9]))))
        elif FINISHED in line:
            program = programs.get(line.partition(FINISHED)[0].rpartition('[')[2], '')
            if program:
                ended.append(_Ended(program, 0))
    return ended


def _signal(code: int) -> int:
    """An exit code as Python has it, below 0 for a signal: a sandbox and a shell add 128 to its number."""
    return 128 - code if 128 < code < 128 + 32 else code


def _workspaces(output: str) -> Set[str]:
    """Workspaces with the copy of a submission: the log of rostest names them in ROS_PACKAGE_PATH."""
    found = set()
    at = output.find(COPY[:-1])
    while at >= 0:
        before = output[max(0, at - LONGEST_PATH):at]
        found.add(before[max(before.rfind(mark) for mark in ' \n\'":(=') + 1:])
        at = output.find(COPY[:-1], at + 1)
    return found


def _program(path: str, workspaces: Set[str]) -> str:
    """A program of the submission as it is told; empty for a program of somebody else."""
    workspace, _, built = path.partition(BUILT)
    return within_copy(path) or (built if workspace in workspaces else '')


def _of_cpp(lines: Sequence[str], ended: Sequence[_Ended]) -> List[str]:
    """What nodes in C++ print when they are aborted."""
    told = []
    program = next((printable(each.program) for each in ended if each.code in (-5, -6)), 'a node in C++')
    for number, line in enumerate(lines):
        if line.startswith('terminate called after throwing an instance of'):
            what = lines[number + 1].partition('what():')[2].strip() if number + 1 < len(lines) else ''
            kind = line.partition("'")[2].rstrip("'")
            told.append(f'{program} ended with the exception {printable(kind)}{what and f" ({printable(what)})"}: find '
                        'the line that throws it, for example with ROS_INFO before and after it')
        elif 'You must call ros::init() before creating the first NodeHandle' in line:
            told.append(f'{program}: call ros::init(argc, argv, "NAME") before the first ros::NodeHandle')
    return told


def _of_end(ended: _Ended) -> str:
    if ended.code < 0:
        return f'{printable(ended.program)} was stopped by the signal {-ended.code}'
    if ended.code:
        return (f'{printable(ended.program)} ended before the test was over, with the exit code {ended.code}: look for '
                'sys.exit() or exit() in it')
    return (f'{printable(ended.program)} ended before the test was over, without an error: if it shall go on, write '
            'rospy.spin() or ros::spin() as its last line, or loop `while not rospy.is_shutdown():`')
