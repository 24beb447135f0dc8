"""Services that clients serve: threads of rospy wait for the answers, the thread of the loop talks to the clients."""

import concurrent.futures
import itertools
import threading
from typing import Any, Callable, Dict, Optional

import rospy

from rumba_sim.model.common.errors import one_line, quoted
from rumba_sim.ros.running import peers
from rumba_viewer.page.messages.conversion import to_json
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.filling import Filler, serialised
from rumba_viewer.page.messages.operations import can_be_repeated
from rumba_viewer.ros.page.rosapi import types

MOST_PENDING = 20  # requests of a service that wait for its client
LONGEST = 60.0  # [s] for an answer of a client
PATIENCE = 5.0  # [s] for which a call waits for a service that is about to be served


class Served:
    """A service of a client.

    Attributes:
        pending: requests that wait for an answer, by id.
        is_settled: set as soon as ROS knows the service, or cannot know it.
        is_private: whether only clients of this page can call it, since its type is not installed.
        server: of rospy; None if there is none.
    """

    def __init__(self, client: Any, service: str, ask: Callable[[str, Any], None]) -> None:
        """Serve a service by asking a client."""
        self.client, self.service, self.ask = client, service, ask
        self.pending: Dict[str, 'concurrent.futures.Future[Any]'] = {}
        self.is_settled = threading.Event()
        self.is_closed = self.is_private = False
        self.server: Any = None


class Serving:
    """Serves for clients. Its methods are called in the thread of the loop, and do not block, unless they say so."""

    def __init__(self, filler: Filler, later: Callable[..., Any]) -> None:
        """Fill answers by `filler`; call functions in the loop `later`, after a time [s]."""
        self._filler, self._later = filler, later
        self._served: Dict[str, Served] = {}
        self._numbers = itertools.count(1)
        self._executor = concurrent.futures.ThreadPoolExecutor(1)  # for what waits for the master

    def serve(self, client: Any, service: str, kind: str, ask: Callable[[str, Any], None],
              tell: Callable[[str, str], None]) -> None:
        """Serve a service on behalf of a client; a client that serves it already begins anew.

        Raises:
            Refusal: another client serves it.
        """
        before = self._served.get(service)
        if before is not None and before.client is not client:
            raise Refusal(f'{service} is served by another client already')
        self.unserve(client, service)
        served = self._served[service] = Served(client, service, ask)

        def on_registered(future: Any) -> None:
            error = future.exception()
            if error is not None:
                line = str(error) if isinstance(error, Refusal) else one_line(f'{service} cannot be served: {error}')
                self._later(0.0, lambda: self._fail(served, tell, line))
            elif served.is_private:
                self._later(0.0, lambda: tell('warning', f'{service}: the type {kind} is not installed here, so only '
                                                         'clients of this page can call it'))
            served.is_settled.set()
        self._submit(self._register, served, kind).add_done_callback(on_registered)

    def unserve(self, client: Any, service: str) -> None:
        """A client no longer serves a service."""
        served = self._served.get(service)
        if served is None or served.client is not client:
            return
        del self._served[service]
        served.is_closed = True
        for waiting in served.pending.values():
            waiting.set_exception(Refusal(f'{service}: the client that served it has gone'))
        served.pending.clear()
        self._submit(self._take_back, served)

    def answer(self, client: Any, service: str, request: Any, worked: bool, values: Any) -> None:
        """Answer a request.

        Raises:
            Refusal: nobody waits for this answer, or it does not fit; then whoever called gets to know it, too.
        """
        served = self._served.get(service)
        waiting = None
        if served is not None and served.client is client:
            waiting = served.pending.pop(request, None)
        if served is None or waiting is None:
            raise Refusal(f'{service}: no request with this id waits for an answer')
        try:
            if not worked:
                raise Refusal(f'{service}: ' + one_line(values if isinstance(values, str) and values else
                                                        'the client that serves it says that it failed'))
            response = self._response(served, values)
        except Refusal as refusal:
            waiting.set_exception(refusal)
            if worked:
                raise
        else:
            waiting.set_result(response)

    def _response(self, served: Served, values: Any) -> Any:
        """A response, complete, or as the client gave it if the type of the service is not installed."""
        if served.is_private:
            return _checked('values', values)
        response = self._filler.fill_any(served.server.response_class(), values)
        serialised(response)
        return response

    def private(self, service: str) -> Optional[Served]:
        """The service of a client that ROS does not know; None if it is another one; in any thread.

        This waits for a service that a client has just begun to serve.
        """
        served = self._served.get(service)
        if served is None or not served.is_settled.wait(PATIENCE):
            return None
        return served if served.is_private else None

    def call(self, served: Served, values: Any) -> Any:
        """Call a service that ROS does not know, for another client; blocks until there is an answer.

        Raises:
            Refusal: it does not work.
        """
        return self._fetch(served, _checked('args', values))

    def close(self) -> None:
        """Begin nothing more."""
        self._executor.shutdown(wait=False)

    def _submit(self, act: Callable[..., Any], *arguments: Any) -> 'concurrent.futures.Future[Any]':
        try:
            return self._executor.submit(act, *arguments)
        except RuntimeError:  # closed
            return concurrent.futures.Future()

    def _register(self, served: Served, kind: str) -> None:
        found = types.of_service(kind)
        if peers.is_served(served.service):
            raise Refusal(f'{served.service} is served by another node already')
        served.is_private = found is None
        if found is not None and not served.is_closed:
            served.server = rospy.Service(served.service, found, lambda request: self._handle(served, request))

    def _fail(self, served: Served, tell: Callable[[str, str], None], line: str) -> None:
        if not served.is_closed:
            self.unserve(served.client, served.service)
            tell('error', line)

    @staticmethod
    def _take_back(served: Served) -> None:
        if served.server is not None:
            served.server.shutdown('the client no longer serves it')

    def _handle(self, served: Served, request: Any) -> Any:
        """The response to a request of ROS; called in a thread of rospy for each."""
        try:
            return self._fetch(served, to_json(request))
        except Refusal as refusal:
            raise rospy.ServiceException(str(refusal)) from None

    def _fetch(self, served: Served, values: Any) -> Any:
        """The response to a request; blocks until the client has given it."""
        waiting: 'concurrent.futures.Future[Any]' = concurrent.futures.Future()
        number = f'service_request:{served.service}:{next(self._numbers)}'
        self._later(0.0, lambda: self._begin(served, number, values, waiting))
        try:
            return waiting.result(LONGEST)
        except concurrent.futures.TimeoutError:
            self._later(0.0, lambda: served.pending.pop(number, None))
            raise Refusal(f'{served.service}: the client has not answered within {LONGEST:g} s') from None

    @staticmethod
    def _begin(served: Served, number: str, values: Any, waiting: 'concurrent.futures.Future[Any]') -> None:
        if served.is_closed:
            waiting.set_exception(Refusal(f'{served.service}: the client that served it has gone'))
        elif len(served.pending) >= MOST_PENDING:
            waiting.set_exception(Refusal(f'{served.service}: {MOST_PENDING} requests wait for its client already'))
        else:
            served.pending[number] = waiting
            served.ask(number, values)


def _checked(key: str, values: Any) -> Any:
    """Values for a service whose type is not known."""
    if not isinstance(values or {}, dict) or not can_be_repeated(values):
        raise Refusal(f'{key} is {quoted(values)}: must be an object of finite numbers, not nested deeply')
    return values or {}
