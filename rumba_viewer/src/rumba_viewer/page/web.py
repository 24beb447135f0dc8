"""What the web server answers to requests: the files of the page, and nothing that has a body."""

from typing import Any, Optional

from tornado.httputil import HTTPHeaders, HTTPMessageDelegate, ResponseStartLine
from tornado.web import Application, HTTPError, RequestHandler, StaticFileHandler

from rumba_viewer.page.allow_list import host_name, is_loopback
from rumba_viewer.page.client import Client

HEADERS = {
    'Content-Security-Policy': "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data:; "
                               "frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    'X-Content-Type-Options': 'nosniff', 'Referrer-Policy': 'no-referrer', 'Cache-Control': 'no-cache'}
NO_BODY = b'The page takes no requests with a body.\n'


class Root(Client):
    """A websocket if the client asks for one, else the page."""

    async def get(self, *args: Any, **kwargs: Any) -> None:
        """Answer."""
        if self.request.headers.get('Upgrade', '').lower() == 'websocket':
            await super().get(*args, **kwargs)
        else:
            for name, value in HEADERS.items():
                self.set_header(name, value)
            self.set_header('Content-Type', 'text/html; charset=utf-8')
            self.finish((self.application.settings['folder'] / 'index.html').read_bytes())


class Files(StaticFileHandler):
    """The other files of the page."""

    def set_extra_headers(self, _: str) -> None:
        """Say what browsers may do with them."""
        for name, value in HEADERS.items():
            self.set_header(name, value)

    def should_return_304(self) -> bool:
        """Whether the client has the newest version; a date that no calendar knows is no reason to believe so."""
        try:
            return super().should_return_304()
        except (ValueError, OverflowError):
            return False


class Guarded(Application):
    """Answers only those who call this server by a name of its own, so that no other site can pose as it."""

    is_local = False

    def start_request(self, server_conn: object, request_conn: Any) -> HTTPMessageDelegate:
        """Begin to answer a request."""
        return _Bodiless(super().start_request(server_conn, request_conn), request_conn)

    def find_handler(self, request: Any, **kwargs: Any) -> Any:
        """What answers a request."""
        name, _ = host_name(request.headers.get('Host', ''))
        if self.is_local and not is_loopback(name):
            return self.get_handler_delegate(request, _Stranger)
        return super().find_handler(request, **kwargs)


class _Bodiless(HTTPMessageDelegate):
    """Refuses a request that announces a body before any of it is read, and ends the connection."""

    def __init__(self, inner: HTTPMessageDelegate, connection: Any) -> None:
        self._inner: Optional[HTTPMessageDelegate] = inner
        self._connection = connection

    def headers_received(self, start_line: Any, headers: HTTPHeaders) -> Any:
        if 'Transfer-Encoding' not in headers and headers.get('Content-Length', '0') == '0':
            return self._inner and self._inner.headers_received(start_line, headers)
        for name in ('Transfer-Encoding', 'Content-Length', 'Expect'):  # otherwise tornado would read the body
            headers.pop(name, None)
        self._inner = None
        self._connection.write_headers(
            ResponseStartLine('HTTP/1.1', 413, 'Payload Too Large'),
            HTTPHeaders({'Content-Type': 'text/plain', 'Content-Length': str(len(NO_BODY)), 'Connection': 'close'}),
            NO_BODY)
        self._connection.finish()
        return None

    def finish(self) -> None:
        if self._inner is not None:
            self._inner.finish()

    def on_connection_close(self) -> None:
        if self._inner is not None:
            self._inner.on_connection_close()


class _Stranger(RequestHandler):
    def prepare(self) -> None:
        raise HTTPError(403)

    def write_error(self, status_code: int, **_: Any) -> None:
        self.finish('This server answers at localhost only: start it with address:= and token:= for others.\n')
