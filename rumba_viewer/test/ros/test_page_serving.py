#!/usr/bin/env python3
"""Services that clients of the page serve, beside nodes of ROS."""

import functools
import threading
import unittest

import rospy
import rostest
from pages import HALF, Client, Page
from simulators import TIMEOUT, lookup, wait
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse


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


if __name__ == '__main__':
    rospy.init_node('test_page_serving', disable_rostime=True)
    rostest.rosrun('rumba_viewer', 'page_serving', '__main__')
