"""One client's session in rosbridge's protocol, without ROS and without a network."""

import json
import sys

import pytest

from rumba_viewer.page.allow_list import AllowList, Rights
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages.errors import Hostile, Refusal
from rumba_viewer.page.protocol import MOST_TOPICS, Session


class FakeRos:
    """Writes down what it is asked for."""

    def __init__(self):
        self.asked = []

    def __getattribute__(self, name):
        if name in ('subscribe', 'unsubscribe', 'advertise', 'unadvertise', 'publish', 'unserve', 'answer',
                    'leave'):
            return lambda _, *arguments: self.asked.append((name, *arguments))
        return super().__getattribute__(name)

    def kind(self, topic):
        return 'nav_msgs/OccupancyGrid' if topic == '/map' else ''

    def call(self, _, service, values, done, timeout):
        if service == '/simulator/pause':
            raise Refusal('it is late')
        done(True, {'of': service, 'timeout': timeout, **values})

    def serve(self, _, service, kind, ask, tell):
        self.asked.append(('serve', service, kind))
        self.ask, self.tell = ask, tell


class Client:
    """A session, and what it replies."""

    def __init__(self, rights=Rights(everything=True), **allowed):
        self.replies, self.ros = [], FakeRos()
        self.session = Session(self.ros, AllowList(**allowed), rights, '/', self, self.reply)

    def reply(self, operation):
        """Take a reply, which must be JSON."""
        self.replies.append(json.loads(json.dumps(operation, allow_nan=False)))

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


@pytest.mark.parametrize('rights, told', [
    (Rights(everything=True), {'everything': True, 'robots': []}), (Rights(), {'everything': False, 'robots': []}),
    (Rights(robots=frozenset(('/rumba2', '/rumba'))), {'everything': False, 'robots': ['/rumba', '/rumba2']})])
def test_a_client_can_ask_what_it_may_change(rights, told):
    asked, replies = Client(rights).says(op='call_service', service='/rosapi/rights', id='x')
    assert not asked and replies == [{'op': 'service_response', 'service': '/rosapi/rights', 'id': 'x', 'values': told,
                                      'result': True}]


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
              'values': {'of': '/rumba/set_brushes_up', 'timeout': 2.5, 'data': True}}
    assert client.says(op='call_service', service='/rumba/set_brushes_up', id='x', args={'data': True},
                       timeout=2.5)[1] == [answer]
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
    assert client.ros.asked[:3] == [('unsubscribe', '/map', None), ('unadvertise', '/rumba/cmd_vel'), ('leave',)]


@pytest.mark.parametrize('operation, line', [
    ({'op': 'dance'}, "unknown operation 'dance': this server knows"),
    ({'op': 'fragment', 'data': '{', 'num': 0, 'total': 2}, 'fragment is not offered here: send the message whole'),
    ({'op': 'png', 'data': ''}, 'png is not offered here: send the message without'),
    ({'op': 'auth', 'mac': ''}, 'auth is not offered here: open the connection with ?token=TOKEN'),
    *(({'op': name}, f'{name} is not offered here: ROS 1 has actions as topics') for name in (
        'advertise_action', 'unadvertise_action', 'send_action_goal', 'cancel_action_goal', 'action_feedback',
        'action_result')),
    ({'op': 'advertise_service', 'service': '/x', 'type': 'std_srvs/Trigger'}, "'/x' cannot be served here"),
    ({'op': 'unadvertise_service', 'service': '/x'}, 'this client does not serve /x'),
    ({'op': 'service_response', 'service': '/x', 'id': 'a', 'result': True}, 'this client does not serve /x'),
    ({'op': 'call_service', 'service': 5}, 'service is 5: must be a name'),
    ({'op': 'call_service', 'service': '/simulator/pause', 'id': []}, 'id is []: must be a text or a number'),
    ({'op': 'subscribe', 'topic': '/rosout'}, "'/rosout' cannot be subscribed to here"),
    ({'op': 'subscribe'}, 'topic is None: must be a name'),
    ({'op': 'subscribe', 'topic': '/map', 'compression': 'zip'}, "compression is 'zip': must be one of none, png"),
    ({'op': 'subscribe', 'topic': '/map', 'throttle_rate': -1}, 'throttle_rate is -1: must be a number from 0'),
    ({'op': 'subscribe', 'topic': '/map', 'id': {}}, 'id is {}: must be a text'),
    ({'op': 'subscribe', 'topic': '/map/../x'}, "topic is '/map/../x': must be a name"),
    ({'op': 'advertise', 'topic': '/rumba/cmd_vel', 'type': 'os'}, "type is 'os': must be the type of a message"),
    ({'op': 'set_level', 'level': 'loud'}, "level is 'loud': must be one of")])
def test_what_cannot_be_done_is_told_in_a_status(operation, line):
    assert Client().is_refused(**operation).startswith(line)


@pytest.mark.parametrize('number', ['NaN', 'Infinity', '-Infinity', '[NaN]', '{"a": [Infinity]}', '1e999'])
def test_an_id_that_json_cannot_express_is_not_repeated(number):
    client = Client()
    for operation in ('"op": "subscribe", "topic": "/rosout"', '"op": "subscribe", "topic": "/map"',
                      '"op": "call_service", "service": "/simulator/reset"', '"op": "dance"'):
        client.session.receive(f'{{{operation}, "id": {number}}}')
        reply = client.replies.pop()
        assert reply['op'] == 'status' and 'id' not in reply
    assert not client.ros.asked


def nested():
    """A list as deep as Python can read, but for a few levels."""
    depth = sys.getrecursionlimit()
    while True:
        depth -= 5
        try:
            json.loads(depth * '[' + depth * ']')
        except RecursionError:
            continue
        return (depth - 5) * '[' + (depth - 5) * ']'


@pytest.mark.parametrize('key', ['service', 'id', 'args', 'type', 'timeout', 'compression'])
def test_a_field_that_is_nested_deeply_is_answered_and_the_client_stays(key):
    client, deep = Client(), nested()
    for operation in ('"op": "call_service", "service": "/simulator/pause"', '"op": "subscribe", "topic": "/rosout"',
                      '"op": "advertise", "topic": "/rumba/cmd_vel"'):
        client.session.receive(f'{{{operation}, "{key}": {deep}}}')
    assert len(client.replies) == 3


def test_a_service_of_a_client_is_asked_and_answers():
    client = Client(serve=['/sum', '/nothing'])
    assert client.says(op='advertise_service', service='sum', type='a/Sum')[0] == [('serve', '/sum', 'a/Sum')]
    client.ros.ask('r1', {'a': 2})
    assert client.replies == [{'op': 'call_service', 'id': 'r1', 'service': 'sum', 'args': {'a': 2}}]
    for sent, worked, values in (({'result': True, 'values': {'sum': 3}}, True, {'sum': 3}),
                                 ({'result': False, 'values': {'sum': 3}}, True, {'sum': 3}),
                                 ({'values': {}}, True, {}), ({'result': True}, True, None),
                                 ({'result': False, 'values': 'tired'}, False, 'tired'),
                                 ({'result': False, 'values': {}}, False, {}), ({}, False, None)):
        assert client.says(op='service_response', service='/sum', id='r1', **sent)[0] == [
            ('answer', '/sum', 'r1', worked, values)]
    assert client.says(op='unadvertise_service', service='/sum')[0] == [('unserve', '/sum')]
    client.says(op='advertise_service', service='/sum', type='a/Sum', id='me')
    client.ros.tell('error', 'another node serves it')
    assert client.replies == [{'op': 'status', 'level': 'error', 'msg': 'another node serves it', 'id': 'me'}]
    client.says(op='advertise_service', service='/nothing', type='a/Nothing')
    del client.ros.asked[:]
    client.session.close()
    assert client.ros.asked == [('unserve', '/nothing'), ('leave',)]


def test_to_serve_needs_the_allow_list_and_a_token():
    watching = Client(Rights(), serve=['/sum', '*/dance'])
    assert 'needs a token' in watching.is_refused(op='advertise_service', service='/sum', type='a/Sum')
    pupil = Client(Rights(robots=frozenset(['/rumba'])), serve=['/sum', '*/dance'])
    assert 'needs the token of' in pupil.is_refused(op='advertise_service', service='/sum', type='a/Sum')
    assert pupil.says(op='advertise_service', service='/rumba/dance', type='a/Sum')[0]


def test_parameters_need_the_allow_list_and_a_change_a_token():
    def answer(client, service, name):
        reply, = client.says(op='call_service', service=f'/rosapi/{service}', args={'name': name})[1]
        return reply['values']
    watching = Client(Rights(), get=['/a', '*/gain'], set=['/a', '*/gain'])
    assert answer(watching, 'get_param', 'a')['name'] == '/a' and answer(watching, 'has_param', '/rumba/gain')
    for service in ('set_param', 'delete_param'):
        assert 'needs a token' in answer(watching, service, '/a')
        assert 'needs the token of' in answer(Client(Rights(robots=frozenset(['/rumba'])), set=['/a']), service, '/a')
        assert "'/b' cannot be set here" in answer(Client(set=['/a']), service, '/b')
        assert "'/a' cannot be set here" in answer(Client(get=['/a']), service, '/a')
        assert answer(Client(set=['/a']), service, '/a')['name'] == '/a'
    assert "'/b' cannot be read here" in answer(watching, 'get_param', '/b')
    assert 'name is 5: must be a name' in answer(watching, 'get_param', 5)
    reply, = watching.says(op='call_service', service='/rosapi/get_param', args=['/b'])[1]
    assert "must be an object with the name" in reply['values']


def test_frames_are_followed_by_whoever_may_subscribe_to_transforms_without_a_token():
    watching = Client(Rights())
    assert watching.says(op='advertise', topic='/tf2_web_republisher/goal', type='a/Goal')[0]
    assert watching.says(op='publish', topic='/tf2_web_republisher/cancel', msg={})[0]
    assert watching.says(op='call_service', service='/republish_tfs')[1][0]['result']
    for topic in ('/tf2_web_republisher/feedback', '/tf_repub_0'):
        assert watching.says(op='subscribe', topic=topic)[0]
    without = Client(defaults=False)
    assert "'/tf' cannot be subscribed to here" in without.is_refused(op='subscribe', topic='/tf_repub_0')
    assert "'/tf' cannot" in without.says(op='call_service', service='/republish_tfs')[1][0]['values']
    assert 'cannot be published to' in watching.is_refused(op='publish', topic='/tf2_web_republisher/status', msg={})


def test_what_is_harmless_is_a_warning_for_those_who_want_it():
    client = Client()
    client.says(op='set_level', level='warning')
    for operation, words in (({'op': 'unsubscribe', 'topic': '/map'}, 'has not subscribed to /map'),
                             ({'op': 'unadvertise', 'topic': '/map'}, 'has not advertised /map'),
                             ({'op': 'subscribe', 'topic': '/map', 'fragment_size': 5}, 'fragment_size is ignored'),
                             ({'op': 'subscribe', 'topic': '/map', 'type': 'std_msgs/String', 'fragment_size': None},
                              "/map has the type nav_msgs/OccupancyGrid and not 'std_msgs/String'")):
        reply, = client.says(**operation)[1]
        assert reply['level'] == 'warning' and words in reply['msg']


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
