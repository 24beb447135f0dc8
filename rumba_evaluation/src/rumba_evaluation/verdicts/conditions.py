"""What can be required of a robot's run.

There are two kinds of conditions:

A goal (coverage, reach, docked) must be met at the end. For coverage the newest value counts. A waypoint that was
reached once counts as reached. For docked, the contacts must be closed after they were open: a robot that never left
its dock has not docked. So `coverage` and `docked` together require that the robot is on its dock after it has cleaned.

A guard (battery, collisions, fields) must hold in every message.

For partial credit, a condition of degrees has a figure, and tells how far that is from a worthless one to the required.
"""

import abc
import math
from typing import Any, Tuple

from rumba_sim.model.common.geometry import Pose, wrap_angle


class Condition(abc.ABC):
    """One requirement of a run.

    Attributes:
        name: letters, digits and _, unique among the conditions of a run.
        required: the requirement, in words.
        is_guard: whether it must hold in every message; else it must be met at the end.
        has_degrees: whether it can be met in part.
        is_more_better: whether the figure by which it is met in part should be high.
        is_measured: whether there was a value.
    """

    is_guard = False
    has_degrees = True
    is_more_better = True

    def __init__(self, name: str, required: str) -> None:
        """There is no value yet."""
        self.name = name
        self.required = required
        self.is_measured = False

    def update(self, value: Any) -> None:
        """Take a measured value."""
        self.is_measured = True
        self._update(value)

    @property
    def is_met(self) -> bool:
        """Whether it is met by the values so far; not without any."""
        return self.is_measured and self._is_met()

    def measured(self) -> str:
        """The measured values, in words."""
        return self._measured() if self.is_measured else 'nothing'

    def finish(self, duration: float) -> None:
        """The run has ended after a time [s]."""

    def share(self, worthless: float) -> float:
        """How far it is met: 0 with a worthless figure or without any value, 1 if it is met."""
        if self.is_met or not self.is_measured or not self.has_degrees:
            return float(self.is_met)
        figure, required = self.figures()
        return min(max((figure - worthless) / (required - worthless), 0.0), 1.0)

    @abc.abstractmethod
    def _update(self, value: Any) -> None:
        """Take a measured value."""

    @abc.abstractmethod
    def _is_met(self) -> bool:
        """Whether it is met by the values so far, of which there is at least one."""

    @abc.abstractmethod
    def figures(self) -> Tuple[float, float]:
        """The figure by which it is met in part: as measured, and as required."""

    @abc.abstractmethod
    def _measured(self) -> str:
        """The values, in words; there is at least one."""


class Coverage(Condition):
    """A share of the floor is swept; the values are shares [0..1]."""

    def __init__(self, least: float) -> None:
        """Require a share [0..1]."""
        super().__init__('coverage', f'at least {100.0 * least:.1f} % of the floor swept')
        self._least = least
        self._newest = math.nan

    def _update(self, value: float) -> None:
        self._newest = value

    def _is_met(self) -> bool:
        return self._newest >= self._least

    def figures(self) -> Tuple[float, float]:
        """The share of the floor."""
        return (0.0 if math.isnan(self._newest) else self._newest), self._least

    def _measured(self) -> str:
        return f'{100.0 * self._newest:.1f} %'


class Reach(Condition):
    """The robot was at a waypoint once; the values are poses in the map frame."""

    is_more_better = False

    def __init__(self, name: str, waypoint: Pose, distance: float, angle: float) -> None:
        """Require a waypoint within a distance [m] and an angle [rad]; a heading of NaN allows any."""
        any_heading = math.isnan(waypoint.theta)
        heading = '' if any_heading else f' and heading {waypoint.theta:.2f} rad within {angle:.2f} rad'
        super().__init__(name, f'to reach ({waypoint.x:.2f}, {waypoint.y:.2f}) m within {distance:.2f} m{heading}')
        self._waypoint, self._distance, self._angle = waypoint, distance, angle
        self._nearest, self._least_error = math.inf, math.inf  # [m], and of the heading within the distance [rad]
        self._is_reached = False

    def _update(self, value: Pose) -> None:
        waypoint = self._waypoint
        distance = math.hypot(value.x - waypoint.x, value.y - waypoint.y)
        error = 0.0 if math.isnan(waypoint.theta) else abs(wrap_angle(value.theta - waypoint.theta))
        self._nearest = min(self._nearest, distance)
        if distance <= self._distance:
            self._least_error = min(self._least_error, error)
            self._is_reached = self._is_reached or error <= self._angle

    def _is_met(self) -> bool:
        return self._is_reached

    def share(self, worthless: float) -> float:
        """By the distance; at most a half if the heading was never right."""
        has_heading = not math.isnan(self._waypoint.theta)
        return super().share(worthless) * (0.5 if has_heading and not self.is_met else 1.0)

    def figures(self) -> Tuple[float, float]:
        """The smallest distance [m]."""
        return self._nearest, self._distance

    def _measured(self) -> str:
        if self._is_reached or math.isinf(self._least_error):
            return f'a smallest distance of {self._nearest:.2f} m'
        return f'the position, with a smallest error of the heading of {self._least_error:.2f} rad'


class Docked(Condition):
    """The robot has come to its dock; the values tell whether the contacts are closed."""

    has_degrees = False

    def __init__(self) -> None:
        """The contacts have not been open yet."""
        super().__init__('docked', 'to come to the dock')
        self._is_docked = self._was_off = False

    def _update(self, value: bool) -> None:
        self._is_docked = value
        self._was_off = self._was_off or not value

    def _is_met(self) -> bool:
        return self._is_docked and self._was_off

    def figures(self) -> Tuple[float, float]:
        """1 on the dock."""
        return float(self.is_met), 1.0

    def _measured(self) -> str:
        if not self._is_docked:
            return 'off the dock'
        return 'on the dock' if self._was_off else 'on the dock, which it never left'


class Battery(Condition):
    """The charge never falls below a limit; the values are charges [%]."""

    is_guard = True

    def __init__(self, least: float) -> None:
        """Require a charge [%]."""
        super().__init__('battery', f'never less than {least:.1f} % of charge')
        self._least = least
        self._lowest = math.inf

    def update(self, value: float) -> None:
        """Take a charge [%]; one that is not finite (not measured) is ignored."""
        if math.isfinite(value):
            super().update(value)

    def _update(self, value: float) -> None:
        self._lowest = min(self._lowest, value)

    def _is_met(self) -> bool:
        return self._lowest >= self._least

    def figures(self) -> Tuple[float, float]:
        """The lowest charge [%]."""
        return self._lowest, self._least

    def _measured(self) -> str:
        return f'a lowest charge of {self._lowest:.1f} %'


class Collisions(Condition):
    """The number of collisions is limited; the values tell whether the bumper is pressed."""

    is_guard = True
    is_more_better = False

    def __init__(self, most: int) -> None:
        """Allow a number of collisions; a bumper that stays pressed is one collision."""
        super().__init__('collisions', f'at most {most} collision{"" if most == 1 else "s"}')
        self._most = most
        self._count = 0
        self._is_pressed = False

    def _update(self, value: bool) -> None:
        self._count += value and not self._is_pressed
        self._is_pressed = value

    def _is_met(self) -> bool:
        return self._count <= self._most

    def figures(self) -> Tuple[float, float]:
        """The number of collisions."""
        return self._count, self._most

    def _measured(self) -> str:
        return str(self._count)
