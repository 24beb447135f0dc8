"""One submission: the hidden tests that run on it, each in a world of its own, and what became of them."""

import contextlib
import json
import os
import pathlib
import xml.sax.saxutils
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

from rumba_evaluation.marks.gradescope import beside, marks_of
from rumba_evaluation.marks.hidden_tests import HiddenTest
from rumba_evaluation.marks.scheme import Mark, nothing
from rumba_evaluation.submissions import supervised
from rumba_evaluation.submissions.diagnosis import mistakes
from rumba_evaluation.submissions.diagnosis.mistakes import Wanted
from rumba_evaluation.submissions.diagnosis.quotations import printable
from rumba_evaluation.submissions.sandbox import Bubblewrap, Plain
from rumba_evaluation.submissions.supervised import Limits, Stop
from rumba_evaluation.submissions.workspace import Problem, Workspace

PACKAGE = 'submission'  # as rostest calls the folder for results
LONGEST_LOG = 1_000_000  # characters
STDOUT = '-stdout.log'  # end of the name of such a file
LAUNCHED = 'RUMBA_LAUNCHED'  # names the file from which nodes of Rumba take their parameters


class Outcome(NamedTuple):
    """What became of a submission."""

    marks: List[Mark]
    notes: List[str]  # what went wrong, beside the marks


class Launch(NamedTuple):
    """What a .test file starts.

    Attributes:
        nodes: those of the submission.
        trusted: full names of the others.
        judges: full names of those that give points.
        parameters: all that it sets, by their full names.
    """

    nodes: Sequence[Wanted]
    trusted: Sequence[str]
    judges: Sequence[str]
    parameters: Mapping[str, Any]


class Submission:
    """A submission in a scratch folder: its workspace, and beside it what it must not see."""

    def __init__(self, source: str, wanted: Sequence[Wanted], folder: pathlib.Path, box: Union[Plain, Bubblewrap],
                 stop: Stop = None) -> None:
        """Take a submission, and build it if that is needed."""
        self._ours, self._box, self._stop = folder / 'ours', box, stop
        self._ours.mkdir()
        self.problem = ''
        self.workspace = Workspace(folder / 'own', box, stop)
        try:
            self.workspace.take(source, wanted)
        except Problem as problem:
            found = mistakes.of_build(self.workspace.log) if self.workspace.log else []
            self.problem = ': '.join([str(problem), *found[:1]])
        self._mistakes = mistakes.of_submission(self.workspace.source, wanted)
        self.notes = [printable(note) for note in self.workspace.notes]

    def run(self, test: HiddenTest, launch: Launch, tests: str, more: Mapping[str, Any]) -> Tuple[Outcome, str]:
        """Run one hidden test; returns the outcome and what the run printed.

        Args:
            test: the test.
            launch: what it starts.
            tests: folder whose packages are found before all others.
            more: further private parameters of the judges.
        """
        if self.problem:
            return self._outcome(test, {}, self.problem, [self.problem, *self._mistakes]), self.workspace.log
        folder = self._ours / test.name
        programs = self.workspace.install(launch.nodes, folder / 'prefix')
        file = folder / f'{test.name}.test'
        given = {f'{judge}/{name}': value for judge in launch.judges for name, value in more.items()}
        file.write_text(_launch_file(test, given))
        (folder / 'launched.json').write_text(json.dumps(
            {'nodes': launch.trusted, 'parameters': {**launch.parameters, **given}}))
        results = folder / 'results'
        command = ['rostest', f'--pkgdir={folder}', f'--package={PACKAGE}', f'--results-base-dir={results}', str(file)]
        done = supervised.run(self._box.around_test(command), self._environment(folder, tests),
                              str(self._ours.parent), Limits(test.patience), self._stop)
        marks = {}
        for name in test.points:
            with contextlib.suppress(OSError, ValueError):
                marks[name] = marks_of((pathlib.Path(beside(
                    str(results / PACKAGE / f'rosunit-{name}.xml')))).read_text())
        output = done.output + _printed(folder / 'log', launch.trusted)
        told = output + ''.join(map(_beginning, sorted((folder / 'log').glob('rostest-*.log'))))
        for path, program in programs.items():
            told = told.replace(path, program)
        found = [*([done.stopped] if done.stopped else []), *self._mistakes, *mistakes.of_run(told)]
        reason = 'the test gave no verdict: ' + (found[0] if found else 'see the log')
        return self._outcome(test, marks, reason, found), output

    def _environment(self, folder: pathlib.Path, tests: str) -> Dict[str, str]:
        """The environment of the world, the judge and hidden nodes."""
        kept = {name: value for name, value in os.environ.items()
                if name not in ('ROS_MASTER_URI', 'ROS_IP', 'ROS_NAMESPACE')}  # rostest starts a master of its own
        for name in ('ros', 'log', 'tmp'):
            (folder / name).mkdir()
        prefix = folder / 'prefix'
        return {**kept, 'ROS_HOME': str(folder / 'ros'), 'ROS_LOG_DIR': str(folder / 'log'),
                'TMPDIR': str(folder / 'tmp'), 'ROS_HOSTNAME': 'localhost', LAUNCHED: str(folder / 'launched.json'),
                'CMAKE_PREFIX_PATH': os.pathsep.join([str(prefix), kept.get('CMAKE_PREFIX_PATH', '')]),
                'ROS_PACKAGE_PATH': os.pathsep.join([os.path.abspath(tests), str(prefix / 'share'),
                                                     kept.get('ROS_PACKAGE_PATH', '')])}

    @staticmethod
    def _outcome(test: HiddenTest, marks: Dict[str, List[Mark]], reason: str, notes: Sequence[str]) -> Outcome:
        """The marks of a test, with nothing for a verdict that is missing."""
        found: List[Mark] = []
        for name, points in test.points.items():
            each = {mark.name: mark for mark in marks.get(name, nothing(points, reason))}
            found += [each.get(condition, nothing({condition: most}, reason)[0])._replace(name=f'{name}.{condition}')
                      for condition, most in points.items()]
        is_full = all(mark.score == mark.max_score for mark in found)
        return Outcome(found, [] if is_full else [f'{test.name}: {note}' for note in dict.fromkeys(notes)])


def _printed(folder: pathlib.Path, trusted: Sequence[str]) -> str:
    """What nodes of a submission have printed, which roslaunch keeps in files."""
    found = ''
    for path in sorted(folder.glob(f'*/*{STDOUT}')):
        name = path.name[:-len(STDOUT)].rpartition('-')[0]  # without the number that roslaunch gives it
        text = '' if any(each.rpartition('/')[2] == name for each in trusted) else _beginning(path)
        found += f'\n--- {name} printed ---\n{text}' if text else ''
    return found


def _beginning(path: pathlib.Path) -> str:
    """What a log tells, unless it is far too long."""
    with open(path, encoding='utf-8', errors='replace') as file:
        return file.read(LONGEST_LOG)


def _launch_file(test: HiddenTest, parameters: Mapping[str, Any]) -> str:
    quote = xml.sax.saxutils.quoteattr
    more = ''.join(f'  <param name={quote(name)} value={quote(str(value))} />\n' for name, value in parameters.items())
    arguments = ''.join(f'    <arg name={quote(name)} value={quote(value)} />\n'
                        for name, value in test.arguments.items())
    return f'<launch>\n{more}  <include file={quote(test.path)}>\n{arguments}  </include>\n</launch>\n'
