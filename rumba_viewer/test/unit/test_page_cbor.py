"""CBOR, against the examples of the specifications, and messages in it."""

import math

import numpy as np
import pytest

from rumba_viewer.page.messages.cbor import encoded


@pytest.mark.parametrize('value, data', [  # RFC 8949, appendix A
    (0, '00'), (23, '17'), (24, '1818'), (1000, '1903e8'), (1000000, '1a000f4240'),
    (18446744073709551615, '1bffffffffffffffff'), (-1, '20'), (-1000, '3903e7'), (-(1 << 63), '3b7fffffffffffffff'),
    (1.1, 'fb3ff199999999999a'), (-math.inf, 'fbfff0000000000000'), (False, 'f4'), (True, 'f5'), (None, 'f6'),
    ('', '60'), ('ü', '62c3bc'), (b'', '40'), (b'\x01\x02', '420102'), ([], '80'), ([1, [2, 3]], '8201820203'),
    ({'a': 1, 'b': [2, 3]}, 'a26161016162820203'), (25 * [0], '9819' + 25 * '00')])
def test_values_are_those_of_the_specification(value, data):
    assert encoded(value).hex() == data


@pytest.mark.parametrize('kind, tag, items', [  # RFC 8746, section 2.1
    ('uint8', 64, '01ff'), ('uint16', 69, '0100ff00'), ('uint32', 70, '01000000ff000000'),
    ('uint64', 71, '0100000000000000ff00000000000000'), ('int8', 72, '01ff'), ('int16', 77, '0100ff00'),
    ('int32', 78, '01000000ff000000'), ('int64', 79, '0100000000000000ff00000000000000'),
    ('float32', 85, '0000803f00007f43'), ('float64', 86, '000000000000f03f0000000000e06f40')])
@pytest.mark.parametrize('order', '<>')
def test_arrays_of_numbers_are_packed_with_the_lowest_byte_first(kind, tag, items, order):
    values = np.array([1, -1 if kind == 'int8' else 255], np.dtype(kind).newbyteorder(order))
    assert encoded(values).hex() == f'd8{tag:02x}{0x40 + len(items) // 2:02x}{items}'
