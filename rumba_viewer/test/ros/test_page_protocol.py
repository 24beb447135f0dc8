#!/usr/bin/env python3
"""The page beside nodes of ROS, without a simulator: messages, parameters, transforms and time."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import PointStamped, TransformStamped
from pages import HALF, Client, Page
from rosgraph_msgs.msg import Clock
from simulators import Heard, Simulator, wait
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from rumba_msg.msg import CleanActionGoal
from rumba_viewer.page.messages import cbor

GOAL = '/rumba/clean/goal'


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

    def test_the_floor_of_the_simulator_has_carpet_cliffs_and_docks_that_no_topic_shows(self):
        page = Page(self)
        client = Client(self, page)
        self.assertEqual(client.call('/rosapi/floor'), (False, '/rosapi/floor: no simulator says which map it has'))
        Simulator(self, '_map:=apartment')
        floor = client.call('/rosapi/floor')[1]
        self.assertEqual((floor['width'], floor['height'], len(floor['docks'])), (432, 332, 1))
        for layer in ('carpet', 'cliff'):
            self.assertEqual(sum(floor[layer]), 432 * 332)
            self.assertGreater(sum(floor[layer][1::2]), 100)

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
