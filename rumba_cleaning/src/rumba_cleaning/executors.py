"""Executors for long computations that run at a moment that the caller knows, so that runs can be repeated."""

from concurrent.futures import Executor, Future
from typing import Any, Callable, List, Tuple, TypeVar

Result = TypeVar('Result')


class InPlace(Executor):
    """Runs what is submitted at once, in the thread of the caller: its futures are done when they are returned."""

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> 'Future[Result]':
        """Run a function; if it raises an exception, the future holds that."""
        future: 'Future[Result]' = Future()
        _fulfil(future, lambda: fn(*args, **kwargs))
        return future


class BeforeNextStep(Executor):
    """Runs what is submitted when it is told to: before the next step, as the node `cleaner` does in lockstep."""

    def __init__(self) -> None:
        """Nothing is submitted."""
        self._tasks: 'List[Tuple[Future[Any], Callable[[], Any]]]' = []

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> 'Future[Result]':
        """Keep a function; returns its future, which can be cancelled until it runs."""
        future: 'Future[Result]' = Future()
        self._tasks.append((future, lambda: fn(*args, **kwargs)))
        return future

    def work(self) -> None:
        """Run what is kept."""
        tasks, self._tasks = self._tasks, []
        for future, call in tasks:
            if future.set_running_or_notify_cancel():
                _fulfil(future, call)


def _fulfil(future: 'Future[Result]', call: Callable[[], Result]) -> None:
    try:
        future.set_result(call())
    except Exception as error:
        future.set_exception(error)
