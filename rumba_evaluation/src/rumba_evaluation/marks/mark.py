"""mark: marks submissions by hidden .test files, each against a world and a master of its own, and prints the points.

A submission is a script, a package, a workspace, or a zip or tar file of them. It is built and run in a sandbox, where
bubblewrap can make one. Each test runs in the time of its world: with lockstep, the same submission gets the same marks
on any machine. Beside the table, results.json is for Gradescope, and a log of each test for the teacher. With --all,
each folder, archive and script in FOLDER is a submission; they are marked in parallel, marks.csv lists them, and after
an interruption the same command goes on. docs/teaching.md shows a course, and what the sandbox promises.

NAME:=VALUE is an argument that the .test files declare.
"""

import argparse
import os
import signal
import sys
from typing import Dict, Sequence, Tuple

from rumba_evaluation.marks import gradescope, kept
from rumba_evaluation.marks.marking import Marking, Ros
from rumba_evaluation.submissions import scratch
from rumba_evaluation.submissions.supervised import Stopped
from rumba_sim.model.common.command_line import BAD_INPUT, ERROR, INTERRUPTED, Parser
from rumba_sim.model.common.errors import RumbaError

NAME = 'mark'


def main(arguments: Sequence[str], ros: Ros) -> int:
    """Run the command with the arguments of a command line, without the name of the program; returns the exit code."""
    options, given = _options(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        scratch.remove_abandoned()
        marking = Marking(options, given, ros)
        return marking.mark_all() if options.all else marking.mark_one()
    except RumbaError as error:
        message = ' '.join([f'{NAME}:', *str(error).split()])
        print(message, file=sys.stderr)
        if options.output:  # a grader shows students what it finds there
            kept.write(options.output, kept.RESULTS, gradescope.document([], options.visibility, message))
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
    add('submission', nargs='?', default='', help='one submission: a folder, an archive or a script')
    add('--all', default='', metavar='FOLDER', help='folder with the submissions of a class')
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
        parser.error('give one submission, or --all FOLDER')
    if options.jobs < 1:
        parser.error(f'--jobs is {options.jobs}: must be at least 1')
    return options, given
