"""The newest transform of each link, of messages of tf that tell the same links several times.

A simulator that runs as fast as possible tells all transforms since the last control tick at once. Making objects of
them takes a node longer than anything else that comes, and of most nothing is wanted but the newest.
"""

import struct
from typing import Any, Dict, Tuple

import genpy
from tf2_msgs.msg import TFMessage

COUNT = struct.Struct('<I')
HEADER = struct.Struct('<4I')  # number, stamp [s], [ns], and length of the frame; then come the frame and the child
PLACE = 7 * 8  # [bytes] of translation and rotation, which come last


class NewestTransforms(TFMessage):
    """A tf2_msgs/TFMessage whose `transforms`, once it was received, has only the last one of each frame and child."""

    def deserialize(self, content: bytes) -> Any:
        """Fill this message with what was received, and return it.

        Raises:
            genpy.DeserializationError: that is no such message.
        """
        try:
            newest = list(_newest(content).values())
        except struct.error as error:
            raise genpy.DeserializationError(error) from None
        return super().deserialize(COUNT.pack(len(newest)) + b''.join(newest))


def _newest(content: bytes) -> Dict[Tuple[bytes, bytes], bytes]:
    """The last transform of each frame and child, as it was received.

    Raises:
        struct.error: something is missing.
    """
    found = {}
    (count,) = COUNT.unpack_from(content)
    at = COUNT.size
    for _ in range(count):
        begin, frame = at, at + HEADER.size
        child = frame + HEADER.unpack_from(content, begin)[-1] + COUNT.size
        end = child + COUNT.unpack_from(content, child - COUNT.size)[0]
        at = end + PLACE
        found[content[frame:child - COUNT.size], content[child:end]] = content[begin:at]
    return found
