"""mark: marks submissions by hidden .test files, each against a world and a master of its own, and prints the points.

Each test runs in the time of its world: with lockstep, the same submission gets the same marks on any machine. Beside
the table, results.json is for Gradescope, and a log of each test for the teacher. With --all, each folder in FOLDER is
a submission; they are marked in parallel, marks.csv lists them, and after an interruption the same command goes on.
docs/teaching.md shows a course.

NAME:=VALUE is an argument that the .test files declare.
"""

import argparse
import concurrent.futures
import os
import pathlib
import sys
import tempfile
import threading
from typing import Callable, Dict, List, Sequence, Tuple

from rumba_evaluation.marks import class_marks, github, gradescope, hidden_tests, submission
from rumba_evaluation.marks.class_marks import Row
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.submission import Outcome
from rumba_evaluation.trials.command_line import BAD_INPUT, ERROR, INTERRUPTED, Parser
from rumba_sim.model.errors import ConfigError, RumbaError

NAME = 'mark'
RESULTS, SHEET, NOTES = 'results.json', 'marks.csv', 'notes.txt'
EXAM = 'exam'
BAG = 'recording.bag'
Examine = Callable[[str, HiddenTest], List[str]]


def main(arguments: Sequence[str], recorder: str, examine: Examine) -> int:
    """Run the command with the arguments of a command line; returns the exit code.

    Args:
        arguments: without the name of the program.
        recorder: what records an examination, as an element of a launch file with the path of the bag as {bag}.
        examine: finds in the bag of an examination what was not allowed, in words.
    """
    options, given = _options(arguments)
    try:
        marking = _Marking(options, given, recorder, examine)
        return marking.mark_all() if options.all else marking.mark_one()
    except RumbaError as error:
        print(f'{NAME}:', *str(error).split(), file=sys.stderr)
        return BAD_INPUT
    except OSError as error:  # for example no space left
        print(f'{NAME}: {error}', file=sys.stderr)
        return ERROR
    except KeyboardInterrupt:
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

    def __init__(self, options: argparse.Namespace, given: Dict[str, str], recorder: str, examine: Examine) -> None:
        for folder in (options.submission or options.all, options.tests):
            if not os.path.isdir(folder):
                raise ConfigError(f'{folder}: is no folder')
        self._options = options
        self._tests = hidden_tests.load(options.tests, given)
        self._points = hidden_tests.all_points(self._tests)
        self._recorder, self._examine = recorder, examine
        self._printing = threading.Lock()

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
            raise ConfigError(f'{self._options.all}: has no folder in it: each submission must be a folder')
        with concurrent.futures.ThreadPoolExecutor(self._options.jobs) as pool:
            jobs = [pool.submit(self._mark_member, source, folder) for source in sources]
            try:
                rows = [job.result() for job in jobs]
            except BaseException:
                for job in jobs:
                    job.cancel()
                raise
        path = os.path.join(folder, SHEET)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(class_marks.sheet(rows, self._points))
        print(path)
        return 0

    def _mark_member(self, source: str, folder: str) -> Row:
        name = os.path.basename(source)
        own = os.path.join(folder, name)
        wanted = class_marks.digest(source, self._tests)
        outcome = class_marks.stored(own, wanted, _read)
        if outcome is None:
            outcome = self._mark(source, own)
            with open(os.path.join(own, class_marks.DIGEST), 'w', encoding='utf-8') as file:
                file.write(wanted)
        with self._printing:
            print(f'{name}: {gradescope.total(outcome.marks)}', *outcome.notes, sep='; ', flush=True)
        return Row(name, outcome)

    def _mark(self, source: str, folder: str) -> Outcome:
        """Mark a submission; its results go to a folder if one is given."""
        found = Outcome([], [])
        with tempfile.TemporaryDirectory(prefix='mark') as temporary:
            scratch = pathlib.Path(temporary)
            prepared = submission.prepare(source, self._options.tests, scratch)
            for test in self._tests:
                bag = str(scratch / f'{test.name}.{BAG}')
                is_exam = test.arguments.get(EXAM, '').lower() in ('true', '1')
                outcome, log = submission.run(test, prepared, scratch,
                                              self._recorder.format(bag=bag) if is_exam else '')
                findings = self._examine(bag, test) if is_exam and not prepared.problem else []
                found = Outcome(found.marks + outcome.marks, found.notes + outcome.notes + findings)
                if folder:
                    _keep(folder, f'{test.name}.log', log or prepared.problem)
                    if is_exam and os.path.exists(bag):
                        os.replace(bag, os.path.join(folder, os.path.basename(bag)))
        if folder:
            _keep(folder, NOTES, '\n'.join(found.notes))
            words = '\n'.join([gradescope.total(found.marks), *found.notes])
            _keep(folder, RESULTS, gradescope.document(found.marks, self._options.visibility, words))
        return found


def _keep(folder: str, name: str, text: str) -> None:
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, name), 'w', encoding='utf-8', errors='replace') as file:
        file.write(text)


def _read(folder: str) -> Outcome:
    """The outcome that an earlier run has kept in a folder."""
    with open(os.path.join(folder, RESULTS), encoding='utf-8') as results, \
            open(os.path.join(folder, NOTES), encoding='utf-8') as notes:
        return Outcome(gradescope.marks_of(results.read()), notes.read().splitlines())
