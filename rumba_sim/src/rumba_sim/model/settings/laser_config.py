"""The laser scanner of a Rumba, and those that people buy.

Sources, by model. Limits such as +-10 mm are taken for two standard deviations, since no maker says what they are.
    rplidar_a1: Slamtec, RPLIDAR A1 Introduction and Datasheet, model A1M8 (rev. 3.0 of 2020-10-15: 0.15 to 12 m, a
        resolution below 1 % of the distance, which we take for the standard deviation, 1 degree and 360 beams at
        5.5 Hz); the driver rplidar_ros (+inf for no echo, quarters of a millimetre, from straight back on).
    lds01: ROBOTIS e-Manual, TurtleBot3, appendix LDS-01 (120 to 3500 mm; accuracy +-15 mm below 0.5 m and +-5 % beyond,
        of that precision +-10 mm and +-3.5 %; 1 degree, 300 rpm); the driver hls_lfcd_lds_driver (0.0 for no echo,
        millimetres, from straight ahead on).
    urg04lx: Hokuyo, URG-04LX specification (20 to 5600 mm, guaranteed to 4095 mm; +-10 mm to 1 m and +-1 % beyond; a
        beam of 40 mm at 4 m; 10 Hz) and SCIP 2.0, C-42-03320B (steps 44 to 725 of 1024, 384 is ahead; millimetres, 0
        for no echo, which hokuyo_node and logs keep, while urg_node makes it NaN); lone beams that are missed are
        0.3 % of those of a log of one (exp2 of BreezySLAM).
    tim561: SICK, TiM55x/TiM56x operating instructions 8015886 of 2014-08-27 (statistical error 20 mm, systematic
        +-60 mm, pulses of at most 5 ns) and data sheet of the TiM561 (0.05 to 10 m, 8 m at a remission of 10 %, 270
        degrees, 0.33 degrees, 15 Hz); the driver sick_tim (+inf for no echo, millimetres).
    camera: a depth camera as a laser, by depthimage_to_laserscan (its defaults: 0.45 to 10 m; NaN for no depth):
        Microsoft Kinect (640 columns in 57 degrees, 30 Hz, millimetres); its random error is 4 cm at 5 m (Khoshelham
        and Elberink, Accuracy and resolution of Kinect depth data, 2012), taken to grow with the range.
"""

import dataclasses
import functools
import math
from typing import Any, Dict, Tuple

from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import TURN

ANY = 1000.0  # [m] a range, and [Hz] a rate, that no laser exceeds
IDEAL = 'ideal'
MODELS: Dict[str, Dict[str, Any]] = {
    IDEAL: {},
    'rplidar_a1': {
        'rate': 5.5, 'range_min': 0.15, 'range_max': 12.0, 'nothing': 'inf', 'noise': 0.005, 'relative_noise': 0.01,
        'resolution': 0.00025, 'dropouts': 0.02, 'beam_width': TURN / 720},
    'lds01': {
        'first_angle': 0.0, 'rate': 5.0, 'range_max': 3.5, 'nothing': 'zero', 'noise': 0.005, 'relative_noise': 0.0175,
        'bias': 0.0056, 'relative_bias': 0.0179, 'resolution': 0.001, 'dropouts': 0.02, 'beam_width': TURN / 720},
    'urg04lx': {
        'beams': 682, 'per_turn': 1024, 'first_angle': (44 - 384) * TURN / 1024, 'rate': 10.0, 'range_min': 0.02,
        'range_max': 5.6, 'sure_range': 4.095, 'nothing': 'zero', 'noise': 0.005, 'relative_noise': 0.005,
        'resolution': 0.001, 'dropouts': 0.003, 'beam_width': 0.01},
    'tim561': {
        'beams': 811, 'per_turn': 1080, 'first_angle': -0.75 * math.pi, 'rate': 15.0, 'range_min': 0.05,
        'range_max': 10.0, 'sure_range': 8.0, 'nothing': 'inf', 'noise': 0.02, 'bias': 0.03, 'resolution': 0.001,
        'dropouts': 0.003, 'beam_width': TURN / 1080, 'mixing_depth': 0.75},
    'camera': {
        'beams': 640, 'per_turn': 4042, 'first_angle': -319.5 * TURN / 4042, 'rate': 30.0, 'range_min': 0.45,
        'range_max': 10.0, 'nothing': 'nan', 'noise': 0.005, 'relative_noise': 0.008, 'resolution': 0.001}}
# What is told if there is no echo, and for less than range_min [m].
NOTHING = {'rep117': (math.inf, -math.inf), 'inf': (math.inf, math.inf), 'zero': (0.0, 0.0),
           'nan': (math.nan, math.nan)}


@dataclasses.dataclass(frozen=True)
class LaserConfig:
    """A laser scanner on top (no Roomba of the 600 series has one).

    `from_mapping(LaserConfig, {'model': 'lds01', 'noise': 0.0}, ...)` makes that of a model, with other noise.
    """

    model: str = setting(IDEAL, 'sets all that depends on the model; what is given beside it overrides that',
                         presets=MODELS)
    beams: int = setting(360, 'number of beams', '', 1, 10000)
    per_turn: int = setting(0, 'so many beams would be a full turn: the angle from beam to beam; 0: as many as there '
                               'are', '', 0, 100000)
    first_angle: float = setting(-math.pi, 'of the first beam, frame of the laser', 'rad', -TURN, TURN)
    clockwise: bool = setting(False, 'whether the angles of the next beams are smaller')
    rate: float = setting(ANY, 'scans per second, at most; the largest divisor of the step rate up to it counts', 'Hz',
                          1.0, ANY)
    range_min: float = setting(0.12, 'shorter ranges are reported as nothing says', 'm', 0.0, 10.0)
    range_max: float = setting(8.0, 'longer ranges are reported as nothing says', 'm', 0.1, ANY)
    sure_range: float = setting(ANY, 'beyond it, the farther the more echoes are missing, until all are at range_max',
                                'm', 0.0, ANY)
    nothing: str = setting('rep117', 'what is reported instead of a range: rep117 (+inf if there is no echo, -inf for '
                                     'less than range_min), or in both cases inf, zero or nan', choices=tuple(NOTHING))
    noise: float = setting(0.01, 'standard deviation of a range, at least (our choice: that of a cheap scanner)', 'm',
                           0.0, 1.0)
    relative_noise: float = setting(0.0, 'standard deviation of a range / range, at least', '', 0.0, 1.0)
    bias: float = setting(0.0, 'standard deviation of the systematic error, drawn once for each robot, at least', 'm',
                          0.0, 1.0)
    relative_bias: float = setting(0.0, 'that of the systematic error / range, at least', '', 0.0, 1.0)
    resolution: float = setting(0.0, 'ranges are multiples of it; 0: they are any numbers', 'm', 0.0, 1.0)
    dropouts: float = setting(0.0, 'share of the echoes that are missing (2 % of triangulating lasers: our choice)', '',
                              0.0, 1.0)
    beam_width: float = setting(0.0, 'angle that a beam covers; 0: as thin as a line, no mixed pixels (without a '
                                     'source: a half or the whole of the angle from beam to beam)', 'rad', 0.0, 0.2)
    mixing_depth: float = setting(ANY, 'surfaces in one beam that are farther apart than this do not mix', 'm', 0.0,
                                  ANY)
    x: float = setting(0.0, 'where it is mounted: so far ahead of the centre of the robot', 'm', -5.0, 5.0)
    y: float = setting(0.0, 'and so far to the left', 'm', -5.0, 5.0)
    yaw: float = setting(0.0, 'angle from straight ahead to its angle 0', 'rad', -math.pi, math.pi)
    upside_down: bool = setting(False, 'whether it is mounted upside down')

    def __post_init__(self) -> None:
        """Refuse more beams than a turn has."""
        if 0 < self.per_turn < self.beams:
            raise ConfigError(f'laser/per_turn is {self.per_turn}: must be 0, or not below beams, {self.beams}')

    @property
    def increment(self) -> float:
        """Angle from beam to beam, frame of the laser [rad]."""
        return (-TURN if self.clockwise else TURN) / self.beams_in_turn

    @property
    def beams_in_turn(self) -> int:
        """So many beams would be a full turn."""
        return self.per_turn or self.beams

    @property
    def first_in_robot(self) -> float:
        """Direction of the first beam, frame of the robot [rad]."""
        return self.yaw + (-self.first_angle if self.upside_down else self.first_angle)

    @property
    def step_in_robot(self) -> float:
        """Angle from beam to beam, frame of the robot [rad]."""
        return -self.increment if self.upside_down else self.increment

    @property
    def offsets(self) -> Tuple[float, ...]:
        """Angles from the middle of a beam at which it is looked along, frame of the robot [rad]."""
        return (0.0,) if self.beam_width == 0.0 else (-0.5 * self.beam_width, 0.0, 0.5 * self.beam_width)

    @property
    def draws(self) -> int:
        """How many random numbers a range needs: 1 for its noise, 2 if the echo may be missing or mixed."""
        is_plain = self.beam_width == 0.0 and self.dropouts == 0.0 and self.sure_range >= self.range_max
        return 1 if is_plain else 2

    @property
    def too_far(self) -> float:
        """What is reported if there is no echo."""
        return NOTHING[self.nothing][0]

    @property
    def too_near(self) -> float:
        """What is reported for less than range_min."""
        return NOTHING[self.nothing][1]

    def rate_at(self, step_rate: int) -> int:
        """Scans per second of a world with a step rate [Hz]: its largest divisor up to the rate of the laser."""
        return _divisor(step_rate, self.rate)


@functools.lru_cache(maxsize=None)
def _divisor(number: int, limit: float) -> int:
    return max(divisor for divisor in range(1, number + 1) if divisor <= limit and number % divisor == 0)
