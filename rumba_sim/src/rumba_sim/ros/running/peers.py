"""Other nodes at the same master: who is alive, who serves what, and who was first if several want the same."""

import http.client
import threading
import urllib.parse
import xmlrpc.client
import xmlrpc.server
from typing import Any, List, Optional, Set, Tuple

import rosgraph
import rospy
from rospy.impl.registration import get_topic_manager

from rumba_sim.model.common.errors import WorldError

ANSWER_TIMEOUT = 2.0  # [s] to wait for the answer of a node that the master knows
NO_ANSWER = (rosgraph.MasterException, xmlrpc.client.Error, http.client.HTTPException, OSError)
RELEASE_TIME = 0.02  # [s] between two looks of the server of a reservation whether it shall end


class _Hasty(xmlrpc.client.Transport):
    """Gives up if there is no answer."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = ANSWER_TIMEOUT
        return connection


def hasty_master(name: str) -> rosgraph.Master:
    """The master for a node, by its full name; a call of it that takes long is an OSError."""
    master = rosgraph.Master(name)
    master.handle = xmlrpc.client.ServerProxy(master.master_uri, _Hasty())
    return master


def is_alive(name: str) -> bool:
    """Whether a node answers, given by its full name: the master still knows nodes that were killed.

    The port of such a node may belong to another one by now, perhaps to one of the same name at another master. Nodes
    of rospy tell their name and their master; those of roscpp tell neither, and count.
    """
    try:
        return _is_at(rosgraph.Master(name).lookupNode(name), name)
    except NO_ANSWER:
        return False


def has_ended(name: str) -> bool:
    """Whether a node has ended without telling the master, given by its full name: nobody is there, or another node.

    Unlike one that is not alive, it is gone for sure: a node that is stopped, or too busy to answer, has not ended.
    """
    try:
        uri = hasty_master(name).lookupNode(name)
    except NO_ANSWER:
        return False
    try:
        return not _is_at(uri, name)
    except ConnectionRefusedError:
        return True
    except NO_ANSWER:
        return False


def _is_at(uri: str, name: str) -> bool:
    """Whether a node of our master is at an address, given by its full name.

    Raises:
        OSError, xmlrpc.client.Error, http.client.HTTPException: it does not answer.
    """
    node: Any = xmlrpc.client.ServerProxy(uri, _Hasty())
    try:
        answered, master = node.getName(name)[-1], node.getMasterUri(name)[-1]
    except xmlrpc.client.Fault:
        return True
    return bool(answered == name and _port(master) == _port(rosgraph.get_master_uri()))


def _port(uri: Any) -> Optional[int]:
    return urllib.parse.urlsplit(str(uri)).port


def is_served(service: str) -> bool:
    """Whether a node serves a service, and answers."""
    try:
        rosgraph.Master(rospy.get_name()).lookupService(rospy.resolve_name(service))
        rospy.wait_for_service(service, ANSWER_TIMEOUT)
    except (*NO_ANSWER, rospy.ROSException):
        return False
    return True


def publishers(topic: str) -> List[str]:
    """Full names of the nodes that the master knows as publishers of a topic, in the order in which they came.

    Raises:
        OSError: the master does not answer.
    """
    return dict(rosgraph.Master('/unnamed').getSystemState()[0]).get(topic, [])


def unconnected() -> Set[Tuple[str, str]]:
    """Topics of this node, and full names of nodes that subscribe to them, but to which it has no connection.

    A node that has just subscribed connects soon; one that was killed, or expects another type, never does.

    Raises:
        OSError: the master does not answer.
    """
    manager = get_topic_manager()
    ours = {topic for topic, _ in manager.get_publications()}
    subscribers = hasty_master(rospy.get_name()).getSystemState()[1]
    connected = {(topic, node) for _, node, _, _, topic, *_ in manager.get_pub_sub_info()}
    return {(topic, node) for topic, nodes in subscribers if topic in ours for node in nodes} - connected


class Reservation:
    """Something that only one node at a master may have, for the time until the others can see that it is taken.

    If two nodes look for one another before either has registered what they look for, both go on. Therefore each first
    registers as publisher of a topic of the reservation: the master keeps these in order, and the first one has it. For
    this, a node needs no name of its own yet; a process that was killed does not answer, and does not count.
    """

    def __init__(self, what: str) -> None:
        """Prepare to reserve `what`, the full name of a node or a service."""
        self._topic = f'/reserved{what}'
        self._held: Optional[Tuple[xmlrpc.server.SimpleXMLRPCServer, rosgraph.Master, str]] = None

    def take(self) -> bool:
        """Reserve it; returns whether it is now reserved for this process.

        Raises:
            OSError: the master does not answer.
        """
        server = xmlrpc.server.SimpleXMLRPCServer((rosgraph.network.get_bind_address(), 0), logRequests=False)
        name = rosgraph.names.anonymous_name('/reservation')
        server.register_function(lambda _: (1, '', name), 'getName')
        server.register_function(lambda _: (1, '', rosgraph.get_master_uri()), 'getMasterUri')
        threading.Thread(target=server.serve_forever, args=[RELEASE_TIME], daemon=True).start()
        uri = rosgraph.network.create_local_xmlrpc_uri(server.server_address[1])
        master = rosgraph.Master(name)
        self._held = server, master, uri
        master.registerPublisher(self._topic, 'std_msgs/Empty', uri)
        before = publishers(self._topic)
        if any(map(is_alive, before[:before.index(name)])):
            self.release()
            return False
        return True

    def release(self) -> None:
        """Give it free, once others can see what was reserved."""
        if self._held is None:
            return
        server, master, uri = self._held
        self._held = None
        try:
            master.unregisterPublisher(self._topic, uri)
        except NO_ANSWER:
            pass  # the master has ended, and forgotten it
        server.shutdown()
        server.server_close()


def refuse_twin(name: str) -> None:
    """Refuse to start beside a living node of the same full name.

    Raises:
        WorldError: there is one.
    """
    if is_alive(name):
        raise WorldError(f'a node {name} is already running: end it first')


def caller(message: Any) -> str:
    """Full name of the node that sent a message or a request."""
    return str(message._connection_header.get('callerid', 'a node without a name'))
