"""Runs functions beside the loop of a node, in threads that do not keep the process alive."""

import concurrent.futures
import queue
import threading
from typing import Any, Callable, Tuple, TypeVar

from rumba_cleaning.belief.context import InPlace
from rumba_sim.ros.common.lockstep import Participant

Result = TypeVar('Result')
Task = Tuple['concurrent.futures.Future[Any]', Callable[[], Any]]


class DaemonExecutor(concurrent.futures.Executor):
    """An executor with daemon threads.

    Unlike a ThreadPoolExecutor, it does not delay the end of the process until functions that run have returned.
    """

    def __init__(self, threads: int) -> None:
        """Start so many threads."""
        self._tasks: 'queue.Queue[Task]' = queue.Queue()
        for _ in range(threads):
            threading.Thread(target=self._serve, daemon=True).start()

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> 'concurrent.futures.Future[Result]':
        """Run a function as soon as a thread is free; returns its future, which can be cancelled until then."""
        future: 'concurrent.futures.Future[Result]' = concurrent.futures.Future()
        self._tasks.put((future, lambda: fn(*args, **kwargs)))
        return future

    def _serve(self) -> None:
        while True:
            future, call = self._tasks.get()
            if future.set_running_or_notify_cancel():
                _run(future, call)
            del future, call  # else their memory is kept until the next task


class Planners(concurrent.futures.Executor):
    """Runs functions beside the loop, but in lockstep at once: the world waits, and the run can be repeated."""

    def __init__(self, beside: concurrent.futures.Executor, lockstep: Participant,
                 is_lockstep: Callable[[], bool]) -> None:
        """Use an executor, or say that this node is busy."""
        self._beside = beside
        self._lockstep = lockstep
        self._is_lockstep = is_lockstep

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> 'concurrent.futures.Future[Result]':
        """Run a function; returns its future."""
        if not self._is_lockstep():
            return self._beside.submit(fn, *args, **kwargs)
        with self._lockstep.busy():
            return InPlace().submit(fn, *args, **kwargs)


def _run(future: 'concurrent.futures.Future[Any]', call: Callable[[], Any]) -> None:
    try:
        result = call()
    except BaseException as error:  # the caller of future.result() gets it
        future.set_exception(error)
    else:
        future.set_result(result)
