"""Calls from callbacks to the loop that owns the field: callbacks queue them, the loop makes them."""

import concurrent.futures
import queue
import threading
import time
from typing import Any, Callable, Tuple

import rospy


class Requests:
    """A queue of calls from any thread; the thread that created this object makes them one by one."""

    def __init__(self) -> None:
        """Make the calling thread the owner."""
        self._owner = threading.current_thread()
        # Not a SimpleQueue: a signal whose handler takes longer than the timeout makes its get() wait forever.
        self._queue: 'queue.Queue[Tuple[Callable[[], Any], concurrent.futures.Future[Any]]]' = queue.Queue()

    def call(self, function: Callable[[], Any]) -> Any:
        """Have the owner call a function; return its result, or raise its exception.

        Raises:
            rospy.ROSInterruptException: the node ends before the owner makes the call.
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

    def serve(self, until: float) -> None:
        """Make the calls that are queued, and those that come before a time of `time.monotonic`."""
        while True:
            seconds = until - time.monotonic()
            try:
                function, answer = self._queue.get(seconds > 0.0, max(0.0, seconds))
            except queue.Empty:
                return
            try:
                answer.set_result(function())
            except Exception as error:  # raised in the thread that asked
                answer.set_exception(error)
