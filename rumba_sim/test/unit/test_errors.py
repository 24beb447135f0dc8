"""Messages of errors: one short line, whatever they quote."""

import pickle
import time

import pytest

from rumba_sim.model.common.errors import LONGEST, LONGEST_QUOTE, MapError, one_line, quoted


@pytest.mark.parametrize('value, text', [
    ('plain', "'plain'"),
    ("it's", '"it\'s"'),
    ('\x1b[31mred\n\u202e', r"'\x1b[31mred\n\u202e'"),
    (0.5, '0.5'), (True, 'True'), (None, 'None'), (-17, '-17'),
    ([1, [2, [3]]], '[1, [2, [...]]]'),
    (list(range(9)), '[0, 1, 2, 3, 4, 5, ...]'),
    ({'x': [1.0]}, "{'x': [1.0]}"),
    (10 ** 400, 'a number of 400 digits'), (-(1 << 20_000_000), 'a number of 6020600 digits'),
], ids=lambda value: None if isinstance(value, str) else type(value).__name__)
def test_a_value_is_quoted_as_python_writes_it_but_short(value, text):
    assert quoted(value) == text


def test_a_value_that_is_large_or_deep_is_quoted_in_no_time():
    laughs = ['ha' * 1000]
    for _ in range(30):
        laughs = [laughs] * 9
    loop = []
    loop.append(loop)
    before = time.process_time()
    for value in (laughs, loop, 'x' * 3_000_000, '\0' * 3_000_000, {'key' * 99: laughs}, b'\x1b' * 3_000_000, {3: {4}}):
        assert len(quoted(value)) <= LONGEST_QUOTE
        assert quoted(value).isprintable()
    assert time.process_time() - before < 0.5


def test_a_long_line_keeps_its_beginning_and_its_end():
    assert one_line('wrong: ' + 'x' * 400 + ': must be right', 48) == 'wrong: ' + 'x' * 22 + '...x: must be right'
    assert one_line('right: ' + 'x' * 41, 48) == 'right: ' + 'x' * 41


@pytest.mark.parametrize('text', ['a' * 5_000_000, '\x1b' * 5_000_000, 'é' * 301, '\ud800' * 299],
                         ids=['long', 'control characters', 'a little too long', 'surrogates'])
def test_a_message_is_bounded_and_has_no_control_characters(text):
    message = str(MapError(text))
    assert len(message) <= LONGEST and message.isprintable() and message.encode()
    assert str(pickle.loads(pickle.dumps(MapError(text)))) == message
