"""Sensor packet 3 of a Roomba: its battery, in ten bytes (iRobot Roomba 600 Open Interface specification)."""

import struct
from typing import NamedTuple

# Most significant byte first: charging state, voltage [mV], current [mA], temperature [deg C], charge, capacity [mAh].
LAYOUT = struct.Struct('>BHhbHH')


class Battery(NamedTuple):
    """The contents of the packet."""

    charging_state: int  # 0: not charging, 2: charging
    voltage: float  # [V]
    current: float  # [A], negative while discharging
    temperature: int  # [deg C]
    charge: float  # [Ah]
    capacity: float  # [Ah]


def encode(battery: Battery) -> bytes:
    """Return the packet; raise struct.error if a value does not fit into its bytes."""
    return LAYOUT.pack(battery.charging_state, round(1000 * battery.voltage), round(1000 * battery.current),
                       battery.temperature, round(1000 * battery.charge), round(1000 * battery.capacity))


def decode(packet: bytes) -> Battery:
    """Return the contents of a packet; raise struct.error if its length is wrong."""
    state, voltage, current, temperature, charge, capacity = LAYOUT.unpack(packet)
    return Battery(state, voltage / 1000, current / 1000, temperature, charge / 1000, capacity / 1000)
