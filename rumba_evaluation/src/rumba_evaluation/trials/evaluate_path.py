"""evaluate --path: drives along a path from a file, and prints how good it is."""

import argparse
import os
import sys
from typing import Any, Callable, List, Optional

import numpy as np

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_evaluation.scoring import path_file
from rumba_evaluation.scoring.guarded import Guarded
from rumba_evaluation.scoring.ride import AsDrawn, Driven
from rumba_evaluation.trials import batch, score
from rumba_evaluation.trials.cases import Case, Conditions
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.settings import robot_file

JSON, TEXT = FORMATS = 'json', 'text'
OF_MISSIONS = (
    'strategies', 'seeds', 'robots', 'start', 'pose', 'laser', 'margin', 'target', 'modules', 'jobs', 'scheduler')
OF_PATHS = ('as_drawn', 'guarded', 'speed', 'topic')


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of paths to a parser."""
    group = parser.add_argument_group('paths of others (with --maps, --robot, --obstacles, --drain, --bound, --output)')
    add = group.add_argument
    add('--path', default='', metavar='FILE',
        help='score a path instead of missions: CSV with x,y or t,x,y,theta in its first line, TUM trajectory, or '
             'nav_msgs/Path in a bag')
    add('--as-drawn', action='store_true', help='follow the path exactly, even if no real robot could')
    add('--guarded', action='store_true',
        help='drive around what blocks the path and back onto it, as missions do; by default, the drive ends there')
    add('--speed', type=float, default=CleaningConfig().speed, metavar='M/S',
        help='speed along the path; default %(default)s')
    add('--topic', default='', metavar='NAME', help='of the path in the bag; default: the only one')


def check_options(options: argparse.Namespace, defaults: argparse.Namespace) -> None:
    """Refuse options that have no meaning together.

    Raises:
        ConfigError: missions and paths are mixed up, or the map is missing.
    """
    wrong = OF_MISSIONS if options.path else OF_PATHS
    for name in wrong:
        if getattr(options, name) != getattr(defaults, name):
            option = {'modules': '--import'}.get(name, '--' + name.replace('_', '-'))
            raise ConfigError(f'{option} has no meaning {"with" if options.path else "without"} --path')
    if options.path and (len(options.maps) != 1 or options.maps == defaults.maps):
        raise ConfigError('--path needs --maps with the one map that the path is for')
    if options.as_drawn and options.guarded:
        raise ConfigError('--as-drawn and --guarded exclude each other: give one of them')
    fastest = robot_file.load(options.robot).drive.max_speed
    if options.path and not 0.0 < options.speed <= fastest:
        raise ConfigError(f'--speed is {options.speed:g}: must be above 0, and {fastest:g} m/s at most')


def evaluate_path(options: argparse.Namespace, conditions: Conditions, map_path: Callable[[str], str],
                  read_bag: Optional[path_file.ReadBag]) -> int:
    """Score a path as the options say; returns the exit code.

    Raises:
        RumbaError: the path, the map or the obstacles cannot be used.
    """
    robot = robot_file.load(conditions.robot)
    plan = batch.floor_plan(map_path(options.maps[0]), robot.drive.radius)
    for remark in plan.remarks:
        print(f'evaluate: {remark}', file=sys.stderr)
    path = path_file.read(options.path, options.topic, read_bag)
    config = updated(robot, {'battery': {'drain': conditions.drain}}, 'conditions')
    kind: Any = AsDrawn if options.as_drawn else Guarded if options.guarded else Driven
    ride = kind(plan, path, config, options.speed, batch.obstacles_in(conditions.obstacles))
    ride.run(conditions.bound)
    case = Case(options.maps[0], os.path.basename(options.path), 0, 1)
    found = score.of_ride(case, ride)
    document = {'path': options.path, 'as_drawn': options.as_drawn, 'guarded': options.guarded,
                **score.document(case, found.result, found.measures)}
    for name in ('strategy', 'seed', 'robots'):
        del document[name]
    if options.output:
        _write(options, conditions, found, ride, score.as_json(document))
    if options.format == JSON:
        sys.stdout.write(score.as_json(document))
    else:
        print(score.text([found]) + score.places(found), end='')
    return 0


def _write(options: argparse.Namespace, conditions: Conditions, found: score.Score, ride: Any, text: str) -> None:
    """Write the score and a picture into the folder of the options."""
    os.makedirs(options.output, exist_ok=True)
    with open(os.path.join(options.output, 'score.json'), 'w', encoding='utf-8') as file:
        file.write(text)
    if not options.no_plots:
        from rumba_evaluation.trials import plots  # here, because matplotlib is optional and loads slowly
        swept = ride.world.swept()
        job = batch.Job(found.case, conditions, ride.world.plan.name, '')
        paths: List[Any] = [np.asarray(ride.observer.path[:, :2], np.float32)]
        plots.draw_path(options.output, ride.world.plan,
                        batch.Trace(job, found.result, paths, (swept >= 0) & (swept < batch.MISSED)))
