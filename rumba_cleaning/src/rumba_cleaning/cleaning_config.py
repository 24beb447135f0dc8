"""Settings of a Rumba at work: each with its unit and range."""

import dataclasses

from rumba_sim.model.common.config import section, setting
from rumba_sim.model.settings.robot_config import RobotConfig

DAY = 86400.0  # [s]
APART = 1.001  # times the cleaning speed is the transit speed of slow robots, at least: routes tell them apart by that


@dataclasses.dataclass(frozen=True)
class TimeLimits:
    """When an action that has not ended is given up; a goal may name its own limit."""

    clean: float = setting(DAY, 'for clean, with all its charging; longer on a floor that takes longer', 's', 1.0,
                           1e7)
    dock: float = setting(600.0, 'for dock', 's', 1.0, 1e7)
    undock: float = setting(60.0, 'for undock', 's', 1.0, 1e7)
    go_to: float = setting(600.0, 'for go_to', 's', 1.0, 1e7)


@dataclasses.dataclass(frozen=True)
class CleaningConfig:
    """Speeds, thresholds and limits."""

    strategy: str = setting('boustrophedon', 'cleaning strategy if a goal names none')
    target_coverage: float = setting(0.99, 'share of the reachable floor to sweep if a goal names none',
                                     '0..1', 0.0, 1.0)
    speed: float = setting(0.3, 'while cleaning (Create 3: 0.306 is its safe speed)', 'm/s', 0.02, 10.0)
    transit_speed: float = setting(0.45, 'from one part of the floor to the next, and to the dock (our choice: less '
                                         'than the wheels can, so that the robot can steer)', 'm/s', 0.02, 10.0)
    reserve: float = setting(0.05, 'charge that is kept for the unexpected (our choice)', '0..1', 0.0, 0.5)
    charge_to: float = setting(0.95, 'charge at which cleaning is resumed; the charger tapers above 0.85', '0..1',
                               0.1, 1.0)
    margin: float = setting(0.0, 'that plans keep between robot and walls, so that it touches them less often. Floor '
                                 'that the brush reaches only from closer to a wall, or through passages narrower than '
                                 'the robot and two margins, is not cleaned', 'm', 0.0, 0.5)
    laser: bool = setting(False, 'whether to drive around what the laser sees and the map does not show; without, the '
                                 'robot finds it by its bumper')
    cleaning_time: float = setting(2700.0, 'for which a robot without a map cleans, without the time to charge and '
                                           'to look for the dock (our choice)', 's', 1.0, 1e7)
    planning_rounds: int = setting(8, 'in which a route is improved by rehearsal before the robot sets off, at most; '
                                      'fewer plan faster, and lead to longer routes; large floors get fewer', '', 0,
                                   20)
    time_limit: TimeLimits = section(TimeLimits, 'when an action is given up; simulated time')


def attainable(config: CleaningConfig, robot: RobotConfig) -> CleaningConfig:
    """The same settings, with no speed above the highest one of a robot."""
    fastest = robot.drive.max_speed
    speed = min(config.speed, fastest)
    transit = config.transit_speed
    if transit > fastest:
        transit = max(fastest, speed * APART)
    return dataclasses.replace(config, speed=speed, transit_speed=transit)
