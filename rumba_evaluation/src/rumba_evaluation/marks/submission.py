"""One submission: its packages in a scratch folder, built if they need that, and the hidden tests that run on them."""

import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import xml.sax.saxutils
from typing import Dict, Iterator, List, NamedTuple, Sequence, Tuple

from rumba_evaluation.marks.gradescope import beside, marks_of
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.scheme import Mark, nothing

BUILT = re.compile(r'^\s*(add_executable|add_library|add_(message|service|action)_files|catkin_python_setup)\s*\(',
                   re.MULTILINE)
BUILD_PATIENCE = 900.0  # [s] of the wall clock
ENDS_WITHIN = 20.0  # [s] of the wall clock, after SIGINT
QUIET = ('ROSInterruptException', 'KeyboardInterrupt', 'publish()', 'closed file')  # how nodes end with the world
PACKAGE = 'submission'  # as rostest calls the folder for results


class Outcome(NamedTuple):
    """What became of a submission."""

    marks: List[Mark]
    notes: List[str]  # what went wrong, beside the marks


class Prepared(NamedTuple):
    """A submission that can run."""

    environment: Dict[str, str]
    problem: str  # why it cannot run; empty if it can


def prepare(source: str, tests: str, scratch: pathlib.Path) -> Prepared:
    """Copy a submission, and build it if that is needed; packages in the folder `tests` are found before all others."""
    copy = scratch / 'src' / 'submission'
    shutil.copytree(source, copy, symlinks=True, ignore=shutil.ignore_patterns('.git', '__pycache__', 'build', 'devel'))
    environment = {**os.environ, 'ROS_HOME': str(scratch / 'ros'), 'ROS_LOG_DIR': str(scratch / 'log'),
                   'ROS_HOSTNAME': 'localhost'}
    for name in ('ROS_MASTER_URI', 'ROS_IP'):
        environment.pop(name, None)  # rostest starts a master of its own
    packages = list(copy.rglob('package.xml'))
    if not packages:
        return Prepared(environment, 'the submission has no package.xml: it must hold a catkin package')
    _make_executable(copy)
    prepared = Prepared(environment, '')
    if any(BUILT.search(path.read_text(errors='replace')) for path in copy.rglob('CMakeLists.txt')):
        prepared = _build(scratch, environment)
    path = [os.path.abspath(tests), str(copy), prepared.environment.get('ROS_PACKAGE_PATH', '')]
    return prepared._replace(environment={**prepared.environment, 'ROS_PACKAGE_PATH': os.pathsep.join(path)})


def _make_executable(folder: pathlib.Path) -> None:
    """Make scripts executable: archives and some file systems lose that."""
    for path in folder.rglob('*'):
        if path.is_file() and not path.is_symlink():
            with open(path, 'rb') as file:
                is_script = file.read(2) == b'#!'
            if is_script:
                path.chmod(0o755)


def _build(scratch: pathlib.Path, environment: Dict[str, str]) -> Prepared:
    python = '/usr/bin/python3'
    code, output = _run(['catkin_make', '-j2', f'-DPYTHON_EXECUTABLE={python}', f'-DPython_EXECUTABLE={python}'],
                        environment, BUILD_PATIENCE, scratch)
    if code != 0:
        first = re.search(r'^.*\berror\b.*$', output, re.M | re.I)
        return Prepared(environment, 'it cannot be built: ' + (first.group().strip() if first else 'see the log'))
    _, text = _run(['bash', '-c', '. devel/setup.bash && exec env -0'], environment, ENDS_WITHIN, scratch)
    return Prepared(dict(line.split('=', 1) for line in text.split('\0') if '=' in line), '')


def run(test: HiddenTest, prepared: Prepared, scratch: pathlib.Path, extra: str = '') -> Tuple[Outcome, str]:
    """Run one hidden test; returns the outcome and what the run printed.

    Args:
        test: the test.
        prepared: the submission.
        scratch: folder for results, of this submission alone.
        extra: further elements of the launch file.
    """
    if prepared.problem:
        return _outcome(test, {}, prepared.problem, ''), ''
    results = scratch / 'results'
    launch = scratch / f'{test.name}.test'
    launch.write_text(_launch_file(test, extra))
    _, output = _run(['rostest', f'--pkgdir={scratch}', f'--package={PACKAGE}', f'--results-base-dir={results}',
                      str(launch)], prepared.environment, test.patience, scratch)
    found = {name: results / PACKAGE / f'rosunit-{name}.xml' for name in test.points}
    marks = {}
    for name, path in found.items():
        with contextlib.suppress(OSError, ValueError):
            marks[name] = marks_of(pathlib.Path(beside(str(path))).read_text())
    return _outcome(test, marks, 'the test gave no verdict: see the log', output), output


def _launch_file(test: HiddenTest, extra: str) -> str:
    quote = xml.sax.saxutils.quoteattr
    arguments = ''.join(f'    <arg name={quote(name)} value={quote(value)} />\n'
                        for name, value in test.arguments.items())
    return f'<launch>\n{extra}  <include file={quote(test.path)}>\n{arguments}  </include>\n</launch>\n'


def _outcome(test: HiddenTest, marks: Dict[str, List[Mark]], reason: str, output: str) -> Outcome:
    """The marks of a test, with nothing for a verdict that is missing."""
    found: List[Mark] = []
    for name, points in test.points.items():
        each = {mark.name: mark for mark in marks.get(name, nothing(points, reason))}
        found += [each.get(condition, nothing({condition: most}, reason)[0])._replace(name=f'{name}.{condition}')
                  for condition, most in points.items()]
    is_full = all(mark.score == mark.max_score for mark in found)
    return Outcome(found, [] if is_full else [f'{test.name}: {note}' for note in _notes(output)])


def _notes(output: str) -> List[str]:
    """What a run printed about nodes that failed: they are no reason for points, but explain them."""
    notes = re.findall(r'^ERROR: (cannot launch node of type .*)$', output, re.M)
    for trace in re.findall(r'^Traceback \(most recent call last\):\n(?:[ \t].*\n)+(\S.*)$', output, re.M):
        if not any(quiet in trace for quiet in QUIET):
            notes.append(f'a node ended with {trace}')
    notes += [f'a node cannot start: {line}' for line in re.findall(r'^(?:SyntaxError|IndentationError|TabError).*$',
                                                                    output, re.M)]
    return list(dict.fromkeys(notes))


def _run(command: Sequence[str], environment: Dict[str, str], patience: float, folder: pathlib.Path) -> Tuple[int, str]:
    """Run a command, with a time limit [s], and end all that it started; returns its exit code and its output."""
    with _ended(subprocess.Popen(command, env=environment, cwd=str(folder), stdin=subprocess.DEVNULL,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)) as process:
        try:
            output, _ = process.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGINT)
            try:
                output, _ = process.communicate(timeout=ENDS_WITHIN)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                output, _ = process.communicate()
    return process.returncode, output.decode(errors='replace')


@contextlib.contextmanager
def _ended(process: 'subprocess.Popen[bytes]') -> Iterator['subprocess.Popen[bytes]']:
    """A process whose group is gone after the block."""
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
