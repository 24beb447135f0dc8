"""Requests of callbacks to the loop that owns the world: callbacks queue them, the loop carries them out."""

import concurrent.futures
import queue
import threading
import time
from typing import Any, Callable, Optional, Tuple

import rospy

Answer = Optional['concurrent.futures.Future[Any]']  # None if nobody waits for it


class Requests:
    """A queue of calls from any thread, made one by one in the thread that created this object."""

    def __init__(self) -> None:
        """Make the current thread the owner."""
        self._owner = threading.current_thread()
        # Not a SimpleQueue: if the handler of a signal takes longer than the timeout, its get() waits forever.
        self._queue: 'queue.Queue[Tuple[Callable[[], Any], Answer]]' = queue.Queue()

    def call(self, function: Callable[[], Any]) -> Any:
        """Have the owner call a function; returns its result, or raises its exception.

        Raises:
            rospy.ROSInterruptException: the node ends before the owner has called the function.
        """
        if threading.current_thread() is self._owner:
            return function()
        answer: 'concurrent.futures.Future[Any]' = concurrent.futures.Future()
        self._queue.put((function, answer))
        while not rospy.is_shutdown():
            try:
                return answer.result(timeout=0.5)
            except concurrent.futures.TimeoutError:
                continue
        raise rospy.ROSInterruptException('the node ends')

    def post(self, function: Callable[[], Any]) -> None:
        """Have the owner call a function, without waiting for it: `serve` raises its exception."""
        self._queue.put((function, None))

    def serve(self, until: float, is_enough: Callable[[], bool] = lambda: False) -> None:
        """Make the calls that are in the queue, and those that arrive until a time of `time.monotonic`.

        Args:
            until: that time.
            is_enough: asked after each call; if true, the next ones wait for the next time.

        Raises:
            Exception: a function raised it that was posted; the owner ends then, since nobody else would notice.
        """
        while True:
            request = self._next(until - time.monotonic())
            if request is None:
                return
            function, answer = request
            if answer is None:
                function()
            else:
                _answer(answer, function)
            if is_enough():
                return

    def _next(self, seconds: float) -> Optional[Tuple[Callable[[], Any], Answer]]:
        if seconds <= 0.0 and self._queue.empty():  # the usual case, which need not cost an exception
            return None
        try:
            return self._queue.get(timeout=seconds) if seconds > 0.0 else self._queue.get_nowait()
        except queue.Empty:
            return None


def _answer(answer: 'concurrent.futures.Future[Any]', function: Callable[[], Any]) -> None:
    try:
        answer.set_result(function())
    except Exception as error:  # passed on to the caller
        answer.set_exception(error)
