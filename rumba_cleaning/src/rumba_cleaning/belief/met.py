"""The obstacles that one robot has met and sees: which of them may go again, and which stay."""

from typing import Callable, List, NamedTuple

import numpy as np

from rumba_sim.model.common.geometry import hypot
from rumba_sim.model.kernel import Array

# All figures below are our choice; each comment says what speaks for a larger and for a smaller value.
GROWTH = 0.02  # [m] added to the radius of an obstacle that is met again: large passes it after fewer touches
SAME = 1.5  # radii from where it was met before: small outlines wide obstacles touch by touch, large hides free floor
LARGEST = 0.25  # [m] radius of an obstacle, at most: small leaves gaps beside it open, large passes wide obstacles
OVERLAP = 0.02  # [m] by which robot and obstacle may overlap: a pose errs by less
LEAST = 0.01  # [m] radius of an obstacle, below which there is none
SEEN = 0.02  # [m] radius of what is seen at a point: half a cell of `Sight`
SQUEEZED = -0.015  # [m] the same for a robot that squeezes past: beams end within a cell of what they meet, and it does
#                    not know exactly where it touched things


class Mark(NamedTuple):
    """A round obstacle that the robot has met."""

    x: float  # [m] of its centre, map frame
    y: float  # [m]
    radius: float  # [m]

    def overlaps(self, other: 'Mark') -> bool:
        """Whether it has floor in common with another one."""
        return hypot(self.x - other.x, self.y - other.y) < self.radius + other.radius

    def beside(self, x: float, y: float, radius: float) -> 'Mark':
        """The same, but as small as it must be to have no floor in common with a circle [m]."""
        return self._replace(radius=min(self.radius, hypot(self.x - x, self.y - y) - radius))


class Seen(NamedTuple):
    """Obstacles that the robot sees, or saw last: points (any, 2) [m], map frame."""

    passing: Array  # may move on
    staying: Array


NOTHING_SEEN = Seen(np.empty((0, 2)), np.empty((0, 2)))


class Met:
    """What one robot met and sees. What is met may move: what is met where it was met before is there to stay."""

    def __init__(self) -> None:
        """Nothing."""
        self._unsure: List[Mark] = []  # met once
        self._former: List[Mark] = []  # met once, and forgotten last
        self._lasting: List[Mark] = []  # met again after that
        self._seen = NOTHING_SEEN
        self._radius = SEEN  # [m] of what is seen at a point

    def copy(self) -> 'Met':
        """One that stays as it is if this one changes."""
        other = Met()
        other._unsure, other._former, other._lasting = list(self._unsure), list(self._former), list(self._lasting)
        other._seen, other._radius = self._seen, self._radius  # replaced, never changed
        return other

    @property
    def doubtful(self) -> List[Mark]:
        """Those that may go again."""
        return self._touched(self._unsure) + self._marks(self._seen.passing)

    @property
    def lasting(self) -> List[Mark]:
        """Those that stay."""
        return self._touched(self._lasting) + self._marks(self._seen.staying)

    @property
    def has_doubtful(self) -> bool:
        """Whether it has met or seen any that may go again."""
        return bool(self._unsure) or len(self._seen.passing) > 0

    @property
    def has_lasting(self) -> bool:
        """Whether it has met or seen any that stay."""
        return bool(self._lasting) or len(self._seen.staying) > 0

    def show(self, seen: Seen) -> bool:
        """Replace what the robot sees; whether there is, or was, anything."""
        shown, self._seen = self._seen, seen
        return any(len(points) for points in (*seen, *shown))

    def add(self, touched: Mark, stays: bool) -> List[Mark]:
        """Remember an obstacle that was touched; one that is met again is taken to be larger than before.

        Returns:
            It, and what was forgotten there and is known again.
        """
        again = [mark.radius + GROWTH for mark in self._unsure + self._lasting
                 if hypot(mark.x - touched.x, mark.y - touched.y) < SAME * touched.radius]
        touched = touched._replace(radius=min(max([touched.radius, *again]), LARGEST))
        back = [mark for mark in self._former if mark.overlaps(touched)]
        if stays or back or any(mark.overlaps(touched) for mark in self._lasting):
            self._lasting += [touched, *back]
            self._former = [mark for mark in self._former if mark not in back]
        else:
            self._unsure.append(touched)
        return self._touched([touched, *back])

    def leave_out(self, x: float, y: float, radius: float) -> bool:
        """As `Ground.leave_out`; whether that changed anything."""
        if not any(hypot(mark.x - x, mark.y - y) < radius + mark.radius - OVERLAP
                   for mark in self._unsure + self._lasting):
            return False
        self._unsure, self._lasting = ([mark for mark in (old.beside(x, y, radius) for old in marks)
                                        if mark.radius > LEAST] for marks in (self._unsure, self._lasting))
        return True

    def settle(self) -> None:
        """As `Ground.settle`."""
        self._lasting, self._unsure = self._lasting + self._unsure, []
        self._seen = Seen(NOTHING_SEEN.passing, np.concatenate([self._seen.staying, self._seen.passing]))

    def forget_doubtful(self) -> Array:
        """As `Ground.forget_doubtful`."""
        seen, self._seen = self._seen, self._seen._replace(passing=NOTHING_SEEN.passing)
        self._former, self._unsure = self._unsure, []
        return seen.passing

    def forget_barring(self, is_barring: Callable[[Mark], bool]) -> Array:
        """As `Ground.forget_barring`."""
        forgotten = [mark for mark in self._lasting if is_barring(mark)]
        self._former, self._unsure = self._unsure + forgotten, []
        self._lasting = [mark for mark in self._lasting if mark not in forgotten]
        bars = np.array([is_barring(Mark(x, y, SEEN)) for x, y in self._seen.staying.tolist()], bool)
        seen, self._seen = self._seen, Seen(NOTHING_SEEN.passing, self._seen.staying[~bars])
        return np.concatenate([seen.passing, seen.staying[bars]])

    @property
    def most_clearance(self) -> float:
        """Clearance that a node has at most to which a point is nearest at which something is seen [m]."""
        return 2.0 * SEEN - self._radius

    def squeeze(self, on: bool) -> bool:
        """As `Ground.squeeze`; whether that is news."""
        before, self._radius = self._radius, SQUEEZED if on else SEEN
        return before != self._radius

    @property
    def less(self) -> float:
        """By how much smaller everything is taken to be where the robot squeezes past [m]; else 0."""
        return SEEN - self._radius

    def _touched(self, marks: List[Mark]) -> List[Mark]:
        """Obstacles that were touched; where the robot squeezes past, as much smaller as what it sees."""
        return [mark._replace(radius=mark.radius - self.less) for mark in marks]

    def _marks(self, points: Array) -> List[Mark]:
        """Obstacles that are seen at points (any, 2) [m]."""
        return [Mark(x, y, self._radius) for x, y in points.tolist()]
