"""The page while there is no master: it is served, says what it waits for, and nothing can be done with it."""

import asyncio
import socket
import sys
import threading
from typing import Any, Callable, List, Optional, Tuple

import rosgraph
from rospy.client import load_command_line_node_params
from tornado.ioloop import IOLoop

from rumba_sim.model.common import config
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.ros import Done, Ros
from rumba_viewer.page.server import serve, sockets
from rumba_viewer.ros.page.settings import Settings, folder, hub_of, tokens_of, url

RESTART = 1012  # code of a websocket: the server restarts, connect again


class Early:
    """Serves the page until there is a master, in a thread of its own."""

    def __init__(self) -> None:
        """Serve nothing yet."""
        self._loop: Optional[IOLoop] = None
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._at: Tuple[Any, ...] = ()
        self._sockets: List[socket.socket] = []

    def begin(self) -> None:
        """Serve with the parameters of the command line, if no master answers; return at once.

        Raises:
            ConfigError: it is not possible with these.
        """
        if rosgraph.is_master_online():
            return
        settings = config.updated(Settings(), load_command_line_node_params(sys.argv), 'command line')
        self._tokens = tokens_of(settings)
        self._hub = hub_of(settings, lambda *_: None, lambda line: print(f'page: {line}', file=sys.stderr))
        self._hub.ros = NoRos()
        self._at, self._sockets = (settings.address, settings.port), sockets(settings.address, settings.port)
        print(f'page: the page is at {url(settings, self._sockets)} already', file=sys.stderr, flush=True)
        self._thread.start()

    def _serve(self) -> None:
        asyncio.set_event_loop(asyncio.new_event_loop())
        self._loop = IOLoop.current()
        serve(self._hub, self._tokens, folder(), self._sockets)
        self._loop.start()

    def end(self, settings: Settings) -> List[socket.socket]:
        """Serve no longer; returns the sockets, if they are where the page is to be served."""
        if not self._sockets:
            return []
        loop: Any = self._loop
        loop.add_callback(lambda: self._leave(loop))
        self._thread.join()
        if self._at == (settings.address, settings.port):
            return self._sockets
        for one in self._sockets:
            one.close()
        return []

    def _leave(self, loop: IOLoop) -> None:
        """Ask all clients to connect again."""
        for client in self._hub.everybody():
            client.close(RESTART, 'ROS is there now: connect again')
        loop.add_callback(loop.stop)


class NoRos(Ros):
    """What sessions of clients ask of while there is no master."""

    def subscribe(self, client: Any, topic: str, reason: Any, demand: Demand) -> None:
        """Nothing comes yet."""

    def unsubscribe(self, client: Any, topic: str, reason: Any) -> None:
        """Nothing came."""

    def kind(self, topic: str) -> str:
        """It is not known yet."""
        return ''

    def advertise(self, client: Any, topic: str, kind: Optional[str], latch: bool) -> None:
        """Nothing can be published yet."""
        raise _trouble()

    def unadvertise(self, client: Any, topic: str) -> None:
        """Nothing was advertised."""

    def publish(self, client: Any, topic: str, values: Any) -> None:
        """Nothing can be published yet."""
        raise _trouble()

    def call(self, client: Any, service: str, values: Any, done: Done, timeout: float) -> None:
        """Nothing can be called yet."""
        raise _trouble()

    def serve(self, client: Any, service: str, kind: str, ask: Callable[[str, Any], None],
              tell: Callable[[str, str], None]) -> None:
        """Nothing can be served yet."""
        raise _trouble()

    def unserve(self, client: Any, service: str) -> None:
        """Nothing was served."""

    def answer(self, client: Any, service: str, request: Any, worked: bool, values: Any) -> None:
        """Nothing was asked."""

    def leave(self, client: Any) -> None:
        """Nothing is left of it."""


def _trouble() -> Refusal:
    return Refusal(f'no roscore answers at {rosgraph.get_master_uri()} yet')
