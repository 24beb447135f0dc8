"""Transforms for clients in the way of tf2_web_republisher; without ROS."""

import math

import numpy as np
import pytest
from pytest import approx

from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.transforms import Transform, Tree, inverse, product
from rumba_viewer.page.republishing import CANCEL, FEEDBACK, GOAL, MOST_WANTED, RESULT, SLICE, STATUS, Republisher


def turned(angle, axis=(0.0, 0.0, 1.0), shift=(0.0, 0.0, 0.0)):
    """A frame that is turned by an angle [rad] about a unit vector, and shifted [m]."""
    sine = math.sin(angle / 2)
    return Transform(shift, (*(sine * one for one in axis), math.cos(angle / 2)))


def matrix(transform):
    """The transform as a matrix, by the formula of Rodrigues, which shares nothing with the products of quaternions."""
    *vector, w = transform.turn
    cross = np.cross(np.eye(3), vector)
    found = np.eye(4)
    found[:3, :3] = np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross
    found[:3, 3] = transform.shift
    return found


ONE = turned(0.7, (0.6, 0.0, 0.8), (1.0, -2.0, 0.5))
OTHER = turned(-2.1, (0.0, 1.0, 0.0), (-0.3, 4.0, 2.0))


def test_products_and_inverses_are_those_of_matrices():
    assert matrix(product(ONE, OTHER)) == approx(matrix(ONE) @ matrix(OTHER))
    assert matrix(inverse(ONE)) == approx(np.linalg.inv(matrix(ONE)))


def test_a_frame_is_found_across_the_tree_and_its_newest_place_counts():
    tree = Tree()
    tree.put('map', 'odom', OTHER)
    tree.put('map', 'odom', ONE)
    tree.put('odom', 'base', OTHER)
    tree.put('map', 'dock', ONE)
    assert matrix(tree.between('map', 'base')) == approx(matrix(ONE) @ matrix(OTHER))
    assert matrix(tree.between('base', 'dock')) == approx(np.linalg.inv(matrix(OTHER)))
    assert tree.between('world', 'world') == Transform() and tree.between('world', 'map') is None
    tree.put('base', 'map', ONE)  # a loop
    assert tree.between('world', 'base') is None


class Followed:
    """A republisher, and what it sends."""

    def __init__(self):
        self.sent, self.time = [], 0.0
        self.republisher = Republisher(lambda *what: self.sent.append(what), lambda: self.time)
        self.republisher.tree.put('map', 'base', Transform((1.0, 2.0, 0.0)))

    def ask(self, client='me', **values):
        """Ask by the service, and listen to the topic that it names."""
        request = {'source_frames': ['/base'], 'target_frame': '/map', 'angular_thres': 0.1, 'trans_thres': 0.05,
                   'rate': 10.0, **values}
        topic = self.republisher.answer(client, request)['topic_name']
        self.republisher.subscribe(client, topic, 'a', Demand(name=topic))
        return topic

    def heard(self, now):
        """What is sent at a time [s]: client, topic and x of each frame."""
        del self.sent[:]
        self.republisher.tick(now)
        return [(client, topic, [one['transform']['translation']['x'] for one in values['transforms']])
                for client, topic, _, values in self.sent]


def test_a_client_hears_of_a_frame_at_first_and_whenever_it_has_moved_or_turned():
    followed = Followed()
    topic, put = followed.ask(), followed.republisher.tree.put
    assert followed.heard(0.0) == [('me', topic, [1.0])]
    _, _, demand, values = followed.sent[0]
    assert demand.name == topic and values == {'transforms': [{
        'header': {'seq': 0, 'stamp': {'secs': 0, 'nsecs': 0}, 'frame_id': 'map'}, 'child_frame_id': 'base',
        'transform': {'translation': {'x': 1.0, 'y': 2.0, 'z': 0.0},
                      'rotation': {'x': 0.0, 'y': 0.0, 'z': 0.0, 'w': 1.0}}}]}
    assert '-0.0' not in str(values)
    put('map', 'base', Transform((1.04, 2.0, 0.0)))
    assert followed.heard(0.1) == []
    put('map', 'base', Transform((1.06, 2.0, 0.0)))
    assert followed.heard(0.2) == [('me', topic, [1.06])]
    put('map', 'base', turned(0.09, shift=(1.06, 2.0, 0.0)))
    assert followed.heard(0.3) == []
    put('map', 'base', turned(-0.11, shift=(1.06, 2.0, 0.0)))
    assert followed.heard(0.4) == [('me', topic, [1.06])]


def test_no_message_comes_before_its_time_and_a_new_listener_hears_all():
    followed = Followed()
    topic = followed.ask(rate=2.0)
    assert followed.heard(0.0)
    followed.republisher.tree.put('map', 'base', Transform((9.0, 0.0, 0.0)))
    assert not followed.heard(0.2) and followed.heard(0.5)
    followed.republisher.subscribe('me', topic, 'b', Demand(name=topic))
    assert followed.heard(1.0) == [('me', topic, [9.0])]


def test_what_is_unknown_waits_and_ends_with_its_listener():
    followed = Followed()
    topic = followed.ask(source_frames=['base', 'hand'])
    assert followed.heard(0.0) == [('me', topic, [1.0])]
    followed.republisher.tree.put('base', 'hand', Transform((0.5, 0.0, 0.0)))
    assert followed.heard(0.1) == [('me', topic, [1.5])]
    followed.republisher.unsubscribe('me', topic, 'a')
    assert not followed.republisher.is_busy


def test_a_goal_is_followed_until_it_is_cancelled_and_others_do_not_hear_it():
    followed = Followed()
    republisher = followed.republisher
    for client in ('me', 'you'):
        for topic in (FEEDBACK, STATUS, RESULT):
            republisher.subscribe(client, topic, '', Demand(name=topic))
    goal = {'source_frames': ['base'], 'target_frame': 'map'}
    republisher.publish('me', GOAL, {'goal_id': {'id': 'g1'}, 'goal': goal})
    assert followed.sent[-1][:2] == ('me', STATUS)
    assert [one['goal_id']['id'] for one in followed.sent[-1][3]['status_list']] == ['g1']
    del followed.sent[:]
    republisher.tick(0.0)
    [(client, topic, _, values)] = followed.sent
    assert (client, topic) == ('me', FEEDBACK) and values['status']['goal_id']['id'] == 'g1'
    assert values['feedback']['transforms'][0]['child_frame_id'] == 'base'
    republisher.publish('you', CANCEL, {'id': 'g1'})
    assert republisher.is_busy
    del followed.sent[:]
    republisher.publish('me', CANCEL, {'id': 'g1'})
    assert [one[:2] for one in followed.sent] == [('me', RESULT), ('me', STATUS)] and not republisher.is_busy
    assert followed.sent[0][3]['status']['status'] == 2


@pytest.mark.parametrize('values, words', [
    ({'source_frames': 'base'}, 'source_frames is'), ({'source_frames': 1000 * ['a']}, 'at most 128 frames'),
    ({'source_frames': [5]}, 'source_frames: 5 is no frame'), ({'source_frames': ['/']}, 'is no frame'),
    ({'target_frame': None}, 'target_frame: None is no frame'), ({'rate': -1}, 'rate is -1'),
    ({'trans_thres': 'x'}, 'trans_thres is'), ({'angular_thres': math.nan}, 'angular_thres is nan')])
def test_a_request_that_makes_no_sense_is_refused(values, words):
    with pytest.raises(Refusal, match=words):
        Followed().ask(**values)


@pytest.mark.parametrize('topic, values', [(GOAL, 5), (GOAL, {}), (GOAL, {'goal_id': 3}), (CANCEL, []),
                                           (CANCEL, {'id': 5})])
def test_a_goal_that_makes_no_sense_is_refused(topic, values):
    with pytest.raises(Refusal, match='must be'):
        Followed().republisher.publish('me', topic, values)


def test_a_client_follows_a_bounded_number_and_only_what_is_its_own():
    followed = Followed()
    topics = [followed.ask() for _ in range(MOST_WANTED + 1)]
    assert [topic for _, topic, _ in followed.heard(0.0)] == topics[1:]
    with pytest.raises(Refusal, match='does not belong to this client'):
        followed.republisher.subscribe('you', topics[-1], '', Demand())
    followed.republisher.leave('me')
    assert not followed.republisher.is_busy


def test_a_tick_is_short_and_the_next_one_begins_with_those_who_have_waited():
    followed = Followed()

    def slow(client, *_):
        followed.sent.append(client)
        followed.time += 0.6 * SLICE
    followed.republisher._send = slow
    for number in range(5):
        followed.ask(client=number)
    for expected in ([0, 1], [2, 3], [4]):
        del followed.sent[:]
        followed.republisher.tick(0.0)
        assert followed.sent == expected
