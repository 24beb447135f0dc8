"""How a Rumba goes about its work: every figure with its unit and range."""

import dataclasses

from rumba_sim.model.config import section, setting

DAY = 86400.0  # [s]


@dataclasses.dataclass(frozen=True)
class TimeLimits:
    """When an action that came to no end is given up; a goal may name its own."""

    clean: float = setting(DAY, 'for clean, with all its charging', 's', 1.0, 1e7)
    dock: float = setting(600.0, 'for dock', 's', 1.0, 1e7)
    undock: float = setting(60.0, 'for undock', 's', 1.0, 1e7)
    go_to: float = setting(600.0, 'for go_to', 's', 1.0, 1e7)


@dataclasses.dataclass(frozen=True)
class CleaningConfig:
    """Speeds, thresholds and limits."""

    strategy: str = setting('boustrophedon', 'cleaning strategy of a goal that names none')
    target_coverage: float = setting(0.99, 'share of the reachable floor after which a goal that names none ends',
                                     '0..1', 0.0, 1.0)
    speed: float = setting(0.3, 'while cleaning (Create 3: 0.306 is its safe speed)', 'm/s', 0.02, 10.0)
    transit_speed: float = setting(0.45, 'on the way from one place to another', 'm/s', 0.02, 10.0)
    reserve: float = setting(0.05, 'charge that no plan counts on', '0..1', 0.0, 0.5)
    charge_to: float = setting(0.95, 'charge at which cleaning is resumed; the charger tapers above 0.85', '0..1',
                               0.1, 1.0)
    time_limit: TimeLimits = section(TimeLimits, 'when an action is given up; simulated time')
