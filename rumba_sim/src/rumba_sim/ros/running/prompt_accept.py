"""Connections to a node that each begin in a thread of their own, so that a silent one keeps nobody out.

rospy reads what comes over a new connection in the one thread that accepts all of them. Somebody who connects and says
nothing holds up all subscribers and all clients of services for a minute. So does who speaks HTTP: a master calls nodes
that have ended, until it notices, and the port of such a node may be that of another node by then.
"""

import contextlib
import socket
import struct
import threading
from typing import Any

from rospy.impl.tcpros_base import TCPROSServer

LONGEST = 1 << 20  # [bytes] of what is said at first: its length comes before it; the first word of HTTP is 'POST'
_usual = TCPROSServer._tcp_server_callback


def use() -> None:
    """Have this node begin with its connections in this way, from its start on."""
    setattr(TCPROSServer, '_tcp_server_callback', _begin)


def _begin(server: Any, connection: socket.socket, address: Any) -> None:
    threading.Thread(target=_listen, args=(server, connection, address), daemon=True).start()


def _listen(server: Any, connection: socket.socket, address: Any) -> None:
    """Go on as rospy does with who speaks its protocol; anybody else is disconnected."""
    with contextlib.suppress(OSError):
        length = connection.recv(4, socket.MSG_PEEK)
        if len(length) < 4 or struct.unpack('<I', length)[0] <= LONGEST:
            _usual(server, connection, address)
            return
    connection.close()
