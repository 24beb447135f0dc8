"""The private channel of an examination: the simulator tells one judge what happens, and no node can listen or forge.

It is a Unix domain socket in a folder of the user's temporary folder (TMPDIR) that nobody else may open. Both ends find
it by the port of the master. One process alone may connect: the judge is told if another one tries, or has come first.
"""

import contextlib
import json
import os
import socket
import stat
import struct
import tempfile
import threading
import time
import urllib.parse
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional

import rosgraph
import rospy

from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.participants.examiner_frames import (
    ANSWER, COMMAND, HELLO, INTRUDER, MESSAGE, Frame, frames, packed, serialised)

MOST_WAITING = 20_000  # frames that are kept for a judge who has not come
PATIENCE = 10  # [s] of the wall clock: a judge that reads nothing for so long is told no more
PERIOD = 0.02  # [s] of the wall clock between two tries to connect
REFUSED = 'a second process has connected to the private channel of the simulator'


def socket_path() -> str:
    """Path of the socket for this process's master, in a folder that this makes if there is none.

    Raises:
        WorldError: others could open the folder.
    """
    folder = os.path.join(tempfile.gettempdir(), f'rumba_examiner_{os.getuid()}')
    with contextlib.suppress(FileExistsError):
        os.mkdir(folder, 0o700)
    status = os.lstat(folder)
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid() or status.st_mode & 0o077:
        raise WorldError(f'{folder}: must be your own folder, closed to others: remove it')
    return os.path.join(folder, str(urllib.parse.urlsplit(rosgraph.get_master_uri()).port))


class ExaminerServer:
    """The simulator's end. The world waits for a judge that reads slowly, but goes on without one."""

    def __init__(self, path: str) -> None:
        """Take the path of a socket; nobody can connect yet.

        Raises:
            WorldError: another process listens there, or the path cannot be used.
        """
        self._path = path
        self._lock = threading.Lock()  # held while a frame is sent
        self._topics: Dict[str, str] = {}  # types
        self._waiting: Optional[List[bytes]] = []  # what the judge will be told; None after it came, or too late
        self._judge: Optional[socket.socket] = None
        self._listener = _bound(path)

    def declare(self, topic: str, kind: Any) -> None:
        """There will be messages of a type on a topic, given by its full name."""
        self._topics[topic] = kind._type

    def open(self, is_lockstep: bool, on_answer: Callable[[Any], None]) -> None:
        """Let the judge connect until this node ends, and have its answers taken in a thread."""
        rospy.on_shutdown(self.close)
        hello = {'node': rospy.get_name(), 'is_lockstep': is_lockstep, 'topics': self._topics}
        self._listener.listen()
        threading.Thread(target=self._accept, args=(json.dumps(hello), on_answer), daemon=True).start()

    def tell(self, topic: str, message: Any, stamp: rospy.Time) -> None:
        """Tell a message of a declared topic, also one of type AnyMsg."""
        self._send(Frame(MESSAGE, serialised(message), topic, self._topics[topic], rospy.get_name(), stamp.secs,
                         stamp.nsecs))

    def tell_command(self, topic: str, message: Any, stamp: rospy.Time, sender: str) -> None:
        """Tell a velocity that a node has sent."""
        self._send(Frame(COMMAND, serialised(message), topic, message._type, sender, stamp.secs, stamp.nsecs))

    def _send(self, frame: Frame) -> None:
        with self._lock:
            if self._judge is not None:
                self._send_now(packed(frame))
            elif self._waiting is not None:
                self._waiting.append(packed(frame))
                if len(self._waiting) > MOST_WAITING:
                    rospy.logwarn('examination: no judge has come: the world goes on without one')
                    self._waiting = None
                    self._stop_listening()

    def _send_now(self, content: bytes) -> None:
        assert self._judge is not None
        try:
            self._judge.sendall(content)
        except OSError:  # it has ended, or does not read
            _end(self._judge)
            self._judge = None

    def _accept(self, hello: str, on_answer: Callable[[Any], None]) -> None:
        while True:
            try:
                connection, _ = self._listener.accept()
            except OSError:  # closed
                return
            with self._lock:
                is_judge, waiting, self._waiting = self._waiting is not None, self._waiting, None
                if is_judge:
                    seconds = struct.pack('ll', PATIENCE, 0)
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, seconds)
                    self._judge = connection
                    self._send_now(b''.join([packed(Frame(HELLO, hello.encode())), *(waiting or [])]))
            if is_judge:
                threading.Thread(target=_take_answers, args=(connection, on_answer), daemon=True).start()
            else:
                rospy.logerr(f'examination: {REFUSED}, and is refused')
                self._send(Frame(INTRUDER))  # before the intruder can do anything else
                with contextlib.suppress(OSError), connection:
                    connection.sendall(packed(Frame(INTRUDER)))

    def close(self) -> None:
        """Tell nobody anything any more."""
        self._stop_listening()
        if self._judge is not None:
            _end(self._judge)

    def _stop_listening(self) -> None:
        with contextlib.suppress(OSError):
            os.unlink(self._path)
        _end(self._listener)


@contextlib.contextmanager
def _short(path: str) -> Iterator[str]:
    """Another name of a path: sockets cannot have a name of more than 107 bytes (unix(7))."""
    folder, name = os.path.split(path)
    number = os.open(folder, os.O_PATH)
    try:
        yield f'/proc/self/fd/{number}/{name}'
    finally:
        os.close(number)


def _bound(path: str) -> socket.socket:
    """A socket at a path; one that a simulator has left which was killed is taken away."""
    with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        with _short(path) as short:
            probe.connect(short)
        raise WorldError(f'{path}: another process listens there: end it')
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path)
        with _short(path) as short:
            listener.bind(short)
    except OSError as error:
        listener.close()
        raise WorldError(f'{path}: {error.strerror}') from error
    return listener


def _end(connection: socket.socket) -> None:
    """Close a socket, and wake the thread that waits for it."""
    with contextlib.suppress(OSError):
        connection.shutdown(socket.SHUT_RDWR)
    connection.close()


def _take_answers(connection: socket.socket, on_answer: Callable[[Any], None]) -> None:
    with contextlib.suppress(OSError):
        for frame in frames(connection.makefile('rb')):
            on_answer(frame.message())


class Hello(NamedTuple):
    """What a simulator says first."""

    node: str  # its full name
    is_lockstep: bool
    topics: Mapping[str, str]  # types of the topics of which it tells


class ExaminerClient:
    """The judge's end; only `answer` and `close` may be called in another thread than the others."""

    def __init__(self) -> None:
        """Do not connect yet."""
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._lock = threading.Lock()
        self._frames: Iterator[Frame] = iter(())

    def connect(self, path: str, patience: float) -> Hello:
        """Wait for a simulator.

        Args:
            path: of its socket.
            patience: how long to wait [s] of the wall clock.

        Raises:
            WorldError: none has come, or another process is connected to it.
        """
        end = time.monotonic() + patience
        while not self._has_connected(path):
            if time.monotonic() > end or rospy.is_shutdown():
                raise WorldError(f'no simulator in an examination listens at {path}: start one with exam:=true')
            time.sleep(PERIOD)
        self._frames = frames(self._socket.makefile('rb'))
        first = next(self._frames, Frame(INTRUDER))
        if first.kind != HELLO:
            raise WorldError(REFUSED)
        return Hello(**json.loads(first.content.decode()))

    def _has_connected(self, path: str) -> bool:
        with _short(path) as short:
            return self._socket.connect_ex(short) == 0

    def frames(self) -> Iterator[Frame]:
        """What the simulator tells, until it ends."""
        with contextlib.suppress(OSError):
            yield from self._frames

    def answer(self, message: Any) -> None:
        """Answer the simulator, unless it has ended."""
        with self._lock, contextlib.suppress(OSError):
            self._socket.sendall(packed(Frame(ANSWER, serialised(message), type=message._type)))

    def close(self) -> None:
        """Listen no longer."""
        _end(self._socket)
