"""Connections that one thread reads: who takes the messages, what holds nobody up, and how a connection ends."""

import io
import queue
import socket
import struct
import threading

import pytest
from rospy.exceptions import TransportException, TransportTerminated
from rospy.impl import tcpros_pubsub
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_pubsub import TCPROSSub
from std_msgs.msg import String

from rumba_sim.ros.running import shared_reception
from rumba_sim.ros.running.shared_reception import SharedConnection, share

TOPICS = '/one', '/two'
PATIENCE = 10.0  # [s]


class Subscription:
    """A connection of a subscriber, with the thread that rospy gives it, and the socket of its publisher."""

    def __init__(self, topic):
        here, self.there = socket.socketpair()
        self.connection = SharedConnection(TCPROSSub(topic, String, queue_size=100), topic)
        self.connection.socket, self.connection.header = here, {'callerid': '/publisher'}
        self._told = queue.Queue()
        self.error = None
        self.thread = threading.Thread(target=self._read, daemon=True)

    def _read(self):
        def tell(messages, connection):
            assert connection is self.connection
            for message in messages:
                self._told.put((message.data, message._connection_header, threading.current_thread()))
        try:
            self.connection.receive_loop(tell)
        except BaseException as error:
            self.error = error

    def next(self):
        """The text of the next message, what is known of its publisher, and the thread that told it."""
        return self._told.get(timeout=PATIENCE)

    @property
    def is_silent(self):
        """Whether all messages were taken."""
        return self._told.empty()


@pytest.fixture
def subscribe(monkeypatch):
    """Begins subscriptions of a topic that is shared, or not."""
    monkeypatch.setattr(shared_reception, '_shared', set())
    share(*TOPICS)
    begun = []

    def begin(topic):
        begun.append(Subscription(topic))
        begun[-1].thread.start()
        return begun[-1]
    yield begin
    for each in begun:
        each.connection.close()
        each.there.close()
        each.thread.join(PATIENCE)
        assert not each.thread.is_alive()


def message(text):
    """A message as on the wire."""
    buffer = io.BytesIO()
    String(text).serialize(buffer)
    return struct.pack('<I', len(buffer.getvalue())) + buffer.getvalue()


def test_one_thread_takes_the_messages_of_all_shared_topics_in_order(subscribe):
    subscriptions = [subscribe(topic) for topic in (*TOPICS, TOPICS[0])]
    threads = set()
    for number in range(20):
        for each in subscriptions:
            each.there.sendall(message(f'{number}') + message(f'{number}, too'))
        for each in subscriptions:
            for text in (f'{number}', f'{number}, too'):
                told, header, thread = each.next()
                assert (told, header) == (text, {'callerid': '/publisher'})
                threads.add(thread)
    assert len(threads) == 1 and not threads & {each.thread for each in subscriptions}
    assert [each.connection.stat_num_msg for each in subscriptions] == [40] * 3


def test_topics_that_are_not_shared_keep_their_threads(subscribe):
    own = subscribe('/own')
    own.there.sendall(message('hello'))
    assert own.next() == ('hello', {'callerid': '/publisher'}, own.thread)


def test_half_a_message_holds_up_nobody_and_is_told_once_it_is_whole(subscribe):
    slow, other = map(subscribe, TOPICS)
    whole = message('slow')
    slow.there.sendall(whole[:6])
    for number in range(10):
        other.there.sendall(message(str(number)))
        assert other.next()[0] == str(number)
    assert slow.is_silent
    slow.there.sendall(whole[6:])
    assert slow.next()[0] == 'slow'


def test_what_came_with_the_header_is_told(monkeypatch):
    monkeypatch.setattr(shared_reception, '_shared', set(TOPICS))
    early = Subscription(TOPICS[0])
    early.connection.read_buff.write(message('latched'))
    early.thread.start()
    assert early.next()[0] == 'latched'
    early.there.sendall(message('later'))
    assert early.next()[0] == 'later'
    early.connection.close()
    early.thread.join(PATIENCE)


@pytest.mark.parametrize('error', [ZeroDivisionError, SystemExit])
def test_a_callback_that_fails_costs_its_connection_only(subscribe, error):
    def fail(*_):
        raise error('no way')
    bad, other = Subscription(TOPICS[0]), subscribe(TOPICS[1])
    bad.connection._tell = fail
    bad.there.sendall(message('x'))
    with pytest.raises(TransportException, match='/one: no way'):
        bad.connection.receive_once()
    other.there.sendall(message('y'))
    assert other.next()[0] == 'y'
    bad.connection.close()


@pytest.mark.parametrize(('sent', 'kind'), [
    (struct.pack('<2I', 4, 99), TransportException), (b'', TransportTerminated)])
def test_nonsense_and_the_end_of_a_publisher_end_the_connection(monkeypatch, sent, kind):
    monkeypatch.setattr(shared_reception, '_shared', set(TOPICS))
    ended = Subscription(TOPICS[0])
    ended.there.sendall(sent)
    ended.there.shutdown(socket.SHUT_WR)
    with pytest.raises(kind):
        ended.connection.receive_once()
    ended.connection.close()


def test_subscribers_of_rospy_use_it(monkeypatch):
    monkeypatch.setattr(tcpros_pubsub, 'TCPROSTransport', TCPROSTransport)
    shared_reception.use()
    assert tcpros_pubsub.TCPROSTransport is SharedConnection
