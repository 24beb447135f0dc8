"""The server side of the wire: what nodes that subscribe connect to."""

import contextlib
import itertools
import queue
import socket
import socketserver
import threading
import time
import xmlrpc.server

from stress import wire


class _Handler(xmlrpc.server.SimpleXMLRPCRequestHandler):
    rpc_paths = ()  # any


class _ThreadingServer(socketserver.ThreadingMixIn, xmlrpc.server.SimpleXMLRPCServer):
    daemon_threads = True

    def handle_error(self, request, client_address):
        """A caller that was killed while it asked is none of our troubles."""


class Publishers:
    """The server side of `/stress`: nodes that subscribe to its topics connect to it, and get what it is told to send.

    One for the whole process; it publishes one topic at a time, for as long as a block. Each time it is another
    publisher: a node that has not yet noticed the end of its last connection would not connect to the same one again.
    """

    def __init__(self):
        """Open both servers."""
        self._came = {}  # queues of connections, by topic
        self._listener = socket.create_server((wire.HOST, 0), backlog=64)
        self._api = _ThreadingServer((wire.HOST, 0), _Handler, logRequests=False, allow_none=True)
        self._api.register_function(self._request_topic, 'requestTopic')
        for name in ('publisherUpdate', 'paramUpdate', 'getPid', 'getBusInfo', 'shutdown'):
            self._api.register_function(lambda *_: (1, '', 0), name)
        self._uris = (f'http://{wire.HOST}:{self._api.server_address[1]}/{number}/' for number in itertools.count())
        for work in (self._api.serve_forever, self._accept):
            threading.Thread(target=work, daemon=True).start()

    def _request_topic(self, _caller, topic, _protocols):
        if topic not in self._came:
            return 0, 'not published', 0
        return 1, '', ['TCPROS', wire.HOST, self._listener.getsockname()[1]]

    def _accept(self):
        while True:
            connection, _ = self._listener.accept()
            threading.Thread(target=self._greet, args=[connection], daemon=True).start()

    def _greet(self, connection):
        """Sort a connection by its topic; the block sends the header of the answer."""
        connection.settimeout(wire.PATIENCE)
        try:
            fields = wire.read_header(connection)
            self._came[fields['topic']].put((fields.get('callerid', ''), connection))
        except (wire.WireError, KeyError):
            connection.close()

    @contextlib.contextmanager
    def publish(self, master_uri, topic, kind, at_least=1, patience=wire.PATIENCE, wanted=None):
        """Register as a publisher; yields a list of pairs of a subscriber's name and a socket.

        Args:
            master_uri: where the master is.
            topic: full name.
            kind: class of the messages, or what subscribers are to be told that it is.
            at_least: how many subscribers to wait for.
            patience: how long [s]; fewer may have come then.
            wanted: name of a subscriber to wait for, too.
        """
        came = self._came[topic] = queue.Queue()
        connections, uri = [], next(self._uris)
        try:
            wire.ask(master_uri, 'registerPublisher', topic, kind._type, uri)
            end = time.monotonic() + patience
            while len(connections) < at_least or wanted and wanted not in dict(connections):
                try:
                    connections.append(came.get(timeout=max(end - time.monotonic(), 0.01)))
                except queue.Empty:
                    break
            yield connections
        finally:
            with contextlib.suppress(wire.WireError):
                wire.ask(master_uri, 'unregisterPublisher', topic, uri)
            del self._came[topic]
            while not came.empty():
                connections.append(came.get())
            for _, connection in connections:
                connection.close()
