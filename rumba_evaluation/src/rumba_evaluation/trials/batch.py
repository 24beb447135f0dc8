"""Runs many missions in parallel: on all cores of this machine, or on a Dask cluster."""

import concurrent.futures
import contextlib
import dataclasses
import functools
import multiprocessing
import os
import re
import signal
import sys
import threading
import traceback
from concurrent.futures import BrokenExecutor, Executor
from typing import Any, Callable, Iterator, List, NamedTuple, Sequence, Tuple, TypeVar

import numpy as np
from tqdm import tqdm

from rumba_cleaning import strategies
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import Case, Conditions, Result
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.errors import ConfigError, RumbaError, StrategyError
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings import robot_file
from rumba_sim.model.settings.robot_config import DriveConfig
from rumba_sim.model.simulation import obstacle_file
from rumba_sim.model.simulation.obstacle import Obstacle

SCHEDULER_TIMEOUT = 10.0  # [s]
WORKERS_PERIOD = 5.0  # [s] between two looks whether a cluster has workers
SEMAPHORES = '/dev/shm'
EXAMPLE = 'tcp://10.0.0.1:8786'
PLANS = 8  # floor plans that a worker keeps
MISSED = 50  # [%] of a cell that were swept: cells with less are shown as missed
Work = TypeVar('Work')
Done = TypeVar('Done')


class Job(NamedTuple):
    """Everything that a worker needs to run a case."""

    case: Case
    conditions: Conditions
    path: str  # of the map
    modules: str  # modules that register strategies, with commas between them


class Trace(NamedTuple):
    """The paths of robots, and the floor that they missed."""

    job: Job
    result: Result
    paths: List[Array]  # float32 (any, 2) [m] of each robot
    missed: Array  # bool (rows, columns): reachable but not swept


@functools.lru_cache(maxsize=PLANS)
def floor_plan(path: str, radius: float = DriveConfig().radius) -> FloorPlan:
    """The floor plan in a file, for robots of a radius [m]; the last few are kept in memory.

    Raises:
        MapError: it cannot be used.
    """
    return map_file.load(path, radius)


@functools.lru_cache(maxsize=1)
def obstacles_in(path: str) -> Tuple[Obstacle, ...]:
    """The obstacles in a file; none if the path is empty.

    Raises:
        ConfigError: they cannot be used.
    """
    return tuple(obstacle_file.load(path)) if path else ()


def prepare(job: Job) -> Trial:
    """The trial of a job.

    Raises:
        RumbaError: the map, the strategy, the obstacles or the number of robots cannot be used.
    """
    strategies.load(job.modules)
    robot = robot_file.load(job.conditions.robot)
    plan, obstacles = floor_plan(job.path, robot.drive.radius), obstacles_in(job.conditions.obstacles)
    try:
        return Trial(plan, job.case.strategy, job.conditions, job.case.seed, job.case.robots, obstacles, robot)
    except RumbaError:
        raise
    except (Exception, SystemExit) as error:  # in the code that makes a strategy
        raise StrategyError(f'{job.case.strategy} cannot be made on {job.case.map}: {_described(error)}') from None


def run(job: Job) -> Result:
    """Run the trial of a job to its end."""
    return finish(prepare(job))


def trace(job: Job) -> Trace:
    """Run a trial again, and record the paths of the robots."""
    trial = prepare(job)
    robots = list(trial.world.robots.values())
    paths: List[List[Tuple[float, float]]] = [[robot.pose[:2]] for robot in robots]

    def record() -> None:
        for robot, path in zip(robots, paths):
            if robot.pose[:2] != path[-1]:
                path.append(robot.pose[:2])

    result = finish(trial, record)
    swept = trial.world.swept()
    missed = (swept >= 0) & (swept < MISSED)
    return Trace(job, result, [np.array(path, np.float32) for path in paths], missed)


def finish(trial: Trial, after_each_step: Callable[[], None] = lambda: None) -> Result:
    """Run a trial to its end; an exception of a strategy gives a result too."""
    try:
        while not trial.is_over:
            trial.step()
            after_each_step()
    except (Exception, SystemExit) as error:  # in a strategy: the other missions go on
        return dataclasses.replace(trial.result(), outcome=Outcome.ERROR, message=_described(error))
    return trial.result()


def _described(error: BaseException) -> str:
    """What was raised, and in which line of which file."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f'{type(error).__name__}: {error} ({os.path.basename(frame.filename)}:{frame.lineno})'


# --- workers ------------------------------------------------------------------------------------------------------

def each(executor: Executor, function: Callable[[Work], Done], jobs: Sequence[Work],
         unit: str) -> Iterator[Tuple[Work, Done]]:
    """Jobs with the results of a function, in the order in which they are finished; shows a progress bar."""
    futures = {executor.submit(function, job): job for job in jobs}
    with tqdm(total=len(jobs), unit=f' {unit}', disable=None) as bar:
        for future in concurrent.futures.as_completed(futures):
            yield futures[future], future.result()
            bar.update()


@contextlib.contextmanager
def local(count: int) -> Iterator[Executor]:
    """Processes on this machine.

    Raises:
        ConfigError: the system has no semaphores for them.
    """
    try:
        executor = concurrent.futures.ProcessPoolExecutor(count, initializer=_begin_worker)
    except (OSError, ImportError) as error:
        raise ConfigError('processes that work in parallel need semaphores, for which this system has no room '
                          f'({error}): make {SEMAPHORES} a writable folder') from None
    try:
        yield executor
    except BaseException:
        for process in multiprocessing.active_children():  # else shutdown waits for missions that are not needed
            process.terminate()
        raise
    finally:
        executor.shutdown()


def _begin_worker() -> None:
    """Ignore Ctrl-C, which the parent process handles, and end with the parent even if that is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextlib.contextmanager
def remote(address: str) -> Iterator[Executor]:
    """The workers of a Dask cluster; they need this package and the maps at the same paths as this machine.

    Args:
        address: of the scheduler, as in EXAMPLE.

    Raises:
        ConfigError: Dask is not installed, or no scheduler answers.
        BrokenExecutor: the scheduler or the workers died.
    """
    try:
        import distributed
    except ImportError:
        raise ConfigError('--scheduler needs Dask: install the package python3-distributed') from None
    if not re.fullmatch(r'(\w+://)?.+:\d+', address):
        raise ConfigError(f'--scheduler {address}: must be the address of a Dask scheduler, as in {EXAMPLE}')
    make_client: Any = distributed.Client
    try:
        client = make_client(address, timeout=SCHEDULER_TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ConfigError(f'--scheduler {address}: no Dask scheduler answers there ({error})') from None
    has_ended = threading.Event()
    with client:
        watch = threading.Thread(target=watch_workers, daemon=True, args=[
            address, lambda: bool(client.scheduler_info()['workers']), has_ended])
        watch.start()
        try:
            yield client.get_executor(pure=False)
        except (distributed.scheduler.KilledWorker, concurrent.futures.CancelledError) as error:
            raise BrokenExecutor(f'{address}: {type(error).__name__}') from error
        finally:
            has_ended.set()
            watch.join(WORKERS_PERIOD)


def watch_workers(address: str, has_workers: Callable[[], bool], has_ended: threading.Event) -> None:
    """Say that a cluster has no workers, each time that begins, and that it has some again; look until the end.

    Args:
        address: of its scheduler.
        has_workers: whether it has any now; may raise an OSError while the scheduler does not answer.
        has_ended: whether nobody waits for it any more.
    """
    had_any, period = True, 0.0
    while not has_ended.wait(period):
        with contextlib.suppress(OSError):
            has_any = has_workers()
            if had_any and not has_any:
                print(f'evaluate: {address} has no workers: waiting for them', file=sys.stderr, flush=True)
            elif has_any and not had_any:
                print(f'evaluate: {address} has workers now', file=sys.stderr, flush=True)
            had_any = has_any
        period = WORKERS_PERIOD
