"""Whether a node that the master knows is alive; a server answers as a master, and as a node of rospy or of roscpp."""

import socket
import threading
import xmlrpc.server

import pytest

from rumba_sim.ros.running import peers
from rumba_sim.ros.running.peers import has_ended, is_alive

NAME = '/simulator'


class Both:
    """A master, and the only node that it knows, at one address."""

    def __init__(self):
        self._server = xmlrpc.server.SimpleXMLRPCServer(('localhost', 0), logRequests=False)
        self.uri = f'http://localhost:{self._server.server_address[1]}'
        self.answer('lookupNode', self.uri)
        self._thread = threading.Thread(target=self._server.serve_forever, args=[0.01])
        self._thread.start()

    def answer(self, function, value):
        """Answer with a value, whatever is asked."""
        self._server.register_function(lambda *_: (1, '', value), function)

    def end(self):
        """Answer no more."""
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()


@pytest.fixture
def both(monkeypatch):
    """Such a server; the master is that of this process."""
    both = Both()
    monkeypatch.setenv('ROS_MASTER_URI', both.uri)
    yield both
    both.end()


def test_a_node_is_alive_that_tells_its_name_and_its_master_whatever_the_host_is_called(both):
    both.answer('getName', NAME)
    both.answer('getMasterUri', both.uri.replace('localhost', '127.0.0.1') + '/')
    assert is_alive(NAME)


def test_a_node_of_another_name_that_answers_there_now_is_another_node(both):
    both.answer('getName', '/other')
    both.answer('getMasterUri', both.uri)
    assert not is_alive(NAME)


@pytest.mark.parametrize('elsewhere', ['http://localhost:1', 'http://localhost', ''])
def test_so_is_one_of_the_same_name_at_another_master(both, elsewhere):
    both.answer('getName', NAME)
    both.answer('getMasterUri', elsewhere)
    assert not is_alive(NAME)


def test_a_node_that_tells_neither_as_those_of_roscpp_is_alive(both):
    assert is_alive(NAME)


def test_a_node_that_does_not_answer_is_not(both):
    both.answer('lookupNode', 'http://localhost:1')
    assert not is_alive(NAME)


def test_a_node_has_ended_if_nobody_or_another_node_is_where_the_master_knows_it(both):
    both.answer('getName', NAME)
    both.answer('getMasterUri', both.uri)
    assert not has_ended(NAME)
    both.answer('getName', '/other')
    assert has_ended(NAME)
    both.answer('lookupNode', 'http://localhost:1')
    assert has_ended(NAME)


def test_a_node_that_does_not_answer_in_time_has_not_ended(both, monkeypatch):
    """It may be stopped, or its machine be busy."""
    monkeypatch.setattr(peers, 'ANSWER_TIMEOUT', 0.05)
    with socket.create_server(('localhost', 0)) as silent:
        both.answer('lookupNode', f'http://localhost:{silent.getsockname()[1]}')
        assert not has_ended(NAME) and not is_alive(NAME)


def test_a_node_has_not_ended_because_the_master_has(both):
    both.answer('lookupNode', 'http://localhost:1')
    both.end()
    assert not has_ended(NAME)
