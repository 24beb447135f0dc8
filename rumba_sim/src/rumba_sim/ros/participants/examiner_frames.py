"""What a simulator and a judge say to each other in an examination: frames, one after another in a stream of bytes."""

import io
import struct
from typing import Any, BinaryIO, Iterator, NamedTuple

import roslib.message

# Kind, stamp [s] and [ns], lengths of topic, type, sender and content; then come these.
HEAD = struct.Struct('<BIIHHHI')
HELLO, MESSAGE, COMMAND, ANSWER, INTRUDER = range(5)


class Frame(NamedTuple):
    """One thing that is said.

    HELLO is the first, and says in JSON which node speaks, whether in lockstep, and of which topics. MESSAGE is one of
    these. COMMAND is a velocity that a node, the sender, gave a robot. ANSWER is the judge's to a tick. INTRUDER says
    that another process has connected, too.
    """

    kind: int
    content: bytes = b''  # of a message: as ROS serialises it
    topic: str = ''
    type: str = ''
    sender: str = ''  # full name of a node
    secs: int = 0  # of the world's time when it was said
    nsecs: int = 0

    @property
    def time(self) -> float:
        """When it was said [s], in the time of the world."""
        return self.secs + 1e-9 * self.nsecs

    def message(self) -> Any:
        """The message in it."""
        return roslib.message.get_message_class(self.type)().deserialize(self.content)


def packed(frame: Frame) -> bytes:
    """A frame as bytes."""
    texts = [text.encode() for text in (frame.topic, frame.type, frame.sender)]
    head = HEAD.pack(frame.kind, frame.secs, frame.nsecs, *map(len, texts), len(frame.content))
    return b''.join((head, *texts, frame.content))


def serialised(message: Any) -> bytes:
    """A message as ROS sends it."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def frames(stream: BinaryIO) -> Iterator[Frame]:
    """The frames of a stream, until it ends; one of which only a part comes does not count."""
    while True:
        head = stream.read(HEAD.size)
        if len(head) < HEAD.size:
            return
        kind, secs, nsecs, *lengths = HEAD.unpack(head)
        parts = [stream.read(length) for length in lengths]
        if [len(part) for part in parts] != lengths:
            return
        topic, type_, sender = (part.decode() for part in parts[:3])
        yield Frame(kind, parts[3], topic, type_, sender, secs, nsecs)
