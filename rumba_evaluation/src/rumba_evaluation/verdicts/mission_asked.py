"""What may be asked of a robot's run, as settings; and the conditions that they mean."""

import dataclasses
import math
from typing import List

from rumba_evaluation.verdicts.mission_verdict import Battery, Collisions, Condition, Coverage, Docked, Field, Reach
from rumba_sim.model.config import setting
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.geometry import Pose

NOT_ASKED = -1


@dataclasses.dataclass(frozen=True)
class Asked:
    """What is asked of a run; by default nothing."""

    coverage: float = setting(0.0, 'share of the floor that must get swept, 0: not asked', '', 0.0, 1.0)
    reach: str = setting('', 'places to get to, in any order, as in "4 2.5; 8 8 1.57": x y or x y theta [m, rad]')
    reach_distance: float = setting(0.1, 'so near is there', 'm', 0.001, 100.0)
    reach_angle: float = setting(0.2, 'a heading so near is right', 'rad', 0.001, 3.2)
    docked: bool = setting(False, 'whether it must come to its dock, at the end')
    battery: float = setting(0.0, 'charge that must always be left, 0: not asked', '%', 0.0, 100.0)
    collisions: int = setting(NOT_ASKED, 'presses of the bumper that are allowed, -1: not asked', '', NOT_ASKED,
                              1_000_000)
    fields: str = setting('', 'fields of topics that must stay in a range, as in "rumba/battery_state/voltage 13 inf; '
                              'rumba/odom/twist/twist/linear/x -0.3 0.3"')
    time_limit: float = setting(60.0, 'for all of it, in the time of the robots', 's', 0.01, 1e7)

    def conditions(self) -> List[Condition]:
        """What is asked, one by one.

        Raises:
            ConfigError: nothing is asked, or a text cannot be understood.
        """
        found: List[Condition] = []
        if self.coverage > 0.0:
            found.append(Coverage(self.coverage))
        places = _parts(self.reach)
        for number, place in enumerate(places, 1):
            name = f'reach_{number}' if len(places) > 1 else 'reach'
            found.append(Reach(name, _pose(place), self.reach_distance, self.reach_angle))
        if self.docked:
            found.append(Docked())
        if self.battery > 0.0:
            found.append(Battery(self.battery))
        if self.collisions != NOT_ASKED:
            found.append(Collisions(self.collisions))
        found.extend(_field(part) for part in _parts(self.fields))
        _check(found)
        return found


def _parts(text: str) -> List[str]:
    return [part.strip() for part in text.split(';') if part.strip()]


def _check(conditions: List[Condition]) -> None:
    if not conditions:
        raise ConfigError('nothing is asked: set one or more of coverage, reach, docked, battery, collisions, fields')
    names = [condition.name for condition in conditions]
    for name in names:
        if names.count(name) > 1:
            raise ConfigError(f'{name} is asked twice: give one range for a field')


def _pose(text: str) -> Pose:
    numbers = _numbers(text.split())
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise ConfigError(f'reach has {text!r}: must be x y or x y theta, finite numbers [m, rad], "; " between places')
    return Pose(numbers[0], numbers[1], numbers[2] if len(numbers) == 3 else math.nan)


def _field(text: str) -> Field:
    path, *limits = text.split()
    numbers = _numbers(limits)
    if len(numbers) != 2 or not numbers[0] <= numbers[1]:
        raise ConfigError(f'fields has {text!r}: must be TOPIC/FIELD LOW HIGH, numbers or inf, LOW not above HIGH, '
                          '"; " between fields')
    return Field(path, *numbers)


def _numbers(words: List[str]) -> List[float]:
    """The numbers that words are; none where one is no number."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return []
