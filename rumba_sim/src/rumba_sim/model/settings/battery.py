"""The battery: 12 NiMH cells, discharged by the loads and charged on the dock."""

import dataclasses
import math

from rumba_sim.model.common.config import setting
from rumba_sim.model.kernel.ticking.energy import battery_current, charge_after

CELLS = 12
# Pairs of the state of charge [0..1] and the rest voltage [V] of one NiMH cell: a flat middle part and a knee at each
# end. The pack has its nominal 14.4 V at 10 % and about 18 V at the end of a charge (iRobot Roomba 600 Open Interface
# specification; data of battery makers).
REST_VOLTAGE = ((0.0, 1.00), (0.1, 1.20), (0.5, 1.27), (0.9, 1.34), (1.0, 1.47))
HOUR = 3600.0  # [s]
ROUNDING = 1e-6  # [%] so that 29 %, converted to ampere-hours and back, does not become 30 %


@dataclasses.dataclass(frozen=True)
class BatteryConfig:
    """The figures of a battery and its charger."""

    capacity: float = setting(2.7, 'charge of a full battery (makers: 2.7 to 3.0)', 'Ah', low=0.01, high=1000.0)
    resistance: float = setting(0.25, 'inner resistance of the pack, about 20 mOhm per cell', 'Ohm', low=0.0, high=10.0)
    idle_current: float = setting(0.19, 'current of the electronics alone (readings of owners)', 'A',
                                  low=0.0, high=100.0)
    brush_current: float = setting(0.5, 'current of brushes and vacuum while cleaning (published measurements)', 'A',
                                   low=0.0, high=100.0)
    wheel_current_slow: float = setting(0.3, 'current of both wheels at the lowest speed (published measurements)', 'A',
                                        low=0.0, high=100.0)
    wheel_current: float = setting(1.0, 'current of both wheels at wheel_speed (published measurements)', 'A',
                                   low=0.0, high=100.0)
    wheel_speed: float = setting(0.3, 'usual speed while cleaning (Create 3: 0.306)', 'm/s', low=0.01, high=10.0)
    charge_current: float = setting(1.25, 'current of the charger before the taper; charges the battery in about 3 h',
                                    'A', low=0.001, high=100.0)
    trickle_current: float = setting(0.06, 'current of the charger at the end of the taper', 'A', low=0.001, high=100.0)
    taper_start: float = setting(0.85, 'state of charge at which the current of the charger begins to fall', '0..1',
                                 low=0.0, high=0.99)
    drain: float = setting(1.0, 'how many times faster than a real battery this one discharges and charges',
                           low=0.0, high=1e4)

    @property
    def cleaning_current(self) -> float:
        """Of all loads while a robot cleans at its usual speed [A]."""
        return self.idle_current + self.wheel_current + self.brush_current

    def discharge_rate(self, current: float) -> float:
        """How fast the state of charge falls with a current [A]: [1/s]."""
        return current * self.drain / (self.capacity * HOUR)


class Battery:
    """State of one battery, advanced by `step`.

    Attributes:
        config: figures of the battery.
        charge: charge that is left [Ah], 0 to `config.capacity`.
        current: current through the terminals in the last step [A], negative while discharging.
    """

    def __init__(self, config: BatteryConfig, state_of_charge: float = 1.0, current: float = 0.0) -> None:
        """Start with a state of charge [0..1] and the current [A] of the step before."""
        self.config = config
        self.charge = config.capacity * state_of_charge
        self.current = current

    def step(self, dt: float, load: float, on_dock: bool = False) -> None:
        """Simulate some time.

        On the dock the charger supplies the loads in addition to charging the battery.

        Args:
            dt: duration [s], not negative.
            load: sum of the loads [A], not negative.
            on_dock: whether the charging contacts are closed.
        """
        self.current = battery_current(self.charge, self.config, load, on_dock)
        self.charge = charge_after(self.charge, self.config, self.current, dt)

    @property
    def state_of_charge(self) -> float:
        """Charge that is left as a share of the capacity [0..1]."""
        return self.charge / self.config.capacity

    @property
    def percentage(self) -> int:
        """Charge that is left [%], 0 to 100, rounded up: 0 means empty."""
        return math.ceil(100.0 * self.state_of_charge - ROUNDING)

    @property
    def voltage(self) -> float:
        """Voltage at the terminals [V]: the rest voltage less the drop across the inner resistance."""
        return CELLS * _rest_voltage(self.state_of_charge) + self.current * self.config.resistance


def _rest_voltage(state_of_charge: float) -> float:
    """Rest voltage of one cell [V] at a state of charge [0..1], interpolated linearly in REST_VOLTAGE."""
    for (left, low), (right, high) in zip(REST_VOLTAGE, REST_VOLTAGE[1:]):
        if state_of_charge <= right:
            return low + (high - low) * (state_of_charge - left) / (right - left)
    return REST_VOLTAGE[-1][1]
