"""Workers of this machine, which end with their parent process, and workers of a Dask cluster."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import BrokenExecutor, CancelledError

import pytest
from evaluations import case, register_simple_strategies, small_map

from rumba_cleaning import strategies
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials import batch
from rumba_evaluation.trials.batch import Job
from rumba_evaluation.trials.cases import Conditions
from rumba_sim.model.common.errors import ConfigError

TIMEOUT = 10.0  # [s]
PARENT = '''
import os, time
from rumba_evaluation.trials import batch

def rest(_):
    os.write(1, b'%d\\n' % os.getpid())
    time.sleep(600.0)

with batch.local(2) as executor:
    list(executor.map(rest, range(2)))
'''


@pytest.fixture(autouse=True)
def _simple_strategies(monkeypatch):
    register_simple_strategies(monkeypatch)


def job(folder, strategy, seed=1, **conditions):
    """A job on the small map."""
    return Job(case(strategy=strategy, seed=seed), Conditions(**conditions), small_map(folder), 'simple_strategies')


def is_alive(process):
    """Whether there is a process of this number that is not a zombie."""
    try:
        with open(f'/proc/{process}/stat') as file:
            return file.read().rpartition(')')[2].split()[0] != 'Z'
    except OSError:
        return False


@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_workers_end_with_their_parent_process(number):
    with subprocess.Popen([sys.executable, '-c', PARENT], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}) as parent:
        try:
            workers = [int(parent.stdout.readline()) for _ in range(2)]
            assert all(is_alive(worker) for worker in workers)
            parent.send_signal(number)
            parent.wait(TIMEOUT)
        finally:
            parent.kill()
    until = time.monotonic() + TIMEOUT
    while any(is_alive(worker) for worker in workers):
        assert time.monotonic() < until
        time.sleep(0.02)


def test_a_path_leads_from_the_start_to_the_end(tmp_path):
    traced = batch.trace(job(tmp_path, 'ahead', bound=0.3))
    [path] = traced.paths
    plan = batch.floor_plan(traced.job.path)
    assert path[0].tolist() == pytest.approx([traced.result.x, traced.result.y])
    assert len(path) > 5 and (abs(path[1:] - path[:-1]) < 0.06).all()
    assert traced.missed.shape == plan.occupancy.shape
    assert traced.missed.sum() * plan.resolution ** 2 == pytest.approx(
        (1.0 - traced.result.coverage) * traced.result.area, rel=0.25)  # cells of 5 cm, or none at the rim
    assert traced.result == batch.run(traced.job)


def test_a_worker_imports_the_strategies_of_a_job(tmp_path, monkeypatch):
    monkeypatch.setattr(strategies, '_factories', {})
    monkeypatch.delitem(sys.modules, 'simple_strategies')
    assert batch.run(job(tmp_path, 'turn', bound=0.01)).outcome is Outcome.TIMED_OUT


def test_a_worker_reads_a_map_once(tmp_path):
    batch.floor_plan.cache_clear()
    for seed in (1, 2):
        batch.run(job(tmp_path, 'turn', seed, bound=0.01))
    assert batch.floor_plan.cache_info().misses == 1


@pytest.mark.thorough
def test_dask_finds_the_same_results(tmp_path):
    distributed = pytest.importorskip('distributed', reason='Dask is optional: the package python3-distributed')
    jobs = [job(tmp_path, 'bounce', seed, bound=0.5) for seed in (1, 2, 3)]
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=50,
                                  local_directory=str(tmp_path)) as cluster:
        with batch.remote(cluster.scheduler_address) as executor:
            found = dict(batch.each(executor, batch.run, jobs, 'missions'))
        with pytest.raises(BrokenExecutor, match='tcp://.*: CancelledError'):
            with batch.remote(cluster.scheduler_address):
                raise CancelledError  # as Dask does if the scheduler has died
    assert found == {one: batch.run(one) for one in jobs}


def test_a_cluster_that_loses_its_last_worker_in_the_middle_is_told_once(monkeypatch, capsys):
    monkeypatch.setattr(batch, 'WORKERS_PERIOD', 0.001)
    has_ended = threading.Event()
    looks = [False, False, True, True, OSError('busy'), False, False, OSError('busy'), True]

    def has_workers():
        look = looks.pop(0)
        if not looks:
            has_ended.set()
        if isinstance(look, OSError):
            raise look
        return look
    batch.watch_workers('tcp://x:1', has_workers, has_ended)
    lost, come = 'evaluate: tcp://x:1 has no workers: waiting for them', 'evaluate: tcp://x:1 has workers now'
    assert capsys.readouterr().err.splitlines() == [lost, come, lost, come]


@pytest.mark.thorough
def test_it_says_so_if_the_workers_of_a_real_cluster_leave(tmp_path, monkeypatch, capsys):
    distributed = pytest.importorskip('distributed', reason='Dask is optional: the package python3-distributed')
    monkeypatch.setattr(batch, 'WORKERS_PERIOD', 0.1)
    said = ''
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=50,
                                  local_directory=str(tmp_path)) as cluster:
        with batch.remote(cluster.scheduler_address):
            cluster.scale(0)
            until = time.monotonic() + TIMEOUT
            while 'has no workers: waiting for them' not in said:
                assert time.monotonic() < until
                said += capsys.readouterr().err
                time.sleep(0.05)


def test_a_system_without_semaphores_is_named(monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, 'Permission denied')
    monkeypatch.setattr(batch.concurrent.futures, 'ProcessPoolExecutor', refuse)
    with pytest.raises(ConfigError, match=r'need semaphores, for which this system has no room \(\[Errno 13\] '
                                          r'Permission denied\): make /dev/shm a writable folder$'):
        with batch.local(1):
            pass


def test_without_dask_the_message_names_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, 'distributed', None)
    with pytest.raises(ConfigError, match='--scheduler needs Dask: install the package python3-distributed'):
        with batch.remote('tcp://127.0.0.1:1'):
            pass


@pytest.mark.parametrize('address, message', [
    ('tcp://127.0.0.1:1', 'no Dask scheduler answers there'),
    ('here', 'must be the address of a Dask scheduler, as in tcp://10.0.0.1:8786')])
def test_a_scheduler_that_does_not_answer_is_refused(monkeypatch, address, message):
    pytest.importorskip('distributed', reason='Dask is optional: the package python3-distributed')
    monkeypatch.setattr(batch, 'SCHEDULER_TIMEOUT', 0.5)
    with pytest.raises(ConfigError, match=f'--scheduler {address}: {message}'):
        with batch.remote(address):
            pass
