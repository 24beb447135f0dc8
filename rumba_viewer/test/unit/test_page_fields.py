"""Every type of field that a definition of a message can have, from ROS to a client and back."""

import json
import unittest.mock

import pytest

pytest.importorskip('genpy', reason='needs the messages of ROS')

from genpy import Duration, Time  # noqa: E402
from genpy.dynamic import generate_dynamic  # noqa: E402

from rumba_viewer.page.feeds import Arrival  # noqa: E402
from rumba_viewer.page.messages.errors import Refusal  # noqa: E402
from rumba_viewer.page.messages.filling import Filler, serialised  # noqa: E402
from rumba_viewer.ros.page.rosapi import types  # noqa: E402
from rumba_viewer.ros.page.wire import Encoder  # noqa: E402

INTEGERS = {f'{sign}int{bits}': [-(1 << bits - 1), 7, (1 << bits - 1) - 1] if not sign else [0, 7, (1 << bits) - 1]
            for sign in ('', 'u') for bits in (8, 16, 32, 64)}
# Of each type, three values as Python has them, and as JSON has them.
VALUES = {
    **{base: (values, values) for base, values in INTEGERS.items()},
    'byte': ([-128, 7, 127], [-128, 7, 127]), 'char': ([0, 7, 255], [0, 7, 255]),
    'bool': ([True, False, True], [True, False, True]),
    'float32': ([1.5, float('inf'), -0.25], [1.5, None, -0.25]),
    'float64': ([0.1, float('-inf'), -2e300], [0.1, None, -2e300]),
    'string': (['', 'ä"\\\n', '/x'], ['', 'ä"\\\n', '/x']),
    'time': ([Time(0, 1), Time(5, 6), Time(2 ** 32 - 1, 999_999_999)],
             [{'secs': 0, 'nsecs': 1}, {'secs': 5, 'nsecs': 6}, {'secs': 2 ** 32 - 1, 'nsecs': 999_999_999}]),
    'duration': ([Duration(0, 1), Duration(-5, 6), Duration(2 ** 31 - 1, 0)],
                 [{'secs': 0, 'nsecs': 1}, {'secs': -5, 'nsecs': 6}, {'secs': 2 ** 31 - 1, 'nsecs': 0}])}
BASE64 = {'uint8': 'AAf/', 'char': 'AAf/'}
INNER, LINE = 'int16 number\nbool[] bits\n', 80 * '='
PARTS = (f'\n{LINE}\nMSG: page_test/Inner\n{INNER}'
         f'{LINE}\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n')


def made(definition):
    """The class of a message by its definition."""
    return generate_dynamic('page_test/Outer', definition + PARTS)['page_test/Outer']


def shown(message):
    """The values that a client gets of a message, by all of the way that it takes."""
    arrival = Arrival(serialised(message), message._type, message._md5sum, '/node', False)
    with unittest.mock.patch.object(types, 'of_message', lambda _: type(message)):
        frame = Encoder(pytest.fail, lambda: (0, 0)).encode(arrival, '/t', 'none')
    return json.loads(frame[frame.index(b'{'):].decode())['msg']


def filled(kind, values):
    """A message with values of a client."""
    inner = generate_dynamic('page_test/Inner', INNER)['page_test/Inner']
    find = {**types.NOT_MESSAGES, 'page_test/Inner': inner}.get
    return Filler(find, lambda: (12, 34)).fill(kind(), values)


def back(kind, values):
    """What a client sends, as a node gets it and shows it to another client."""
    return shown(filled(kind, values))


@pytest.mark.parametrize('base', VALUES)
def test_every_type_goes_both_ways_alone_and_in_lists(base):
    kind = made(f'{base} single\n{base}[] many\n{base}[3] three\n{base}[] none')
    values, expected = VALUES[base]
    for value, one in zip(values, expected):
        many = BASE64.get(base, expected)
        message = kind(single=value, many=values, three=values, none=[])
        if base in BASE64:
            message.many = message.three = bytes(values)
        wanted = {'single': one, 'many': many, 'three': many, 'none': '' if base in BASE64 else []}
        assert shown(message) == wanted
        assert back(kind, wanted) == wanted
        assert back(kind, {**wanted, 'many': expected, 'three': expected}) == wanted


def test_messages_within_messages_and_headers_go_both_ways():
    kind = made('Header header\nInner one\nInner[] many\nInner[2] two')
    inner = {'number': -3, 'bits': [True, False]}
    wanted = {'header': {'seq': 4, 'stamp': {'secs': 5, 'nsecs': 6}, 'frame_id': 'map'}, 'one': inner,
              'many': [inner, {'number': 0, 'bits': []}], 'two': [inner, inner]}
    assert back(kind, wanted) == wanted
    assert back(kind, {})['header'] == {'seq': 0, 'stamp': {'secs': 12, 'nsecs': 34}, 'frame_id': ''}
    assert back(kind, {'many': [{}]})['many'] == [{'number': 0, 'bits': []}]


@pytest.mark.parametrize('base, values', [(base, [low - 1, high + 1]) for base, (low, _, high) in INTEGERS.items()]
                         + [('byte', [-129, 128]), ('char', [-1, 256]), ('bool', [0, 'true', None]), ('string', [1]),
                            ('float32', [3.5e38, '1']), ('float64', [10 ** 400, True])])
def test_what_a_type_cannot_hold_is_refused_alone_and_in_lists(base, values):
    kind = made(f'{base} single\n{base}[] many\n{base}[3] three')
    for value in values:
        for given in ({'single': value}, {'many': [value]}, {'three': 3 * [value]}):
            with pytest.raises(Refusal, match=f'^{next(iter(given))}'):
                filled(kind, given)


@pytest.mark.parametrize('values, seconds', [
    ({'secs': 5, 'nsecs': 6}, 5_000_000_006), ({'sec': 5, 'nanosec': 6}, 5_000_000_006), ({'sec': 5}, 5_000_000_000),
    ({'nanosec': 6}, 6), ({}, 0), ({'secs': 4, 'nsecs': 1_000_000_006}, 5_000_000_006),
    ({'secs': 2 ** 31}, 2 ** 31 * 1_000_000_000), ({'secs': 1, 'nsecs': -1}, 999_999_999)])
def test_a_time_is_taken_by_the_names_of_ros_1_and_of_ros_2(values, seconds):
    assert filled(made('time stamp'), {'stamp': values}).stamp.to_nsec() == seconds


@pytest.mark.parametrize('base, value', [
    ('time', {'secs': -1, 'nsecs': 0}), ('time', {'secs': 2 ** 32}), ('time', {'nsecs': -1}),
    ('time', {'sec': 5, 'nsecs': 6}), ('time', {'seconds': 5}), ('time', {'secs': 1.5}), ('time', {'secs': None}),
    ('time', 5), ('time', [5, 6]), ('time', None), ('time', {'secs': 10 ** 400}),
    ('duration', {'secs': 2 ** 31}), ('duration', {'secs': -2 ** 31, 'nsecs': -1}), ('duration', {'secs': True})])
def test_a_time_that_ros_cannot_hold_is_refused_and_none_becomes_zero(base, value):
    with pytest.raises(Refusal, match='^stamp is '):
        filled(made(f'{base} stamp'), {'stamp': value})
    with pytest.raises(Refusal, match=r'^stamps\.0 is '):
        filled(made(f'{base}[] stamps'), {'stamps': [value]})


@pytest.mark.parametrize('text', ['\ud83d', 'half \udc00 of it'])
def test_half_a_character_is_refused(text):
    for definition, values in (('string text', {'text': text}), ('string[] texts', {'texts': ['', text]})):
        with pytest.raises(Refusal, match='must be a text without halves of characters'):
            filled(made(definition), values)


def test_whatever_else_a_message_class_cannot_serialise_is_refused_in_one_line():
    message = made('int8 number')(number='x')
    with pytest.raises(Refusal, match='^msg is no page_test/Outer: SerializationError: '):
        serialised(message)
