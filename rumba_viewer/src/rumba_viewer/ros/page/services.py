"""Calls services in threads, so that the page waits for none of them."""

import concurrent.futures
import time
from typing import Any, Callable, Dict, List

import rospy
import rosservice

from rumba_sim.model.common.errors import one_line
from rumba_viewer.page.messages.conversion import to_json
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.filling import Filler, serialised
from rumba_viewer.page.protocol import API
from rumba_viewer.page.ros import Done
from rumba_viewer.ros.page.rosapi.api import Api
from rumba_viewer.ros.page.serving import Serving

THREADS = 64  # calls at the same time; a service that does not answer keeps one
MOST = 20  # calls of one client that wait for an answer


class Call:
    """A call that a client has made: the service, its values, and what gets the answer."""

    def __init__(self, service: str, values: Any, done: Done) -> None:
        """Call a service with these values."""
        self.service, self.values, self.done = service, values, done


class Services:
    """Calls services. Its methods are called in the thread of the loop, and never block."""

    def __init__(self, api: Api, serving: Serving, filler: Filler, later: Callable[..., Any]) -> None:
        """Fill requests by `filler`; call functions in the loop `later`, after a time [s]."""
        self._api, self._serving, self._filler, self._later = api, serving, filler, later
        self._executor = concurrent.futures.ThreadPoolExecutor(THREADS)
        self._calls: Dict[Any, List[Call]] = {}  # by client, in their order; the first is under way

    def call(self, client: Any, service: str, values: Any, done: Done, timeout: float) -> None:
        """Call a service after the earlier calls of this client; `done` gets the answer, in the thread of the loop.

        Args:
            client: who calls.
            service: what is called.
            values: of the request.
            done: gets the answer.
            timeout: [s] after which `done` gets to know that there was none; 0: however long it takes.

        Raises:
            Refusal: too many calls wait already.
        """
        calls = self._calls.setdefault(client, [])
        if len(calls) >= MOST:
            raise Refusal(f'{service}: {MOST} calls of this client wait for an answer already')
        call = Call(service, values, done)
        calls.append(call)
        if len(calls) == 1:
            self._begin(client)
        if timeout:
            line = f'{service}: no answer within {timeout:g} s'
            self._later(timeout, lambda: self._end(client, call, False, line))

    def close(self) -> None:
        """Begin nothing more."""
        self._calls.clear()
        self._executor.shutdown(wait=False)

    def _begin(self, client: Any) -> None:
        call = self._calls[client][0]

        def on_answer(future: Any) -> None:
            error = future.exception()
            answer = (True, future.result()) if error is None else (False, _reason(call.service, error))
            self._later(0.0, lambda: self._end(client, call, *answer))
        self._executor.submit(self._ask, client, call.service, call.values).add_done_callback(on_answer)

    def _end(self, client: Any, call: Call, worked: bool, values: Any) -> None:
        calls = self._calls.get(client, [])
        if call not in calls:
            return  # it has ended already, or the node ends
        was_first = calls[0] is call
        calls.remove(call)
        if not calls:
            del self._calls[client]
        elif was_first:
            self._begin(client)
        begin = time.thread_time()
        call.done(worked, values)
        client.charge(time.thread_time() - begin)

    def _ask(self, client: Any, service: str, values: Any) -> Any:
        """Call a service; its client pays for the CPU time of this thread, which the others miss."""
        begin = time.thread_time()
        try:
            return self._answer(service, values)
        finally:
            seconds = time.thread_time() - begin
            self._later(0.0, lambda: client.charge(seconds))

    def _answer(self, service: str, values: Any) -> Any:
        if service.startswith(API):
            return self._api.answer(service[len(API):], values)
        private = self._serving.private(service)
        if private is not None:
            return self._serving.call(private, values)
        kind = rosservice.get_service_class_by_name(service)
        request = self._filler.fill_any(kind._request_class(), values)
        serialised(request)
        return to_json(rospy.ServiceProxy(service, kind)(request))


def _reason(service: str, error: BaseException) -> str:
    if isinstance(error, (Refusal, rospy.ServiceException, rosservice.ROSServiceException)):
        return one_line(f'{service}: {error}')
    return one_line(f'{service}: {type(error).__name__}: {error}')
