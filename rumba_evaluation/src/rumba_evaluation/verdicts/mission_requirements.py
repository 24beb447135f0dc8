"""The requirements of a robot's run as settings, and as conditions."""

import dataclasses
import math
from typing import List

from rumba_evaluation.verdicts.conditions import Battery, Collisions, Condition, Coverage, Docked, Reach
from rumba_evaluation.verdicts.field_conditions import Agreement, Field, Rate
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose

NOT_REQUIRED = -1


@dataclasses.dataclass(frozen=True)
class Requirements:
    """The requirements of a run; by default none."""

    coverage: float = setting(0.0, 'share of the floor to sweep, 0: no requirement', '', 0.0, 1.0)
    reach: str = setting('', 'waypoints to reach, in any order, as in "4 2.5; 8 8 1.57": x y or x y theta [m, rad]')
    reach_distance: float = setting(0.1, 'a waypoint counts as reached within this distance', 'm', 0.001, 100.0)
    reach_angle: float = setting(0.2, 'largest error of the heading at a waypoint', 'rad', 0.001, 3.2)
    docked: bool = setting(False, 'whether the robot must be on its dock at the end')
    battery: float = setting(0.0, 'lowest charge allowed, 0: no requirement', '%', 0.0, 100.0)
    collisions: int = setting(NOT_REQUIRED, 'largest number of collisions allowed, -1: no requirement', '',
                              NOT_REQUIRED, 1_000_000)
    fields: str = setting('', 'ranges of fields of topics, as in "rumba/battery_state/voltage 13 inf; '
                              'rumba/odom/twist/twist/linear/x -0.3 0.3"')
    agree: str = setting('', 'fields that agree, each value of the first with the newest of the second, and by how '
                             'much they may differ, as in "student/status/level rumba/battery_state/charge 0.1"')
    rates: str = setting('', 'how often messages come, on average over the run, as in "student/status 9 11" [Hz]')
    points: str = setting('', 'points for each condition, as in "coverage 8; collisions 2"; empty: one for each')
    partial: str = setting('', 'partial credit, as in "coverage 0.1; collisions 20 2": the figure that earns '
                               'nothing, from which points grow to the required one, and the exponent of the curve')
    time_limit: float = setting(60.0, 'for the whole run, in the time of the robots', 's', 0.01, 1e7)

    def conditions(self) -> List[Condition]:
        """A condition for each requirement.

        Raises:
            ConfigError: there is no requirement, or a text cannot be understood.
        """
        found: List[Condition] = []
        if self.coverage > 0.0:
            found.append(Coverage(self.coverage))
        waypoints = _parts(self.reach)
        for number, waypoint in enumerate(waypoints, 1):
            name = f'reach_{number}' if len(waypoints) > 1 else 'reach'
            found.append(Reach(name, _pose(waypoint), self.reach_distance, self.reach_angle))
        if self.docked:
            found.append(Docked())
        if self.battery > 0.0:
            found.append(Battery(self.battery))
        if self.collisions != NOT_REQUIRED:
            found.append(Collisions(self.collisions))
        found.extend(_field(part) for part in _parts(self.fields))
        found.extend(_agreement(part) for part in _parts(self.agree))
        found.extend(_rate(part) for part in _parts(self.rates))
        _check(found)
        return found


def _parts(text: str) -> List[str]:
    return [part.strip() for part in text.split(';') if part.strip()]


def _check(conditions: List[Condition]) -> None:
    if not conditions:
        raise ConfigError('there is no requirement: set one or more of coverage, reach, docked, battery, collisions, '
                          'fields, agree, rates')
    names = [condition.name for condition in conditions]
    for name in names:
        if names.count(name) > 1:
            raise ConfigError(f'{name} occurs twice: require one thing of each')


def _pose(text: str) -> Pose:
    numbers = _numbers(text.split())
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise ConfigError(f'reach has {text!r}: must be x y or x y theta, finite numbers [m, rad], "; " between '
                          'waypoints')
    return Pose(numbers[0], numbers[1], numbers[2] if len(numbers) == 3 else math.nan)


def _field(text: str) -> Field:
    path, *limits = text.split()
    numbers = _numbers(limits)
    if len(numbers) != 2 or not numbers[0] <= numbers[1]:
        raise ConfigError(f'fields has {text!r}: must be TOPIC/FIELD LOW HIGH, numbers or inf, LOW not above HIGH, '
                          '"; " between fields')
    return Field(path, *numbers)


def _agreement(text: str) -> Agreement:
    path, *others = text.split()
    numbers = _numbers(others[1:])
    if len(numbers) != 1 or not 0.0 <= numbers[0] < math.inf:
        raise ConfigError(f'agree has {text!r}: must be TOPIC/FIELD TOPIC/FIELD TOLERANCE, a number of at least 0, '
                          '"; " between pairs')
    return Agreement(path, others[0], *numbers)


def _rate(text: str) -> Rate:
    topic, *limits = text.split()
    numbers = _numbers(limits)
    if len(numbers) != 2 or not 0.0 < numbers[0] <= numbers[1]:
        raise ConfigError(f'rates has {text!r}: must be TOPIC LOW HIGH [Hz], LOW above 0 and not above HIGH, "; " '
                          'between topics')
    return Rate(topic, *numbers)


def _numbers(words: List[str]) -> List[float]:
    """The words as numbers; an empty list if one is not a number."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return []
