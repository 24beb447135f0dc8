"""rumba-benchmark: scores cleaning strategies, and the paths of other planners, on five floors, with one table.

Writes the floors into FOLDER/floors, as maps of map_server on which other planners can plan. With --paths, each folder
DIR/PLANNER with files named like the floors, as lounge.csv, is a planner of its own in the table. The robot drives
around what blocks such a path and back onto it, as missions do.
"""

import argparse
import os
import pathlib
import sys
from typing import Any, Dict, List, NamedTuple, Sequence

from rumba_cleaning import strategies
from rumba_evaluation.scoring import path_file
from rumba_evaluation.scoring.drawn_path import PathError
from rumba_evaluation.scoring.guarded import Guarded
from rumba_evaluation.scoring.measures import Observer
from rumba_evaluation.scoring.ride import AsDrawn
from rumba_evaluation.trials import batch, score
from rumba_evaluation.trials.cases import Case, Conditions
from rumba_evaluation.trials.evaluate_path import FORMATS, JSON, TEXT
from rumba_evaluation.trials.floors import FLOORS
from rumba_evaluation.trials.score import Score
from rumba_sim.model.common.command_line import BAD_INPUT, INTERRUPTED, Parser
from rumba_sim.model.common.errors import ConfigError, RumbaError

NAME = 'rumba-benchmark'
SEEDS = 3
BOUND = 6.0  # [T]
ENDINGS = ('.csv', '.tum', '.txt')


class Task(NamedTuple):
    """One drive: a mission of a strategy, or along the path of a file."""

    case: Case
    map: str  # path of the map
    path: str  # of the file; empty for a mission
    as_drawn: bool


def command() -> None:
    """Run the command line of this process; leaves the process with the exit code."""
    sys.exit(main(sys.argv[1:]))


def main(arguments: Sequence[str]) -> int:
    """Run the command with the arguments of a command line; returns the exit code."""
    about, details = (__doc__ or '').split('\n\n')
    parser = Parser(NAME, description=about, epilog=details, allow_abbrev=False)
    add = parser.add_argument
    add('folder', metavar='FOLDER', help='for the floors')
    add('--paths', default='', metavar='DIR', help='folder with a folder for each planner')
    add('--as-drawn', action='store_true', help='follow these paths exactly, even if no real robot could')
    add('--strategies', nargs='*', default=strategies.known(), metavar='NAME', help='default: all')
    add('--seeds', type=int, choices=range(1, 1001), default=SEEDS, metavar='N',
        help='seeds 1 to N; default %(default)s')
    add('--jobs', type=int, choices=range(1, 1001), default=len(os.sched_getaffinity(0)), metavar='N',
        help='drives in parallel; default %(default)s, all cores')
    add('--floors-only', action='store_true', help='write the floors, and end')
    add('--format', choices=FORMATS, default=TEXT, help='what to print: a table, or JSON; default %(default)s')
    options = parser.parse_args(arguments)
    try:
        return _benchmark(options)
    except (RumbaError, OSError) as error:
        print(f'{NAME}:', *str(error).split(), file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print(f'{NAME}: stopped', file=sys.stderr)
        return INTERRUPTED


def _benchmark(options: argparse.Namespace) -> int:
    for name in options.strategies:
        strategies.check(name)
    maps = draw(pathlib.Path(options.folder) / 'floors')
    if options.floors_only:
        print(*maps.values(), sep='\n')
        return 0
    order = {name: number for number, name in enumerate(maps)}
    tasks = sorted(_missions(options, maps) + _paths(options, maps), key=lambda task: order[task.case.map])
    with batch.local(options.jobs) as executor:
        found: Dict[Any, Score] = dict(batch.each(executor, run, tasks, 'drives'))
    scores = [found[task] for task in tasks]
    if options.format == JSON:
        sys.stdout.write(score.as_json({'drives': [score.document(one.case, one.result, one.measures)
                                                   for one in scores]}))
    else:
        print(score.text(scores), end='')
    return 0


def draw(folder: pathlib.Path) -> Dict[str, str]:
    """Write the floors into a folder; returns the path of each map by its name."""
    folder.mkdir(parents=True, exist_ok=True)
    for make in FLOORS.values():
        make(folder)
    return {name: str(folder / f'{name}.yaml') for name in FLOORS}


def _missions(options: argparse.Namespace, maps: Dict[str, str]) -> List[Task]:
    return [Task(Case(floor, name, seed, 1), path, '', False) for floor, path in maps.items()
            for name in options.strategies for seed in range(1, options.seeds + 1)]


def _paths(options: argparse.Namespace, maps: Dict[str, str]) -> List[Task]:
    """A task for each file of each planner; reads the files, so that a bad one is refused before the first drive."""
    if not options.paths:
        return []
    planners = sorted(folder for folder in pathlib.Path(options.paths).iterdir() if folder.is_dir())
    files = [(planner, path) for planner in planners for path in sorted(planner.iterdir()) if path.suffix in ENDINGS]
    if not files:
        raise ConfigError(f'{options.paths}: has no path: must be as PLANNER/{next(iter(maps))}.csv')
    tasks = []
    for planner, path in files:
        if path.stem not in maps:
            raise PathError(f'{path}: there is no floor {path.stem!r}: floors are {", ".join(maps)}')
        tasks.append(Task(Case(path.stem, planner.name, 0, 1), maps[path.stem], str(path), options.as_drawn))
        _ride(tasks[-1])
    return tasks


def _ride(task: Task) -> Any:
    kind: Any = AsDrawn if task.as_drawn else Guarded
    return kind(batch.floor_plan(task.map), path_file.read(task.path))


def run(task: Task) -> Score:
    """The score of one drive."""
    if task.path:
        ride = _ride(task)
        ride.run(BOUND)
        return score.of_ride(task.case, ride)
    trial = batch.prepare(batch.Job(task.case, Conditions(bound=BOUND), task.map, ''))
    [robot] = trial.world.robots.values()
    observer = Observer(trial.world, robot)
    trial.advance = observer.advance
    return Score(task.case, batch.finish(trial), observer.measures())
