"""Runs functions beside the loop of a node, in threads that do not keep the process alive."""

import concurrent.futures
import functools
import queue
import threading
import time
from typing import Any, Callable, List, NamedTuple, Tuple, TypeVar

from rumba_sim.ros.participants.lockstep import LONGEST

Result = TypeVar('Result')
Task = Tuple['concurrent.futures.Future[Any]', Callable[[], Any]]


class DaemonExecutor(concurrent.futures.Executor):
    """An executor with daemon threads.

    Unlike a ThreadPoolExecutor, it does not delay the end of the process until functions that run have returned. It
    starts a thread only if all others are at work: for each thread the C library keeps memory that was used there once.
    """

    def __init__(self, threads: int) -> None:
        """Use so many threads at most."""
        self._tasks: 'queue.Queue[Task]' = queue.Queue()
        self._most = threads
        self._lock = threading.Lock()
        self._started = 0  # threads; guarded by the lock, as the next one
        self._open = 0  # tasks that wait or run

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> 'concurrent.futures.Future[Result]':
        """Run a function as soon as a thread is free; returns its future, which can be cancelled until then."""
        future: 'concurrent.futures.Future[Result]' = concurrent.futures.Future()
        with self._lock:
            self._open += 1
            is_needed = self._started < min(self._open, self._most)
            self._started += int(is_needed)
        self._tasks.put((future, lambda: fn(*args, **kwargs)))
        if is_needed:
            threading.Thread(target=self._serve, daemon=True).start()
        return future

    def _serve(self) -> None:
        while True:
            future, call = self._tasks.get()
            if future.set_running_or_notify_cancel():
                _run(future, functools.partial(self._do, call))
            else:
                self._close()
            del future, call  # else their memory is kept until the next task

    def _do(self, call: Callable[[], Any]) -> Any:
        try:
            return call()
        finally:
            self._close()  # before the future is done: who waits for it may submit the next task at once

    def _close(self) -> None:
        with self._lock:
            self._open -= 1


class Awaited(NamedTuple):
    """A function for which a world in lockstep waits."""

    inner: 'concurrent.futures.Future[Any]'  # done as soon as it has returned
    outer: 'concurrent.futures.Future[Any]'  # what the behaviour has got: done before its next step, never during one
    end: float  # time of `time.monotonic` until which the world waits

    @property
    def is_at_work(self) -> bool:
        """Whether the world waits for it now."""
        return not self.inner.done() and not self.outer.cancelled() and time.monotonic() < self.end


class Planners(concurrent.futures.Executor):
    """Runs functions beside the loop. In lockstep the world waits for them, so that a plan always takes one step."""

    def __init__(self, beside: concurrent.futures.Executor, is_lockstep: Callable[[], bool],
                 on_done: Callable[[], None]) -> None:
        """Use an executor; `on_done` is called in its threads when a function that is waited for has returned."""
        self._beside = beside
        self._is_lockstep = is_lockstep
        self._on_done = on_done
        self._awaited: List[Awaited] = []

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> 'concurrent.futures.Future[Result]':
        """Run a function; returns its future."""
        inner = self._beside.submit(fn, *args, **kwargs)
        if not self._is_lockstep():
            return inner
        outer: 'concurrent.futures.Future[Result]' = concurrent.futures.Future()
        self._awaited.append(Awaited(inner, outer, time.monotonic() + LONGEST))
        inner.add_done_callback(lambda _: self._on_done())
        return outer

    @property
    def are_at_work(self) -> bool:
        """Whether the world waits for a function; may be asked in any thread."""
        return any(each.is_at_work for each in self._awaited)

    def deliver(self) -> None:
        """Before a step: give the behaviours what has returned."""
        done = [each for each in self._awaited if each.inner.done() or each.outer.cancelled()]
        self._awaited = [each for each in self._awaited if each not in done]
        for each in done:
            if each.outer.set_running_or_notify_cancel():
                _run(each.outer, each.inner.result)

    def forget(self) -> bool:
        """Wait for nothing that was submitted before; returns whether it was waited for."""
        were_at_work, self._awaited = self.are_at_work, []
        return were_at_work


def _run(future: 'concurrent.futures.Future[Any]', call: Callable[[], Any]) -> None:
    try:
        result = call()
    except BaseException as error:  # the caller of future.result() gets it
        future.set_exception(error)
    else:
        future.set_result(result)
