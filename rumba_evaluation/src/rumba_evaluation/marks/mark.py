"""mark: marks submissions by hidden .test files, each against a world and a master of its own, and prints the points.

A submission is a script, a package, a workspace, or a zip or tar file of them. It is built and run in a sandbox, where
bubblewrap can make one. Each test runs in the time of its world: with lockstep, the same submission gets the same marks
on any machine. Beside the table, results.json is for Gradescope, and a log of each test for the teacher. With --all,
each folder, archive and script in FOLDER is a submission; they are marked in parallel, marks.csv lists them, and after
an interruption the same command goes on. docs/teaching.md shows a course, and what the sandbox promises.

NAME:=VALUE is an argument that the .test files declare.
"""

import argparse
import concurrent.futures
import os
import shutil
import signal
import sys
import threading
from typing import Callable, Dict, List, NamedTuple, Sequence, Tuple, Union

from rumba_evaluation.marks import class_marks, github, gradescope, hidden_tests, intake, processes, sandbox, scratch
from rumba_evaluation.marks.class_marks import Row
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.quotations import printable
from rumba_evaluation.marks.sandbox import Bubblewrap, Plain
from rumba_evaluation.marks.submission import Launch, Outcome, Submission
from rumba_evaluation.marks.supervised import Stopped
from rumba_evaluation.trials.command_line import BAD_INPUT, ERROR, INTERRUPTED, Parser
from rumba_sim.model.errors import ConfigError, RumbaError

NAME = 'mark'
RESULTS, SHEET, NOTES = 'results.json', 'marks.csv', 'notes.txt'
EXAM = 'exam'
BUILD_LOG, BAG = 'build.log', 'recording.bag'


class Ros(NamedTuple):
    """What needs ROS."""

    recorder: str  # what records an examination, as an element of a launch file with the path of the bag as {bag}
    examine: Callable[[str, HiddenTest], List[str]]  # finds in such a bag what was not allowed, in words
    load: Callable[[HiddenTest, str], Launch]  # what a test starts; its second argument is the folder of the tests
    visible: Callable[[], List[str]]  # folders that programs need which use ROS and Rumba


def main(arguments: Sequence[str], ros: Ros) -> int:
    """Run the command with the arguments of a command line, without the name of the program; returns the exit code."""
    options, given = _options(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        processes.adopt_orphans()
        scratch.remove_abandoned()
        marking = _Marking(options, given, ros)
        return marking.mark_all() if options.all else marking.mark_one()
    except RumbaError as error:
        message = ' '.join([f'{NAME}:', *str(error).split()])
        print(message, file=sys.stderr)
        if options.output:  # a grader shows students what it finds there
            _keep(options.output, RESULTS, gradescope.document([], options.visibility, message))
        return BAD_INPUT
    except OSError as error:  # for example no space left
        print(f'{NAME}: {error}', file=sys.stderr)
        return ERROR
    except (KeyboardInterrupt, Stopped):
        print(f'{NAME}: stopped; the same command goes on', file=sys.stderr)
        return INTERRUPTED


def _options(arguments: Sequence[str]) -> Tuple[argparse.Namespace, Dict[str, str]]:
    about, details = (__doc__ or '').split('\n\n', 1)
    parser = Parser(NAME, description=about, epilog=details, allow_abbrev=False)
    add = parser.add_argument
    add('submission', nargs='?', default='', help='folder of one submission')
    add('--all', default='', metavar='FOLDER', help='folder with a folder for each submission of a class')
    add('--tests', required=True, metavar='FOLDER', help='folder of the hidden .test files')
    add('--output', default='', metavar='FOLDER', help='folder for results; default ./marks with --all, else none')
    add('--jobs', type=int, default=max(1, len(os.sched_getaffinity(0)) // 2), metavar='N',
        help='number of submissions that are marked in parallel; default %(default)s, half of the cores: a world and '
             'those who take part in it are several processes')
    add('--github', action='store_true', help='print lines for GitHub, and for GitHub Classroom, instead of the table')
    add('--visibility', default=gradescope.VISIBLE, choices=gradescope.VISIBILITIES,
        help='when Gradescope shows students the marks; default %(default)s')
    given = {name: value for name, value in (each.split(':=', 1) for each in arguments if ':=' in each)}
    options = parser.parse_args([each for each in arguments if ':=' not in each])
    if bool(options.submission) == bool(options.all):
        parser.error('give the folder of one submission, or --all FOLDER')
    if options.jobs < 1:
        parser.error(f'--jobs is {options.jobs}: must be at least 1')
    return options, given


class _Marking:
    """What the command line wants."""

    def __init__(self, options: argparse.Namespace, given: Dict[str, str], ros: Ros) -> None:
        folders: List[str] = [options.all, options.tests]
        for folder in filter(None, folders):
            if not os.path.isdir(folder):
                raise ConfigError(f'{folder}: is no folder')
        if not options.all and not os.path.exists(options.submission):
            raise ConfigError(f'{options.submission}: is not there')
        self._options, self._ros = options, ros
        self._tests = hidden_tests.load(options.tests, given)
        self._launches = [ros.load(test, options.tests) for test in self._tests]
        self._points = hidden_tests.all_points(self._tests)
        self._box = self._sandbox()
        self._printing, self._stop = threading.Lock(), threading.Event()
        self._of_tests = class_marks.digest_of_tests(options.tests, self._tests, self._launches)

    def _sandbox(self) -> Union[Plain, Bubblewrap]:
        """The sandbox, if the system allows one; otherwise a line says so."""
        with scratch.folder() as folder:
            for name in ('shm', 'tmp'):
                (folder / name).mkdir()
            trouble = sandbox.trouble(str(folder))
        if trouble:
            print(f'{NAME}: without a sandbox ({trouble}): submissions run with your rights, and can cheat; '
                  'docs/teaching.md says what then holds', file=sys.stderr)
            return Plain()
        options = self._options
        return Bubblewrap(self._ros.visible(), filter(None, (options.tests, options.all, options.output,
                                                             options.submission)))

    def mark_one(self) -> int:
        """Mark one submission."""
        outcome = self._mark(self._options.submission, self._options.output)
        if self._options.github:
            print(*github.lines(outcome.marks), sep='\n')
        else:
            print(class_marks.table(outcome.marks), *outcome.notes, sep='\n')
        return 0 if gradescope.score(outcome.marks) == gradescope.most(outcome.marks) else ERROR

    def mark_all(self) -> int:
        """Mark a class."""
        folder = self._options.output or 'marks'
        sources = class_marks.submissions(self._options.all)
        if not sources:
            raise ConfigError(f'{self._options.all}: has no submission in it: each must be a folder, an archive (.zip, '
                              '.tar, .tar.gz) or a script (.py)')
        with concurrent.futures.ThreadPoolExecutor(self._options.jobs) as pool:
            jobs = [pool.submit(self._mark_member, source, folder) for source in sources]
            try:
                rows = [job.result() for job in jobs]
            except BaseException:
                self._stop.set()
                for job in jobs:
                    job.cancel()
                raise
        _keep(folder, SHEET, class_marks.sheet(rows, self._points))
        print(os.path.join(folder, SHEET))
        return 0

    def _mark_member(self, source: str, folder: str) -> Row:
        name = intake.name_of(source)
        own = os.path.join(folder, name)
        wanted = f'{self._of_tests} {intake.digest(source)}'
        outcome = class_marks.stored(own, wanted, _read)
        if outcome is None:
            _keep(own, class_marks.DIGEST, '')
            outcome = self._mark(source, own)
            _keep(own, class_marks.DIGEST, wanted)
        with self._printing:
            print(f'{printable(name)}: {gradescope.total(outcome.marks)}', *outcome.notes, sep='; ', flush=True)
        return Row(name, outcome)

    def _mark(self, source: str, folder: str) -> Outcome:
        """Mark a submission; its results go to a folder if one is given."""
        wanted = [node for launch in self._launches for node in launch.nodes]
        with scratch.folder() as temporary:
            taken = Submission(source, wanted, temporary, self._box, self._stop)
            marks, notes = [], list(taken.notes)
            if folder and taken.workspace.log:
                _keep(folder, BUILD_LOG, taken.workspace.log)
            for test, launch in zip(self._tests, self._launches):
                bag = str(temporary / f'{test.name}.{BAG}')
                is_exam = test.arguments.get(EXAM, '').lower() in ('true', '1')
                outcome, log = taken.run(test, launch, self._options.tests,
                                         self._ros.recorder.format(bag=bag) if is_exam else '')
                marks += outcome.marks
                notes += outcome.notes + (self._ros.examine(bag, test) if is_exam and not taken.problem else [])
                if folder:
                    _keep(folder, f'{test.name}.log', log or taken.problem)
                    if is_exam and os.path.exists(bag):
                        shutil.move(bag, os.path.join(folder, os.path.basename(bag)))
        if folder:
            _keep(folder, NOTES, '\n'.join(notes))
            _keep(folder, RESULTS, gradescope.document(
                marks, self._options.visibility, '\n'.join([gradescope.total(marks), *notes])))
        return Outcome(marks, notes)


def _keep(folder: str, name: str, text: str) -> None:
    """Write a file at once, so that nobody finds a half of it."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(f'{path}.new', 'w', encoding='utf-8', errors='backslashreplace') as file:
        file.write(text)
    os.replace(f'{path}.new', path)


def _read(folder: str) -> Outcome:
    """The outcome that an earlier run has kept in a folder."""
    with open(os.path.join(folder, RESULTS), encoding='utf-8') as results, \
            open(os.path.join(folder, NOTES), encoding='utf-8') as notes:
        return Outcome(gradescope.marks_of(results.read()), notes.read().splitlines())
