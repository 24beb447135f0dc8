"""The bytes of the packet are those of the specification."""

import struct

import pytest

from lists_and_bytes.packets import Battery, decode, encode

BATTERY = Battery(2, 16.384, -0.69, -5, 1.3, 2.7)
PACKET = b'\x02\x40\x00\xfd\x4e\xfb\x05\x14\x0a\x8c'


def test_each_value_has_its_position_and_unit():
    assert encode(BATTERY) == PACKET


def test_decode_inverts_encode():
    assert decode(PACKET) == BATTERY


def test_values_and_packets_that_do_not_fit_are_refused():
    with pytest.raises(struct.error, match='requires|format'):
        encode(BATTERY._replace(voltage=66.0))
    with pytest.raises(struct.error, match='requires a buffer of 10 bytes'):
        decode(PACKET[:-1])
