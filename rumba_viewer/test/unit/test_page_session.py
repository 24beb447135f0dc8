"""One client's session in rosbridge's protocol, and the feeds of topics; without ROS and without a network."""

import json

import pytest

from rumba_viewer.page.allow_list import AllowList, Rights
from rumba_viewer.page.errors import Hostile, Refusal
from rumba_viewer.page.feeds import Arrival, Demand, Feed
from rumba_viewer.page.protocol import MOST_TOPICS, Session


class FakeRos:
    """Writes down what it is asked for."""

    def __init__(self):
        self.asked = []

    def __getattribute__(self, name):
        if name in ('subscribe', 'unsubscribe', 'advertise', 'unadvertise', 'publish'):
            return lambda _, *arguments: self.asked.append((name, *arguments))
        return super().__getattribute__(name)

    def call(self, _, service, values, done):
        if service == '/simulator/pause':
            raise Refusal('it is late')
        done(True, {'of': service, **values})


class Client:
    """A session, and what it replies."""

    def __init__(self, rights=Rights(everything=True)):
        self.replies, self.ros = [], FakeRos()
        self.session = Session(self.ros, AllowList(), rights, '/', self, self.replies.append)

    def says(self, **operation):
        """Send an operation; returns what it asked of ROS, and its replies."""
        del self.ros.asked[:], self.replies[:]
        self.session.receive(json.dumps(operation))
        return self.ros.asked, self.replies

    def is_refused(self, **operation):
        """Send an operation that must be refused; returns the line."""
        asked, replies = self.says(**operation)
        assert not asked and [reply['op'] for reply in replies] == ['status'] and replies[0]['level'] == 'error'
        return replies[0]['msg']


def test_the_operations_of_a_subscription():
    client = Client()
    assert client.says(op='subscribe', topic='rumba/scan', id='a', throttle_rate=200, queue_length=3) == (
        [('subscribe', '/rumba/scan', 'a', Demand(0.2, 3, name='rumba/scan'))], [])
    client.says(op='subscribe', topic='/rumba/scan', id='b', compression='png')
    assert client.says(op='unsubscribe', topic='/rumba/scan', id='a')[0] == [('unsubscribe', '/rumba/scan', 'a')]
    assert client.says(op='unsubscribe', topic='/rumba/scan')[0] == [('unsubscribe', '/rumba/scan', None)]


def test_the_operations_of_a_publisher():
    client, topic = Client(), '/rumba/cmd_vel'
    assert client.says(op='advertise', topic=topic, type='geometry_msgs/Twist', id='a')[0] == [
        ('advertise', topic, 'geometry_msgs/Twist', False)]
    assert client.says(op='publish', topic=topic, msg={'linear': {'x': 1}})[0] == [
        ('publish', topic, {'linear': {'x': 1}})]
    assert client.says(op='unadvertise', topic=topic, id='a')[0] == [('unadvertise', topic)]
    assert client.says(op='publish', topic=topic, msg={})[0] == [
        ('advertise', topic, None, False), ('publish', topic, {})]


def test_a_call_is_answered_with_its_id_also_if_it_fails():
    client = Client()
    answer = {'op': 'service_response', 'service': '/rumba/set_brushes_up', 'id': 'x', 'result': True,
              'values': {'of': '/rumba/set_brushes_up', 'data': True}}
    assert client.says(op='call_service', service='/rumba/set_brushes_up', id='x', args={'data': True})[1] == [answer]
    for service, line in (('/simulator/pause', 'it is late'), ('/rosout/get_loggers', "'/rosout/get_loggers' cannot")):
        reply, = client.says(op='call_service', service=service)[1]
        assert not reply['result'] and reply['values'].startswith(line) and 'id' not in reply


def test_all_is_given_back_at_the_end():
    client = Client()
    client.says(op='subscribe', topic='/map')
    client.says(op='publish', topic='/rumba/cmd_vel', msg={})
    del client.ros.asked[:]
    client.session.close()
    client.session.close()
    assert client.ros.asked == [('unsubscribe', '/map', None), ('unadvertise', '/rumba/cmd_vel')]


@pytest.mark.parametrize('operation, line', [
    ({'op': 'advertise_service', 'service': '/x'}, "unknown operation 'advertise_service': this server knows"),
    ({'op': 'subscribe', 'topic': '/rosout'}, "'/rosout' cannot be subscribed to here"),
    ({'op': 'subscribe'}, 'topic is None: must be a name'),
    ({'op': 'subscribe', 'topic': '/map', 'compression': 'cbor'}, "compression is 'cbor': must be one of none, png"),
    ({'op': 'subscribe', 'topic': '/map', 'throttle_rate': -1}, 'throttle_rate is -1: must be a number from 0'),
    ({'op': 'subscribe', 'topic': '/map', 'id': {}}, 'id is {}: must be a text'),
    ({'op': 'subscribe', 'topic': '/map/../x'}, "topic is '/map/../x': must be a name"),
    ({'op': 'advertise', 'topic': '/rumba/cmd_vel', 'type': 'os'}, "type is 'os': must be the type of a message"),
    ({'op': 'set_level', 'level': 'loud'}, "level is 'loud': must be one of")])
def test_what_cannot_be_done_is_told_in_a_status(operation, line):
    assert Client().is_refused(**operation).startswith(line)


def test_a_status_has_the_id_of_its_operation_and_can_be_switched_off():
    client = Client()
    assert client.says(op='subscribe', topic='/rosout', id='me')[1][0]['id'] == 'me'
    client.says(op='set_level', level='none')
    assert client.says(op='subscribe', topic='/rosout') == ([], [])


@pytest.mark.parametrize('text', ['', '{', 'null', '[]', '{"op": 1}', '[' * 100000, '"x"', b'\xff\xfe\xff'])
def test_what_no_client_sends_ends_the_connection(text):
    with pytest.raises(Hostile, match='.'):
        Client().session.receive(text)


@pytest.mark.parametrize('rights, topic, line', [
    (Rights(), '/rumba/cmd_vel', 'needs a token: without one you can only watch'),
    (Rights(robots=frozenset(['/rumba'])), '/rumba2/cmd_vel', 'needs the token of /rumba2')])
def test_a_change_needs_the_right_token_and_reading_does_not(rights, topic, line):
    client = Client(rights)
    for operation in ('advertise', 'publish'):
        assert line in client.is_refused(op=operation, topic=topic, type='geometry_msgs/Twist', msg={})
    assert line.split()[0] in client.says(op='call_service', service='/simulator/reset')[1][0]['values']
    assert client.says(op='subscribe', topic='/rumba2/scan')[0]


def test_a_client_can_ask_for_a_bounded_number_of_topics():
    client = Client()
    for number in range(MOST_TOPICS):
        client.says(op='subscribe', topic=f'/r{number}/scan')
    assert f'{MOST_TOPICS} topics at most' in client.is_refused(op='subscribe', topic='/one_more/scan')


# --- feeds ------------------------------------------------------------------------------------------------------------

class Reader:
    """Gets frames."""

    def __init__(self):
        self.got = []

    def push(self, _, frame, most):
        self.got.append(frame)


class Encoding:
    """Makes frames that can be recognised, and counts them."""

    def __init__(self):
        self.made = []

    def __call__(self, arrival, name, is_png):
        self.made.append(arrival.data)
        return name.encode() + b':' + arrival.data


def arrivals(feed, *datas, is_latched=False):
    """Let messages arrive."""
    feed.arrivals.extend(Arrival(data, 'a/B', '*', '/node', is_latched) for data in datas)


def feed_of(*demands):
    """A feed with a reader for each demand, and its encoding."""
    feed, encoding, readers = Feed('/t', lambda: 0.0), Encoding(), [Reader() for _ in demands]
    for reader, demand in zip(readers, demands):
        feed.add(reader, '', demand, encoding)
    return feed, encoding, readers


def test_a_message_is_made_into_text_once_however_many_listen():
    feed, encoding, readers = feed_of(*(30 * [Demand(name='t')]))
    arrivals(feed, b'1')
    feed.tick(0.0, encoding)
    assert encoding.made == [b'1'] and all(reader.got == [b't:1'] for reader in readers)


def test_who_does_not_throttle_gets_all_and_who_does_the_newest_in_time():
    feed, encoding, (eager, calm) = feed_of(Demand(), Demand(0.125))
    for tick in range(16):  # 0.5 s, a message each
        arrivals(feed, b'%d' % tick)
        feed.tick(tick / 32, encoding)
    assert eager.got == [b':%d' % tick for tick in range(16)]
    assert calm.got == [b':0', b':4', b':8', b':12']


def test_the_last_message_comes_even_if_it_came_too_early():
    feed, encoding, (reader,) = feed_of(Demand(0.1))
    arrivals(feed, b'1')
    feed.tick(0.0, encoding)
    arrivals(feed, b'2')
    feed.tick(0.02, encoding)
    assert reader.got == [b':1'] and feed.has_news
    feed.tick(0.12, encoding)
    assert reader.got == [b':1', b':2'] and not feed.has_news


@pytest.mark.parametrize('is_latched, wants_newest, got', [
    (True, False, [b':1']), (False, True, [b':1']), (False, False, [])])
def test_a_new_listener_gets_what_is_latched_or_what_it_wants(is_latched, wants_newest, got):
    feed, encoding, _ = feed_of()
    arrivals(feed, b'1', is_latched=is_latched)
    feed.tick(0.0, encoding)
    late = Reader()
    feed.add(late, '', Demand(newest=wants_newest), encoding)
    feed.tick(0.02, encoding)
    assert late.got == got


def test_several_subscriptions_of_a_client_are_one():
    feed, encoding, (reader,) = feed_of(Demand(10.0))
    feed.add(reader, 'quick', Demand(), encoding)
    arrivals(feed, b'1', b'2')
    feed.tick(0.0, encoding)
    assert reader.got == [b':1', b':2']
    feed.remove(reader, 'quick')
    assert feed.has_listeners
    feed.remove(reader, '')
    assert not feed.has_listeners
