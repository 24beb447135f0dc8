"""The thread that serves the calls of a node ends with the node."""

import threading
from xmlrpc import client

import pytest
from rosgraph import xmlrpc

from rumba_sim.ros.running import prompt_end

PATIENCE = 30.0  # [s]


@pytest.fixture
def node(monkeypatch):
    """A node that is served in a thread, and that thread."""
    monkeypatch.setattr(xmlrpc, 'ThreadingXMLRPCServer', xmlrpc.ThreadingXMLRPCServer)  # put back afterwards
    prompt_end.use()
    is_ready = threading.Event()
    handler = xmlrpc.XmlRpcHandler()
    handler._ready = lambda uri: is_ready.set()
    node = xmlrpc.XmlRpcNode(0, handler)
    thread = threading.Thread(target=node.run, daemon=True)
    thread.start()
    assert is_ready.wait(PATIENCE)
    return node, thread


def test_the_thread_ends_with_the_node(node):
    served, thread = node
    served.shutdown('test')
    thread.join(PATIENCE)
    assert not thread.is_alive()


def test_until_then_it_serves(node):
    served, _ = node
    with client.ServerProxy(served.uri) as proxy:
        with pytest.raises(client.Fault, match='not supported'):
            proxy.no_such_method()
    served.shutdown('test')
