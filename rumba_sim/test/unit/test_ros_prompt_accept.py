"""Whoever connects to a node and says nothing, or speaks HTTP, keeps nobody else out."""

import socket
import threading

import pytest
import rosgraph.network
from rospy.impl.tcpros_base import TCPROSServer

from rumba_sim.ros.running import prompt_accept

PATIENCE = 30.0  # [s]: it waits for a minute if it does not begin in threads


@pytest.fixture
def connect(monkeypatch):
    """Functions that connect to a server of rospy, and tell whether a topic is asked for over a connection, in time."""
    monkeypatch.setattr(TCPROSServer, '_tcp_server_callback', TCPROSServer._tcp_server_callback)  # puts it back
    prompt_accept.use()
    server, topics, news = TCPROSServer(), [], threading.Condition()

    def hear(_connection, _address, header):
        with news:
            topics.append(header['topic'])
            news.notify_all()

    server.topic_connection_handler = hear
    server.start_server()
    connections = []

    def connected():
        connections.append(socket.create_connection(('localhost', server.get_address()[1]), PATIENCE))
        return connections[-1]

    def hears(topic):
        with news:
            return news.wait_for(lambda: topic in topics, PATIENCE)

    yield connected, hears
    for connection in connections:
        connection.close()
    server.shutdown()


def test_who_says_nothing_keeps_nobody_out(connect):
    connected, hears = connect
    connected()
    rosgraph.network.write_ros_handshake_header(connected(), {'topic': 'odom'})
    assert hears('odom')


def test_who_speaks_http_is_disconnected_at_once(connect):
    connected, _ = connect
    http = connected()
    http.sendall(b'POST /RPC2 HTTP/1.1\r\nHost: localhost\r\n\r\n')
    with pytest.raises(ConnectionResetError):
        http.recv(1)


def test_a_long_header_in_pieces_is_heard(connect):
    connected, hears = connect
    connection = connected()
    header = rosgraph.network.encode_ros_handshake_header({'topic': 'scan', 'message_definition': 'x' * 100_000})
    for begin in range(0, len(header), 4099):
        connection.sendall(header[begin:begin + 4099])
    assert hears('scan')
