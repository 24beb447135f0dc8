"""ROS 1 on the wire, without rospy: what rospy refuses to send is what nodes must be tried with."""

import http.client
import io
import socket
import struct
import xmlrpc.client

CALLER = '/stress'
HOST = '127.0.0.1'
PATIENCE = 20.0  # [s] for an answer that should take milliseconds
LARGEST = 64 * 2 ** 20  # [bytes] of a message that is believed


class WireError(Exception):
    """Nobody answers, or what answers is no ROS."""


# --- XMLRPC -----------------------------------------------------------------------------------------------------------

class _Hasty(xmlrpc.client.Transport):
    """Gives up if there is no answer."""

    def __init__(self, timeout):
        super().__init__()
        self._timeout = timeout

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = self._timeout
        return connection


def ask(uri, method, *arguments, timeout=PATIENCE):
    """Call a method of the API of a master or a node, as `/stress`; returns the value of its answer.

    Raises:
        WireError: there is no answer, or it is no success.
    """
    transport = _Hasty(timeout)
    try:
        code, message, value = getattr(xmlrpc.client.ServerProxy(uri, transport), method)(CALLER, *arguments)
    except (OSError, xmlrpc.client.Error, http.client.HTTPException, ValueError, TypeError) as error:
        raise WireError(f'{method} of {uri}: {type(error).__name__}: {error}') from error
    finally:
        transport.close()
    if code != 1:
        raise WireError(f'{method} of {uri}: {message}')
    return value


def address(uri):
    """Host and port of a URI such as `http://localhost:11311/`."""
    host, _, port = uri.partition('://')[2].strip('/').rpartition(':')
    return host, int(port)


# --- TCPROS -----------------------------------------------------------------------------------------------------------

def frame(data):
    """Bytes with their length before them."""
    return struct.pack('<I', len(data)) + data


def header(**fields):
    """The first thing that each side of a connection sends; values are text or bytes."""
    encoded = (key.encode() + b'=' + (value if isinstance(value, bytes) else value.encode())
               for key, value in fields.items())
    return frame(b''.join(map(frame, encoded)))


def serialized(message):
    """A message or a request as bytes."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def connect(host, port, timeout=PATIENCE):
    """A connected socket.

    Raises:
        WireError: nobody accepts.
    """
    try:
        connection = socket.create_connection((host, port), timeout)
    except OSError as error:
        raise WireError(f'no connection to {host}:{port}: {error}') from error
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def read_exactly(connection, size):
    """So many bytes.

    Raises:
        WireError: the connection ends before, or says nothing.
    """
    parts = []
    while size:
        try:
            part = connection.recv(min(size, 2 ** 20))
        except OSError as error:
            raise WireError(f'the connection says nothing: {error}') from error
        if not part:
            raise WireError('the connection was closed')
        parts.append(part)
        size -= len(part)
    return b''.join(parts)


def read_frame(connection):
    """Bytes that have their length before them.

    Raises:
        WireError: they do not come.
    """
    size, = struct.unpack('<I', read_exactly(connection, 4))
    if size > LARGEST:
        raise WireError(f'{size} bytes are announced')
    return read_exactly(connection, size)


def read_header(connection):
    """The fields of a header, by name.

    Raises:
        WireError: it does not come, or it refuses the connection.
    """
    data, fields = read_frame(connection), {}
    while data:
        size, = struct.unpack_from('<I', data)
        name, _, value = data[4:4 + size].decode(errors='replace').partition('=')
        fields[name] = value
        data = data[4 + size:]
    if 'error' in fields:
        raise WireError(fields['error'])
    return fields


class Subscription:
    """A connection to one publisher of a topic, of which the master knows nothing."""

    def __init__(self, node_uri, topic, kind, timeout=PATIENCE):
        """Connect to a publisher, given by the URI of its API; `kind` is the class of the messages.

        Raises:
            WireError: it does not answer, or does not publish that.
        """
        self._kind = kind
        _, host, port = ask(node_uri, 'requestTopic', topic, [['TCPROS']], timeout=timeout)
        self.socket = connect(host, port, timeout)
        try:
            self.socket.sendall(header(callerid=CALLER, topic=topic, type=kind._type, md5sum=kind._md5sum))
            read_header(self.socket)
        except (WireError, OSError) as error:
            self.socket.close()
            raise WireError(f'{topic}: {error}') from error

    def next(self, timeout=PATIENCE):
        """The next message.

        Raises:
            WireError: none comes.
        """
        self.socket.settimeout(timeout)
        return self._kind().deserialize(read_frame(self.socket))

    def close(self):
        """Disconnect."""
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Service:
    """A lasting connection to a service."""

    def __init__(self, uri, name, kind, timeout=PATIENCE):
        """Connect to the service at a `rosrpc://` URI; `kind` is the class of the service.

        Raises:
            WireError: it does not accept.
        """
        self._kind = kind
        self.socket = connect(*address(uri), timeout)
        try:
            self.socket.sendall(header(callerid=CALLER, service=name, md5sum=kind._md5sum, persistent='1'))
            read_header(self.socket)
        except (WireError, OSError) as error:
            self.socket.close()
            raise WireError(f'{name}: {error}') from error

    def call(self, request, timeout=PATIENCE):
        """The response to a request.

        Raises:
            WireError: the service fails, or does not answer in time.
        """
        return self._kind._response_class().deserialize(self.call_with_bytes(serialized(request), timeout))

    def call_with_bytes(self, data, timeout=PATIENCE):
        """The bytes of the response to the bytes of a request.

        Raises:
            WireError: the service fails, or does not answer in time.
        """
        self.socket.settimeout(timeout)
        try:
            self.socket.sendall(frame(data))
        except OSError as error:
            raise WireError(f'the connection was closed: {error}') from error
        is_good = read_exactly(self.socket, 1) != b'\0'
        answer = read_frame(self.socket)
        if not is_good:
            raise WireError(f'the service answers with an error: {answer[:200].decode(errors="replace")}')
        return answer

    def close(self):
        """Disconnect."""
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def greeting(kind):
    """The header with which a publisher answers a subscriber."""
    return header(callerid=CALLER, type=kind._type, md5sum=kind._md5sum, latching='0')
