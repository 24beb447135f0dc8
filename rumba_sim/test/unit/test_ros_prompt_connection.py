"""The connections of publishers: what is sent at once, what waits, what is lost, and in which order it comes."""

import socket
import struct
import threading

import pytest
import rospy
from rospy.exceptions import TransportTerminated
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_pubsub import QueuedConnection, TCPROSPub
from std_msgs.msg import String

from rumba_sim.ros.running import prompt_connection
from rumba_sim.ros.running.prompt_connection import PromptConnection

QUEUE = 5
SIZE = 100_000  # [bytes] of a message: some of them fill a socket


@pytest.fixture
def sockets():
    """The transport of a publisher, and the socket of its subscriber."""
    here, there = socket.socketpair()
    there.settimeout(10.0)
    transport = TCPROSTransport(TCPROSPub('/topic', String), '/topic')
    transport.set_socket(here, 'subscriber')
    yield transport, there
    transport.close()
    there.close()


@pytest.fixture
def ends(sockets):
    """The connection of a publisher, and the socket of its subscriber."""
    transport, there = sockets
    return PromptConnection(transport, QUEUE), there


def message(number, size=SIZE):
    """A message as on the wire: its length, and what is in it."""
    return struct.pack('<I', size) + struct.pack('<I', number) * (size // 4)


def received(there):
    """The number of the next message; asserts that the message is whole."""
    def some(count):
        found = b''
        while len(found) < count:
            part = there.recv(count - len(found))
            assert part, 'the connection has ended'
            found += part
        return found
    size, = struct.unpack('<I', some(4))
    found = some(size)
    assert found == found[:4] * (size // 4)
    return struct.unpack('<I', found[:4])[0]


def test_a_small_message_is_not_kept_back_until_an_earlier_one_is_acknowledged():
    with socket.create_server(('localhost', 0)) as server, socket.create_connection(server.getsockname()):
        here, _ = server.accept()
        transport = TCPROSTransport(TCPROSPub('/topic', String), '/topic')
        transport.set_socket(here, 'subscriber')
        PromptConnection(transport, QUEUE)
        assert here.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
        transport.close()


def test_a_message_is_sent_before_the_publisher_goes_on(ends):
    connection, there = ends
    there.setblocking(False)
    for number in range(100):
        assert connection.write_data(message(number, 40))
        assert there.recv(44) == message(number, 40)
    assert connection.stat_num_msg == 100 and connection.stat_bytes == 4400


def test_a_subscriber_that_does_not_read_loses_whole_messages_from_the_middle_and_holds_nobody_up(ends):
    connection, there = ends
    for number in range(200):
        connection.write_data(message(number))
    found = [received(there)]
    while found[-1] < 199:
        found.append(received(there))
    assert found == sorted(set(found)) and found[0] == 0
    assert found[-QUEUE:] == list(range(200 - QUEUE, 200)) and len(found) < 100


def test_messages_come_whole_and_in_order_while_the_subscriber_now_reads_and_now_does_not(ends):
    connection, there = ends
    found, may_read = [], threading.Event()

    def read():
        while not found or found[-1] < 999:
            may_read.wait()
            found.append(received(there))
    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    for number in range(1000):
        (may_read.set if number // 50 % 2 else may_read.clear)()
        connection.write_data(message(number, 4 * (1 + number * 7919 % 20_000)))
    may_read.set()
    reader.join(30.0)
    assert found[-1] == 999 and found == sorted(set(found))


def test_the_next_publisher_is_told_that_the_subscriber_has_gone(ends):
    connection, there = ends
    there.close()
    with pytest.raises(TransportTerminated):
        for _ in range(1000):
            connection.write_data(message(1, 4))
            connection._thread.join(0.01)


def test_what_cannot_be_sent_after_the_end_of_a_connection_does_not_hide_that_end(ends):
    connection, there = ends
    there.close()
    with connection._lock:
        connection._queue += [message(1, 4), message(2, 4)]
        connection._cond_data_available.notify()
    connection._thread.join(10.0)
    with pytest.raises(TransportTerminated):
        connection.write_data(message(3, 4))


def test_the_thread_ends_with_the_connection(ends):
    connection, _ = ends
    assert connection._thread.is_alive()
    connection.close()
    connection._thread.join(10.0)
    assert not connection._thread.is_alive()


def test_publishers_of_rospy_use_it(monkeypatch, sockets):
    monkeypatch.setattr(rospy.topics, 'QueuedConnection', QueuedConnection)
    prompt_connection.use()
    publisher = rospy.topics._PublisherImpl('/topic', String)
    publisher.set_queue_size(QUEUE)
    publisher.add_connection(sockets[0])
    assert type(publisher.connections[0]) is PromptConnection
