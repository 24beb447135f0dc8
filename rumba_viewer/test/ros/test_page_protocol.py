#!/usr/bin/env python3
"""The page beside nodes of ROS, without a simulator: messages, services, parameters, transforms and time."""

import functools
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import PointStamped, TransformStamped
from pages import Client, Page
from rosgraph_msgs.msg import Clock
from simulators import TIMEOUT, Heard, lookup, wait
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse
from tf2_msgs.msg import TFMessage

from rumba_msg.msg import CleanActionGoal
from rumba_viewer.page import cbor

GOAL = '/rumba/clean/goal'
HALF = '\ud83d'  # of a character, as JavaScript cuts texts


def sender(test, topic, message, latch=False):
    """A publisher until the end of a test."""
    publisher = rospy.Publisher(topic, message, queue_size=10, latch=latch)
    test.addCleanup(publisher.unregister)
    return publisher


class MessageTest(unittest.TestCase):
    """What clients publish, and what they get."""

    def test_what_cannot_be_serialised_is_refused_and_the_topic_goes_on_for_all(self):
        page, heard = Page(self), Heard(self, GOAL, CleanActionGoal, waits=False)
        odd, good = Client(self, page), Client(self, page)
        for client in (odd, good):
            client.send(op='advertise', topic=GOAL, type='rumba_msg/CleanActionGoal')
        good.send(op='publish', topic=GOAL, msg={'goal_id': {'id': 'first'}})
        heard.find(lambda message: message.goal_id.id == 'first')
        for number, (values, words) in enumerate((
                ({'header': {'stamp': {'secs': -1, 'nsecs': 0}}}, 'header.stamp is'),
                ({'goal_id': {'stamp': {'secs': 2 ** 32}}}, 'goal_id.stamp is'), ({'goal_id': {'id': HALF}}, 'halves'),
                ({'header': {'stamp': {'sec': 5, 'nsecs': 6}}}, 'header.stamp is'))):
            odd.send(op='publish', topic=GOAL, msg=values)
            self.assertIn(words, odd.status())
            good.send(op='publish', topic=GOAL, msg={'goal_id': {'id': f'after {number}'}, 'header': {
                'frame_id': 'map', 'stamp': {'sec': 2 ** 32 - 1, 'nanosec': 7}}})
            found = heard.find(lambda message: message.goal_id.id == f'after {number}')
            self.assertEqual((found.header.stamp.secs, found.header.stamp.nsecs), (2 ** 32 - 1, 7))
        odd.send(op='publish', topic=GOAL, msg={'goal_id': {'id': 'last'}})
        heard.find(lambda message: message.goal_id.id == 'last')
        self.assertEqual([message.header.seq for message in heard.messages], list(range(1, 7)))

    def test_what_a_client_publishes_just_before_it_leaves_arrives(self):
        page, heard = Page(self, '_write:=/brief'), Heard(self, '/brief', String, waits=False)
        for number in range(3):
            client = Client(self, page)
            client.send(op='advertise', topic='/brief', type='std_msgs/String')
            client.send(op='publish', topic='/brief', msg={'data': str(number)})
            client.send(op='unadvertise', topic='/brief')
            client.close()
            heard.find(lambda message: message.data == str(number))

    def test_cbor_is_binary_and_cbor_raw_has_the_bytes_of_ros(self):
        page = Page(self, '_read:=/words')
        sender(self, '/words', String, latch=True).publish('ä')
        for compression, values in (('cbor', {'data': 'ä'}), ('cbor-raw', None)):
            client = Client(self, page)
            client.send(op='subscribe', topic='/words', compression=compression)
            data = client.raw()
            if values is None:
                self.assertTrue(data.endswith(cbor.encoded({'bytes': b'\x02\0\0\0' + 'ä'.encode()})[1:]), data)
            else:
                self.assertEqual(data, cbor.encoded({'op': 'publish', 'topic': '/words', 'msg': values}))


class GraphTest(unittest.TestCase):
    """What `/rosapi` tells."""

    def test_topics_are_those_that_live_and_those_of_the_client_at_once(self):
        page = Page(self, '_read:=/brief,/mine', '_write:=/brief,/mine')
        client = Client(self, page)

        def topics():
            answer = client.call('/rosapi/topics')[1]
            return dict(zip(answer['topics'], answer['types']))
        publisher = rospy.Publisher('/brief', String, queue_size=1)
        wait(self, lambda: topics().get('/brief') == 'std_msgs/String', 'the topic')
        client.send(op='subscribe', topic='/brief')
        publisher.unregister()
        wait(self, lambda: '/brief' not in topics(), 'the end of the topic')
        client.send(op='advertise', topic='/brief', type='std_msgs/Bool')  # which is no topic of texts any more
        client.send(op='advertise', topic='/mine', type='std_msgs/String')
        self.assertEqual((topics().get('/mine'), topics().get('/brief')), ('std_msgs/String', 'std_msgs/Bool'))
        client.send(op='unadvertise', topic='/mine')
        wait(self, lambda: '/mine' not in topics(), 'the end of the topic')

    def test_types_are_explained_and_nodes_told_of_topics_that_can_be_reached(self):
        client = Client(self, Page(self, '_read:=/words'))
        sender(self, '/words', String, latch=True)
        wait(self, lambda: client.call('/rosapi/publishers', topic='/words')[1]['publishers'] == [rospy.get_name()],
             'the publisher')
        self.assertEqual(client.call('/rosapi/publishers', topic='/rosout'), (True, {'publishers': []}))
        self.assertEqual(client.call('/rosapi/nodes'), (True, {'nodes': [rospy.get_name()]}))
        self.assertEqual(client.call('/rosapi/node_details', node=rospy.get_name()), (True, {
            'publishing': ['/words'], 'subscribing': [], 'services': []}))
        typedefs = client.call('/rosapi/message_details', type='geometry_msgs/PointStamped')[1]['typedefs']
        found = {one['type']: one for one in typedefs}
        self.assertEqual(set(found), {'geometry_msgs/PointStamped', 'std_msgs/Header', 'geometry_msgs/Point', 'time'})
        self.assertEqual(found['std_msgs/Header']['fieldtypes'], ['uint32', 'time', 'string'])
        typedefs = client.call('/rosapi/service_response_details', type='std_srvs/Trigger')[1]['typedefs']
        self.assertEqual(typedefs[0]['fieldnames'], ['success', 'message'])
        for kind in ('antigravity/Fly', 'os.path/Join', 'std_msgs/Nothing', '', 'time'):
            self.assertIn('is not installed here', client.call('/rosapi/message_details', type=kind)[1])
        topics, kinds, texts = client.call('/rosapi/topics_and_raw_types')[1].values()
        self.assertEqual(kinds[topics.index('/words')], 'std_msgs/String')
        self.assertIn('string data', texts[topics.index('/words')])

    def test_stamps_are_of_simulated_time_while_time_is_simulated(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(lambda: rospy.has_param('/use_sim_time') and rospy.delete_param('/use_sim_time'))
        clock = sender(self, '/clock', Clock, latch=True)
        clock.publish(rospy.Time(123, 456))
        client = Client(self, Page(self, '_write:=/points'))
        self.assertEqual(client.call('/rosapi/get_time'), (True, {'time': {'secs': 123, 'nsecs': 456}}))
        heard = Heard(self, '/points', PointStamped, waits=False)
        client.send(op='advertise', topic='/points', type='geometry_msgs/PointStamped')
        client.send(op='publish', topic='/points', msg={'point': {'x': 1.0}})
        self.assertEqual(heard.find().header.stamp, rospy.Time(123, 456))
        clock.publish(rospy.Time(124, 0))
        wait(self, lambda: client.call('/rosapi/get_time')[1]['time'] == {'secs': 124, 'nsecs': 0}, 'the next tick')
        rospy.delete_param('/use_sim_time')
        wait(self, lambda: client.call('/rosapi/get_time')[1]['time']['secs'] > 1_000_000_000, 'the wall clock')


class ServiceTest(unittest.TestCase):
    """Services that clients serve."""

    def server(self, page, service='/switch', kind='std_srvs/SetBool'):
        """A client that serves a service."""
        client = Client(self, page)
        client.send(op='advertise_service', service=service, type=kind)
        wait(self, lambda: lookup(service), service)
        return client

    def called(self, service, kind, *arguments):
        """Call a service of ROS in a thread; returns a list that gets the answer or the error."""
        found = []

        def call():
            try:
                found.append(rospy.ServiceProxy(service, kind)(*arguments))
            except rospy.ServiceException as error:
                found.append(str(error))
        thread = threading.Thread(target=call)
        thread.start()
        self.addCleanup(thread.join, TIMEOUT)
        return found

    def asked(self, client):
        """The request that a client gets."""
        return client.find(lambda one: one['op'] == 'call_service')

    def test_nodes_and_clients_call_a_client_and_get_its_answers_and_its_errors(self):
        page = Page(self, '_serve:=/switch', '_call:=/switch')
        server = self.server(page)
        for values, worked, expected in (
                ({'success': True, 'message': 'ä'}, True, SetBoolResponse(True, 'ä')),
                ({}, True, SetBoolResponse()), ('tired', False, 'tired'), ({'success': 5}, True, 'success is 5'),
                ({'message': HALF}, True, 'halves'), ({'no': 1}, True, 'no is no field'), (HALF, False, r'\ud83d')):
            found = self.called('/switch', SetBool, True)
            request = self.asked(server)
            self.assertEqual((request['service'], request['args']), ('/switch', {'data': True}))
            server.send(op='service_response', service='/switch', id=request['id'], values=values, result=worked)
            wait(self, lambda: found, 'the answer')
            (self.assertIn if isinstance(expected, str) else self.assertEqual)(expected, found[0])
            if worked and isinstance(expected, str):
                self.assertIn(expected, server.status())
        caller = Client(self, page)
        caller.send(op='call_service', service='/switch', id='x', args=[False])
        request = self.asked(server)
        self.assertEqual(request['args'], {'data': False})
        server.send(op='service_response', service='/switch', id=request['id'], values={'message': 'off'}, result=True)
        self.assertEqual(caller.find(lambda one: one['op'] == 'service_response'), {
            'op': 'service_response', 'service': '/switch', 'id': 'x', 'result': True,
            'values': {'success': False, 'message': 'off'}})
        server.send(op='service_response', service='/switch', id=request['id'], values={}, result=True)
        self.assertIn('no request with this id', server.status())

    def test_whoever_waits_for_a_client_that_leaves_gets_an_error_and_the_service_ends(self):
        page = Page(self, '_serve:=/switch')
        server = self.server(page)
        found = self.called('/switch', SetBool, True)
        self.asked(server)
        server.close()
        wait(self, lambda: found, 'the error')
        self.assertIn('has gone', found[0])
        wait(self, lambda: not lookup('/switch'), 'the end of the service')
        again = self.server(page)
        again.send(op='unadvertise_service', service='/switch')
        wait(self, lambda: not lookup('/switch'), 'the end of the service')

    def test_a_service_of_another_node_or_client_is_not_taken_over(self):
        self.addCleanup(rospy.Service('/taken', Trigger, lambda _: TriggerResponse(True, 'mine')).shutdown)
        page = Page(self, '_serve:=/taken,/switch', '_call:=/taken')
        client = self.server(page)
        client.send(op='advertise_service', service='/taken', type='std_srvs/Trigger', id='t')
        self.assertIn('is served by another node already', client.status())
        self.assertEqual(client.call('/taken'), (True, {'success': True, 'message': 'mine'}))
        other = Client(self, page)
        other.send(op='advertise_service', service='/switch', type='std_srvs/SetBool')
        self.assertIn('is served by another client already', other.status())
        other.send(op='service_response', service='/switch', id='service_request:/switch:1', values={}, result=True)
        self.assertIn('does not serve', other.status())

    def test_a_service_of_an_unknown_type_is_there_for_clients_of_the_page(self):
        page = Page(self, '_serve:=/odd', '_call:=/odd')
        server, caller = Client(self, page), Client(self, page)
        server.send(op='set_level', level='warning')
        server.send(op='advertise_service', service='/odd', type='nowhere/Odd')
        self.assertIn('only clients of this page can call it', server.status())
        caller.send(op='call_service', service='/odd', id='x', args={'a': [1]})
        request = self.asked(server)
        self.assertEqual(request['args'], {'a': [1]})
        server.send(op='service_response', service='/odd', id=request['id'], values={'b': None}, result=True)
        answer = caller.find(lambda one: one['op'] == 'service_response')
        self.assertEqual((answer['result'], answer['values']), (True, {'b': None}))
        for values in ({'a': float('nan')}, {'a': {'a': [float('inf')]}}, functools.reduce(
                lambda inner, _: {'a': inner}, range(100), {})):
            self.assertIn('must be an object of finite numbers', caller.call('/odd', **{'x': values})[1])
            caller.send(op='call_service', service='/odd', id='y')
            request = self.asked(server)
            server.send(op='service_response', service='/odd', id=request['id'], values=[values], result=True)
            self.assertIn('must be an object of finite', server.status())
            self.assertFalse(caller.find(lambda one: one['op'] == 'service_response')['result'])

    def test_a_call_that_takes_too_long_ends_and_the_next_one_is_made(self):
        self.server(page := Page(self, '_serve:=/switch', '_call:=/switch'))
        caller = Client(self, page)
        caller.send(op='call_service', service='/switch', id='x', timeout=0.2)
        answer = caller.find(lambda one: one['op'] == 'service_response')
        self.assertEqual((answer['result'], answer['values']), (False, '/switch: no answer within 0.2 s'))
        self.assertTrue(caller.call('/rosapi/get_time')[0])


class ParameterTest(unittest.TestCase):
    """Parameters."""

    def test_clients_use_the_parameters_that_the_page_names(self):
        page = Page(self, '_get:=/box,/box/*', '_set:=/box/*', '_token:=secret')
        self.addCleanup(lambda: rospy.has_param('/box') and rospy.delete_param('/box'))
        client = Client(self, page, token='secret')
        self.assertEqual(client.call('/rosapi/get_param', name='/box/a'), (True, {'value': 'null'}))
        self.assertEqual(client.call('/rosapi/get_param', name='/box/a', default='[1]'), (True, {'value': '[1]'}))
        for text in ('"ä"', '1.5', '[1, [true, "x"]]', '{"b": -3}', '-2147483648'):
            self.assertEqual(client.call('/rosapi/set_param', name='box/a', value=text), (True, {}))
            self.assertEqual(client.call('/rosapi/get_param', name='/box/a')[1]['value'].encode().decode(
                'unicode_escape'), text.replace('ä', '\xe4'))
        self.assertEqual(rospy.get_param('/box'), {'a': -2 ** 31})
        self.assertEqual(client.call('/rosapi/has_param', name='/box/a'), (True, {'exists': True}))
        self.assertEqual(client.call('/rosapi/get_param_names'), (True, {'names': ['/box/a']}))
        self.assertEqual(client.call('/rosapi/get_param', name='/box')[1]['value'], '{"a": -2147483648}')
        guest = Client(self, page)
        self.assertTrue(guest.call('/rosapi/get_param', name='/box/a')[0])
        self.assertIn('needs a token', guest.call('/rosapi/set_param', name='/box/a', value='1')[1])
        self.assertEqual(client.call('/rosapi/delete_param', name='/box/a'), (True, {}))
        self.assertIn('there is no parameter', client.call('/rosapi/delete_param', name='/box/a')[1])

    def test_what_cannot_be_a_parameter_is_refused_and_tokens_cannot_be_read(self):
        client = Client(self, Page(self, '_get:=/*/*,/*,/page/token', '_set:=/*/*', '_token:=secret'), token='secret')
        for text in ('{', '', 'null', '[null]', '2147483648', '"\\u0000"', '"\\ud83d"', 'NaN', '[1e999]',
                     '{"a": [null]}'):
            self.assertFalse(client.call('/rosapi/set_param', name='/x/y', value=text)[0], text)
        self.assertFalse(rospy.has_param('/x'))
        for name in ('/page', '/page/token'):
            works, line = client.call('/rosapi/get_param', name=name)
            self.assertFalse(works)
            self.assertIn('belongs to this page', line)
        self.assertFalse(client.call('/rosapi/set_param', name='/page/token', value='"mine"')[0])
        self.addCleanup(rospy.delete_param, '/scalar')
        rospy.set_param('/scalar', 5)
        self.assertIn('/scalar is a parameter, and would be lost',
                      client.call('/rosapi/set_param', name='/scalar/a', value='1')[1])
        self.assertEqual(rospy.get_param('/scalar'), 5)


class FrameTest(unittest.TestCase):
    """Transforms, as tf2_web_republisher offers them."""

    def place(self, parent, child, x):
        """A message of /tf."""
        found = TransformStamped(child_frame_id=child)
        found.header.frame_id = parent
        found.transform.translation.x, found.transform.rotation.w = x, 1.0
        return TFMessage([found])

    def test_a_client_follows_frames_by_the_service_and_by_the_action(self):
        sender(self, '/tf_static', TFMessage, latch=True).publish(self.place('world', 'map', 10.0))
        moving = sender(self, '/tf', TFMessage)
        client = Client(self, Page(self, '_token:=secret'))
        request = {'source_frames': ['/base'], 'target_frame': '/world', 'trans_thres': 0.1, 'rate': 20.0}
        works, answer = client.call('/republish_tfs', **request)
        self.assertTrue(works)
        client.send(op='subscribe', topic=answer['topic_name'])
        client.send(op='subscribe', topic='/tf2_web_republisher/feedback')
        client.send(op='advertise', topic='/tf2_web_republisher/goal', type='tf2_web_republisher/Goal')
        client.send(op='publish', topic='/tf2_web_republisher/goal', msg={'goal_id': {'id': 'g'}, 'goal': request})
        wait(self, moving.get_num_connections, 'the page to listen')
        for x in (1.0, 2.0):
            moving.publish(self.place('map', 'base', x))
            messages = [client.find(lambda one: one['op'] == 'publish') for _ in range(2)]
            found = {one['topic']: one['msg'].get('feedback', one['msg'])['transforms'] for one in messages}
            self.assertEqual(set(found), {answer['topic_name'], '/tf2_web_republisher/feedback'})
            for (transform,) in found.values():
                self.assertEqual((transform['header']['frame_id'], transform['child_frame_id']), ('world', 'base'))
                self.assertEqual(transform['transform']['translation'], {'x': 10.0 + x, 'y': 0.0, 'z': 0.0})
        client.send(op='unsubscribe', topic=answer['topic_name'])
        client.close()
        wait(self, lambda: not moving.get_num_connections(), 'the page to listen no more')


if __name__ == '__main__':
    rospy.init_node('test_page_protocol', disable_rostime=True)
    rostest.rosrun('rumba_viewer', 'page_protocol', '__main__')
