"""Submissions that are marked, one or a class: sandboxed, in parallel, and kept for graders and the next run."""

import argparse
import concurrent.futures
import contextlib
import os
import shutil
import sys
import threading
from typing import Callable, Dict, Iterator, List, NamedTuple, Sequence, Set, TypeVar, Union

from tqdm import tqdm

from rumba_evaluation.marks import class_marks, github, gradescope, hidden_tests, kept
from rumba_evaluation.marks.class_marks import Row
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.scheme import nothing
from rumba_evaluation.marks.submission import Launch, Outcome, Submission
from rumba_evaluation.submissions import intake, sandbox, scratch
from rumba_evaluation.submissions.diagnosis.quotations import printable
from rumba_evaluation.submissions.sandbox import Bubblewrap, Plain
from rumba_evaluation.submissions.supervised import Stopped
from rumba_sim.model.common.command_line import ERROR
from rumba_sim.model.common.errors import ConfigError

SHEET, BUILD_LOG, BAG = 'marks.csv', 'build.log', 'recording.bag'
EXAM, RECORDING = 'exam', 'recording'  # argument of a .test file, and parameter of a mission_test
LONGEST = 2000  # characters of a line about a mark
PERIOD = 1.0  # [s] of the wall clock between two looks at how far it is
Result = TypeVar('Result')


class Ros(NamedTuple):
    """What needs ROS."""

    examine: Callable[[str, HiddenTest], List[str]]  # finds in the bag of an examination what was not allowed, in words
    load: Callable[[HiddenTest, str], Launch]  # what a test starts; its second argument is the folder of the tests
    visible: Callable[[], List[str]]  # folders that programs need which use ROS and Rumba


class Marking:
    """What a command line wants."""

    def __init__(self, options: argparse.Namespace, given: Dict[str, str], ros: Ros) -> None:
        """Read the hidden tests, and look for a sandbox.

        Raises:
            ConfigError: a folder is none, or a test cannot be used.
        """
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
        self._of_tests = class_marks.digest_of_tests(options.tests, self._tests, self._launches)
        self._box = self._sandbox()
        self._stop = threading.Event()
        self._now: Set[str] = set()  # what is being done, in words

    def _sandbox(self) -> Union[Plain, Bubblewrap]:
        """The sandbox, if the system allows one; otherwise a line says so."""
        trouble = sandbox.trouble()
        if trouble:
            print(f'mark: without a sandbox ({trouble}): submissions run with your rights, and can cheat; '
                  'docs/teaching.md says what holds then', file=sys.stderr)
            return Plain()
        options = self._options
        hidden: List[str] = [options.tests, options.all, options.output, options.submission]
        return Bubblewrap(self._ros.visible(), filter(None, hidden))

    def mark_one(self) -> int:
        """Mark one submission; returns the exit code."""
        [outcome] = self._each(lambda source: self._mark(source, self._options.output), [self._options.submission])
        if self._options.github:
            print(*github.lines(outcome.marks), sep='\n')
        else:
            lines = class_marks.table(outcome.marks).split('\n')
            print(*(printable(line, LONGEST) for line in lines), *outcome.notes, sep='\n')
        return 0 if gradescope.score(outcome.marks) == gradescope.most(outcome.marks) else ERROR

    def mark_all(self) -> int:
        """Mark a class; returns the exit code.

        Raises:
            ConfigError: there is no submission.
        """
        folder = self._options.output or 'marks'
        sources = class_marks.submissions(self._options.all)
        if not sources:
            raise ConfigError(f'{self._options.all}: has no submission in it: each must be a folder, an archive (.zip, '
                              '.tar, .tar.gz) or a script (.py)')
        names = class_marks.names(sources)
        rows = self._each(lambda source: self._mark_member(source, names[source], folder), sources)
        kept.write(folder, SHEET, class_marks.sheet(rows, self._points))
        print(os.path.join(folder, SHEET))
        return 0

    def _each(self, work: Callable[[str], Result], sources: Sequence[str]) -> List[Result]:
        """What becomes of submissions, in their order; a terminal shows meanwhile what is being done."""
        with concurrent.futures.ThreadPoolExecutor(self._options.jobs) as pool, \
                tqdm(total=len(sources), unit=' submissions', disable=None, leave=False) as bar:
            jobs = [pool.submit(work, source) for source in sources]
            try:
                while not all(job.done() for job in jobs):
                    done, _ = concurrent.futures.wait(jobs, PERIOD, concurrent.futures.FIRST_EXCEPTION)
                    for job in done:
                        job.result()  # raises what it has raised
                    bar.n = len(done)
                    bar.set_postfix_str('; '.join(sorted(self._now)))
                return [job.result() for job in jobs]
            except BaseException:
                self._stop.set()
                for job in jobs:
                    job.cancel()
                raise

    @contextlib.contextmanager
    def _doing(self, words: str) -> Iterator[None]:
        self._now.add(words)
        try:
            yield
        finally:
            self._now.discard(words)

    def _mark_member(self, source: str, name: str, folder: str) -> Row:
        """Mark one of a class, which goes on whatever is wrong with it."""
        own = os.path.join(folder, name)
        try:
            outcome = self._mark_again(source, own)
        except Stopped:
            raise
        except Exception as error:
            reason = f'it cannot be marked: {type(error).__name__}: {printable(str(error))}'
            outcome = Outcome(nothing(self._points, reason), [reason])
            kept.outcome(own, outcome, self._options.visibility)
        tqdm.write('; '.join([f'{printable(name)}: {gradescope.total(outcome.marks)}', *outcome.notes]))
        sys.stdout.flush()
        return Row(name, outcome)

    def _mark_again(self, source: str, folder: str) -> Outcome:
        """Mark a submission, unless that was done before."""
        digest = f'{self._of_tests} {intake.digest(source)}'
        outcome = kept.earlier(folder, digest)
        if outcome is None:
            kept.write(folder, kept.DIGEST, '')
            outcome = self._mark(source, folder)
            kept.write(folder, kept.DIGEST, digest)
        return outcome

    def _mark(self, source: str, folder: str) -> Outcome:
        """Mark a submission; its results go to a folder if one is given."""
        wanted = [node for launch in self._launches for node in launch.nodes]
        name = printable(intake.name_of(source))
        with scratch.folder() as place:
            with self._doing(f'{name}: taking and building it'):
                taken = Submission(source, wanted, place, self._box, self._stop)
            found = Outcome([], list(taken.notes))
            if folder and taken.workspace.log:
                kept.write(folder, BUILD_LOG, taken.workspace.log)
            for test, launch in zip(self._tests, self._launches):
                with self._doing(f'{name}: {test.name}'):
                    outcome = self._run(taken, test, launch, folder, str(place / f'{test.name}.{BAG}'))
                found = Outcome(found.marks + outcome.marks, found.notes + outcome.notes)
        if folder:
            kept.outcome(folder, found, self._options.visibility)
        return found

    def _run(self, taken: Submission, test: HiddenTest, launch: Launch, folder: str, bag: str) -> Outcome:
        """Run a test on a submission, in an examination with a recording at the path `bag`."""
        is_exam = test.arguments.get(EXAM, '').lower() in ('true', '1')
        outcome, log = taken.run(test, launch, self._options.tests, {RECORDING: bag} if is_exam else {})
        if is_exam and (os.path.exists(bag) or gradescope.score(outcome.marks)):
            outcome = Outcome(outcome.marks, outcome.notes + self._ros.examine(bag, test))
        if folder:
            kept.write(folder, f'{test.name}.log', log or taken.problem)
            if os.path.exists(bag):
                shutil.move(bag, os.path.join(folder, os.path.basename(bag)))
        return outcome
