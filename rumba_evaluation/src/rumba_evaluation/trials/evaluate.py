"""evaluate: runs cleaning missions in process, without ROS and faster than real time, and prints how well they went.

With --path, it drives along a path that somebody else planned, and prints how good that is. Otherwise it
runs a mission for each map, strategy, number of robots and seed. Each result is written to DIR/results.csv as soon as
the mission has ended: after an interruption the same command goes on from there. At the end it prints a table and
draws pictures, for which it needs matplotlib.
"""

import argparse
import contextlib
import dataclasses
import fcntl
import os
import re
import sys
from concurrent.futures import BrokenExecutor, Executor
from typing import Callable, ContextManager, Dict, Iterator, List, Optional, Sequence

from rumba_cleaning import strategies
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.scoring.path_file import ReadBag
from rumba_evaluation.trials import batch, evaluate_path, score, table
from rumba_evaluation.trials.batch import Job
from rumba_evaluation.trials.cases import ANYWHERE, DOCK, POSES, TRUTH, Case, Conditions, Result, grid
from rumba_evaluation.trials.foresight import remarks_on
from rumba_evaluation.trials.results import Results
from rumba_sim.model.common.command_line import BAD_INPUT, ERROR, INTERRUPTED, Parser
from rumba_sim.model.common.config import explain, updated
from rumba_sim.model.common.errors import ConfigError, RumbaError
from rumba_sim.model.maps import named_maps
from rumba_sim.model.settings.laser_config import IDEAL, MODELS

NAME = 'evaluate'
FOLDER = 'evaluation'
MAPS = ('apartment', 'studio', 'field')
STRATEGIES = ('boustrophedon', 'bounce')
LOCK = '.evaluate.lock'  # in the folder for results; stays there, but is locked only while a process writes there
MOST = 1_000_000  # seeds


def command() -> None:
    """Run the command line of this process, without ROS; leaves the process with the exit code."""
    sys.exit(main(sys.argv[1:]))


def main(arguments: Sequence[str], map_path: Callable[[str], str] = named_maps.path,
         read_bag: Optional[ReadBag] = None) -> int:
    """Run the command with the arguments of a command line; returns the exit code.

    Args:
        arguments: without the name of the program.
        map_path: finds the path of a map by its name, or raises MapError.
        read_bag: reads a path from a bag; None where there is no ROS.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        evaluate_path.check_options(options, parser.parse_args([]))
        conditions = updated(Conditions(), {field.name: getattr(options, field.name)
                                            for field in dataclasses.fields(Conditions)}, 'conditions')
        if not options.no_plots and (options.output or not options.path):
            _check_matplotlib()
        if options.path:
            return evaluate_path.evaluate_path(options, conditions, map_path, read_bag)
        return _evaluate(options, conditions, map_path)
    except RumbaError as error:
        print(f'{NAME}:', *str(error).split(), file=sys.stderr)
        return BAD_INPUT
    except OSError as error:  # for example no space left
        print(f'{NAME}: {error}', file=sys.stderr)
        return ERROR
    except KeyboardInterrupt:
        print(f'{NAME}: stopped before the first mission', file=sys.stderr)
        return INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    about, details = (__doc__ or '').split('\n\n')
    parser = Parser(NAME, description=about, epilog=details, allow_abbrev=False)
    add = parser.add_argument
    add('--maps', nargs='+', default=MAPS, metavar='MAP', help='names of maps of rumba_sim, or paths of map_server '
                                                               f'YAML files; default {" ".join(MAPS)}')
    add('--strategies', nargs='+', default=STRATEGIES, metavar='NAME',
        help=f'names of cleaning strategies; default {" ".join(STRATEGIES)}')
    add('--seeds', type=_seeds, default='10', metavar='N or A-B', help='seeds 1 to N, or A to B; default 10')
    add('--robots', type=_positive, nargs='+', default=[1], metavar='N', help='numbers of robots; default 1')
    add('--start', choices=(DOCK, ANYWHERE), default=DOCK,
        help='where robots start: at the start of the map, or anywhere, drawn from the seed; default %(default)s')
    add('--pose', choices=POSES, default=TRUTH,
        help='where robots get their pose: the truth, laser and odometry, odometry, their own map, or nowhere, without '
             'map and laser; default %(default)s')
    add('--obstacles', type=_path, default='', metavar='FILE',
        help='YAML file of obstacles that the maps do not show, and that the robots do not know')
    add('--robot', type=_path, default='', metavar='FILE',
        help='YAML file with settings of a robot, as in config/rumba.yaml of rumba_sim, that are to be others')
    add('--laser', action='store_true', help='robots drive around what their lasers see and the maps do not show')
    add('--laser-model', choices=tuple(MODELS), default=IDEAL, help='laser of the robots; default %(default)s')
    for field in dataclasses.fields(Conditions):
        if isinstance(field.default, float):
            add(f'--{field.name}', type=float, default=field.default,
                help=f'{explain(field)}; default {field.default:g}'.replace('%', '%%'))
    add('--import', dest='modules', default='', metavar='MODULES',
        help='Python modules that register strategies, with commas between them')
    add('--output', default='', metavar='DIR', help=f'folder for results, table and pictures; default ./{FOLDER}, and '
                                                    'none with --path')
    add('--format', choices=evaluate_path.FORMATS, default=evaluate_path.TEXT,
        help='what to print: a table, or JSON; default %(default)s')
    add('--jobs', type=_positive, default=len(os.sched_getaffinity(0)), metavar='N',
        help='number of missions that run in parallel; default %(default)s, all cores')
    add('--scheduler', default='', metavar='ADDRESS', help='run on a Dask cluster: address of its scheduler')
    add('--no-plots', action='store_true', help='draw no pictures; without this option matplotlib is needed')
    evaluate_path.add_options(parser)
    return parser


def _seeds(text: str) -> List[int]:
    match = re.fullmatch(r'(?:(\d{1,15})-)?(\d{1,15})', text, re.ASCII)
    first, last = (int(match.group(1) or 1), int(match.group(2))) if match else (1, 0)
    if not first <= last < first + MOST:
        raise argparse.ArgumentTypeError(f'{text!r} must be a number of seeds, as in 10, or the first and the last, '
                                         'as in 11-20')
    return list(range(first, last + 1))


def _path(text: str) -> str:
    return os.path.abspath(text) if text else ''


def _positive(text: str) -> int:
    if not re.fullmatch(r'[1-9]\d{0,3}', text, re.ASCII):
        raise argparse.ArgumentTypeError(f'{text!r} must be a whole number, 1 or more')
    return int(text)


# --- the work -----------------------------------------------------------------------------------------------------

def _evaluate(options: argparse.Namespace, conditions: Conditions, map_path: Callable[[str], str]) -> int:
    options.output = options.output or FOLDER
    cases = grid(options.maps, options.strategies, options.seeds, options.robots)
    jobs = _jobs(cases, conditions, {name: map_path(name) for name in options.maps}, options.modules)
    with _locked(options.output):
        results = Results(_in_folder(options.output, 'results.csv'), conditions)
        return _evaluate_jobs(options, jobs, results)


def _evaluate_jobs(options: argparse.Namespace, jobs: Sequence[Job], results: Results) -> int:
    cases = [job.case for job in jobs]
    try:
        with _workers(options) as executor:
            _run_missing(executor, jobs, results)
            results.arrange(cases)
            _report(options, cases, results.found)
            if not options.no_plots:
                _draw(executor, options.output, jobs, results.found)
    except KeyboardInterrupt:
        print(f'{NAME}: stopped; {_progress(cases, results)}; the same command goes on from there',
              file=sys.stderr)
        return INTERRUPTED
    except BrokenExecutor as error:
        print(f'{NAME}: the workers have died, perhaps for lack of memory ({error}); {_progress(cases, results)}; '
              'the same command, perhaps with fewer --jobs, goes on from there', file=sys.stderr)
        return ERROR
    finally:
        results.close()
    failed = [case for case in cases if results.found[case].outcome is Outcome.ERROR]
    for case in failed:
        print(f'{NAME}: {case.strategy} raised an exception on {case.map}, seed {case.seed}, robots {case.robots}: '
              f'{results.found[case].message}', file=sys.stderr)
    return ERROR if failed else 0


def _check_matplotlib() -> None:
    """Fail before the first mission, not after the last one."""
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise ConfigError(f'pictures need matplotlib ({error}): install the package python3-matplotlib (with pip: '
                          'matplotlib), or give --no-plots') from error


def _jobs(cases: Sequence[Case], conditions: Conditions, paths: Dict[str, str], modules: str) -> List[Job]:
    """A job for each case; checks maps, strategies and numbers of robots before the first job begins.

    Raises:
        RumbaError: one of them cannot be used.
    """
    strategies.load(modules)
    for name in dict.fromkeys(case.strategy for case in cases):
        strategies.check(name)
    jobs = [Job(case, conditions, os.path.abspath(paths[case.map]), modules) for case in cases]
    most = max(case.robots for case in cases)
    for job in {job.case.map: job for job in jobs if job.case.robots == most}.values():
        for remark in remarks_on(batch.prepare(job)):
            print(f'{NAME}: {remark}', file=sys.stderr)
    return jobs


@contextlib.contextmanager
def _locked(folder: str) -> Iterator[None]:
    """Keep a folder for this process; the lock ends with the process, however that ends, and workers do not inherit it.

    Raises:
        ConfigError: another process writes there, or nobody can.
    """
    path = _in_folder(folder, LOCK)
    try:
        lock = open(path, 'w')
    except OSError as error:
        raise ConfigError(f'{path}: {error.strerror}: --output must be a writable folder') from None
    with lock:
        try:
            fcntl.lockf(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ConfigError(f'{folder}: another evaluate writes its results there: wait until it has ended, or '
                              'choose another --output') from None
        except OSError:  # a file system without locks
            pass
        yield


def _in_folder(folder: str, name: str) -> str:
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise ConfigError(f'{folder}: {error.strerror}: --output must be a writable folder') from None
    return os.path.join(folder, name)


def _workers(options: argparse.Namespace) -> ContextManager[Executor]:
    return batch.remote(options.scheduler) if options.scheduler else batch.local(options.jobs)


def _progress(cases: Sequence[Case], results: Results) -> str:
    return f'{sum(case in results.found for case in cases)} of {len(cases)} missions are in {results.path}'


def _run_missing(executor: Executor, jobs: Sequence[Job], results: Results) -> None:
    missing = [job for job in jobs if job.case not in results.found]
    if len(missing) < len(jobs):
        print(f'{NAME}: {_progress([job.case for job in jobs], results)} already; to run them again, delete it or '
              'choose another --output', file=sys.stderr)
    for job, result in batch.each(executor, batch.run, missing, 'missions'):
        results.add(job.case, result)


def _report(options: argparse.Namespace, cases: Sequence[Case], found: Dict[Case, Result]) -> None:
    """Print the tables or JSON, and write the tables and the curves to files."""
    tables, folder = table.text(table.grouped(cases, found)), options.output
    if options.format == evaluate_path.JSON:
        sys.stdout.write(score.as_json({'missions': [score.document(case, found[case]) for case in cases]}))
    else:
        print(tables, end='')
    table.write_curves(_in_folder(folder, 'coverage.csv'), cases, found)
    with open(_in_folder(folder, 'table.txt'), 'w', encoding='utf-8') as file:
        file.write(tables)


def _draw(executor: Executor, folder: str, jobs: Sequence[Job], found: Dict[Case, Result]) -> None:
    """Draw pictures: of all results, and of the path of the slowest mission of each group."""
    from rumba_evaluation.trials import plots  # here, because matplotlib is optional and loads slowly
    plots.draw_results(folder, table.grouped([job.case for job in jobs], found))
    slowest: Dict[table.Group, Job] = {}
    for job in jobs:
        group = table.group(job.case)
        slowest[group] = max(slowest.get(group, job), job, key=lambda one: found[one.case].multiple_to(98))
    for job, trace in batch.each(executor, batch.trace, list(slowest.values()), 'pictures'):
        plots.draw_path(folder, batch.floor_plan(job.path), trace)
