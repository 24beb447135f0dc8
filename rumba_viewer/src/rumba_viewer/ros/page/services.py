"""Calls services in threads, so that the page waits for none of them."""

import collections
import concurrent.futures
from typing import Any, Callable, Deque, Dict, NamedTuple

import rospy
import rosservice

from rumba_sim.model.errors import one_line
from rumba_viewer.page.conversion import to_json
from rumba_viewer.page.errors import Refusal
from rumba_viewer.page.filling import Filler
from rumba_viewer.page.protocol import API
from rumba_viewer.ros.page.graph import Graph

THREADS = 8
MOST = 20  # calls of one client that wait for an answer


class Call(NamedTuple):
    """A call that a client has made: the service, its values, and what gets the answer."""

    service: str
    values: Any
    done: Callable[[bool, Any], None]


class Services:
    """Calls services. Its methods are called in the thread of the loop, and never block."""

    def __init__(self, graph: Graph, filler: Filler, later: Callable[..., Any]) -> None:
        """Fill requests by `filler`; call functions in the loop `later`, after a time [s]."""
        self._graph, self._filler, self._later = graph, filler, later
        self._executor = concurrent.futures.ThreadPoolExecutor(THREADS)
        self._calls: Dict[Any, Deque[Call]] = {}  # by client, in their order; the first is under way

    def call(self, client: Any, service: str, values: Any, done: Callable[[bool, Any], None]) -> None:
        """Call a service after the earlier calls of this client; `done` gets the answer, in the thread of the loop.

        Raises:
            Refusal: too many calls wait already.
        """
        calls = self._calls.setdefault(client, collections.deque())
        if len(calls) >= MOST:
            raise Refusal(f'{service}: {MOST} calls of this client wait for an answer already')
        calls.append(Call(service, values, done))
        if len(calls) == 1:
            self._begin(client)

    def close(self) -> None:
        """Begin nothing more."""
        self._calls.clear()
        self._executor.shutdown(wait=False)

    def _begin(self, client: Any) -> None:
        service, values, _ = self._calls[client][0]

        def on_answer(future: Any) -> None:
            error = future.exception()
            answer = (True, future.result()) if error is None else (False, _reason(service, error))
            self._later(0.0, lambda: self._end(client, *answer))
        self._executor.submit(self._ask, service, values).add_done_callback(on_answer)

    def _end(self, client: Any, worked: bool, values: Any) -> None:
        calls = self._calls.get(client)
        if calls is None:
            return  # the node ends
        done = calls.popleft().done
        if calls:
            self._begin(client)
        else:
            del self._calls[client]
        done(worked, values)

    def _ask(self, service: str, values: Any) -> Any:
        if service.startswith(API):
            return self._graph.api(service[len(API):], values)
        kind = rosservice.get_service_class_by_name(service)
        request = kind._request_class()
        if isinstance(values, list):
            values = dict(zip(request.__slots__, values))  # in their order
        answer = rospy.ServiceProxy(service, kind)(self._filler.fill(request, values or {}))
        return to_json(answer)


def _reason(service: str, error: BaseException) -> str:
    if isinstance(error, (Refusal, rospy.ServiceException, rosservice.ROSServiceException)):
        return one_line(f'{service}: {error}')
    return one_line(f'{service}: {type(error).__name__}: {error}')
