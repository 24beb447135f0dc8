"""The feeds of topics, without ROS and without a network."""

import pytest

from rumba_viewer.page.feeds import Arrival, Demand, Feed


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

    def __call__(self, arrival, name, compression):
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


def test_the_page_itself_can_listen_too_and_gets_what_is_latched():
    feed, encoding, _ = feed_of()
    arrivals(feed, b'1', is_latched=True)
    feed.tick(0.0, encoding)
    got = []
    feed.tap(got.extend)
    arrivals(feed, b'2', b'3')
    assert feed.has_listeners
    feed.tick(0.1, encoding)
    assert [arrival.data for arrival in got] == [b'1', b'2', b'3'] and not encoding.made
    feed.tap(None)
    assert not feed.has_listeners


def test_a_client_gets_one_compression_only_if_it_always_asks_for_it():
    feed, _, (reader,) = feed_of(Demand(compression='cbor'))
    listener = feed._listeners[reader]
    feed.add(reader, 'b', Demand(compression='cbor'), None)
    assert listener.demand.compression == 'cbor'
    feed.add(reader, 'c', Demand(compression='png'), None)
    assert listener.demand.compression == 'none'


def test_each_subscription_of_a_client_begins_with_what_is_latched():
    feed, encoding, (reader,) = feed_of(Demand())
    arrivals(feed, b'1', is_latched=True)
    feed.tick(0.0, encoding)
    feed.add(reader, 'another part of its program', Demand(), encoding)
    assert reader.got == [b':1', b':1']
    feed.add(reader, 'another part of its program', Demand(1.0), encoding)
    assert len(reader.got) == 2


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


def test_after_a_pause_messages_do_not_come_faster_than_they_should():
    feed, encoding, (reader,) = feed_of(Demand(1.0))
    arrivals(feed, b'0')
    feed.tick(0.0, encoding)
    for tick in range(11):  # 1 s with a message each 0.1 s, after 10 s without any
        arrivals(feed, b'%d' % tick)
        feed.tick(10.0 + 0.1 * tick, encoding)
    assert len(reader.got) <= 3


def test_on_average_messages_come_as_often_as_they_should_though_ticks_do_not_fit():
    feed, encoding, (reader,) = feed_of(Demand(0.1))
    for tick in range(101):
        arrivals(feed, b'%d' % tick)
        feed.tick(0.03 * tick, encoding)
    assert 29 <= len(reader.got) <= 32
