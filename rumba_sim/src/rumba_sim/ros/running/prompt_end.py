"""A server of a node's calls that ends with the node.

rospy closes the socket of this server, whose thread then asks the closed socket again and again until the process ends:
the end of a node takes as much of a processor as its start.
"""

import errno

from rosgraph import xmlrpc


def use() -> None:
    """Have this node, which is not registered yet, be served by such a server."""
    setattr(xmlrpc, 'ThreadingXMLRPCServer', PromptlyEndingServer)


class PromptlyEndingServer(xmlrpc.ThreadingXMLRPCServer):
    """Stops serving once its socket is closed."""

    def service_actions(self) -> None:
        """Do what is to do between two looks for a call.

        Raises:
            OSError: the socket is closed; the thread that serves ends by it.
        """
        super().service_actions()
        if self.socket.fileno() < 0:
            raise OSError(errno.EBADF, 'the socket of the server is closed')
