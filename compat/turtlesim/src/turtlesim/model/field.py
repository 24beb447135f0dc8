"""The field: turtles by name, their pens and their drawing."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Callable, Dict, List, NamedTuple, Sequence

import numpy as np
from PIL import Image

from turtlesim.model.canvas import Canvas, Colour, Pen
from turtlesim.model.errors import TurtlesimError
from turtlesim.model.portrait import portrait
from turtlesim.model.turtles import EXTENT, METRE, PIXELS, Turtles, check_numbers

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

NAME = re.compile(r'[A-Za-z/][\w/]{0,199}', re.ASCII)
MIDDLE = float(np.float32(0.5 * EXTENT))  # [m] turtlesim counts in float32 here
NEARLY = 1e-6  # [pixels] that a position may be short of a pixel because of rounding
FLOAT32 = np.finfo(np.float32)


class WallHit(NamedTuple):
    """A turtle that a wall stopped, and the position that it would have reached [m]; y is counted from the top."""

    name: str
    x: float
    y: float


class Field:
    """The turtles and their drawing; a step of time is a call of `move`, then of `draw`.

    Attributes:
        changes: a number that grows whenever the picture may have changed.
        hits: turtles that a wall stopped; the caller clears the list.
    """

    def __init__(self, background: Colour, resolved: Callable[[str], str] = lambda name: name) -> None:
        """Start with turtle1 in the middle.

        Args:
            background: the colour.
            resolved: returns the full name of a topic; no two turtles share topics.
        """
        self.changes = 0
        self._resolved = resolved
        self.reset(background)

    def reset(self, background: Colour) -> None:
        """Restore the initial field, on a background of any colour."""
        self.changes += 1
        self._rows: Dict[str, int] = {}
        self.hits: List[WallHit] = []
        self._turtles = Turtles()
        self._pens: List[Pen] = []
        self._numbers: List[int] = []  # of each turtle, how many came before it: the colour of its picture
        self._came = 0
        self._named = 0
        self._is_drawn = True
        self._at: NDArray[np.int64] = np.zeros((0, 2), np.int64)  # pixels at which the pens are
        self._canvas = Canvas(background)
        self.spawn('', MIDDLE, MIDDLE, 0.0)

    def clear(self, background: Colour) -> None:
        """Erase all lines."""
        self.changes += 1
        self._canvas.clear(background)

    # --- turtles --------------------------------------------------------------------------------------------------

    @property
    def names(self) -> List[str]:
        """The names of the turtles, in the order of `readings`."""
        return list(self._rows)

    def __contains__(self, name: str) -> bool:
        """Whether a turtle has that name."""
        return name in self._rows

    def pose(self, name: str) -> List[float]:
        """Return x, y [m] and theta [rad] of a turtle."""
        pose: List[float] = self._turtles.poses[self._row(name)].tolist()
        return pose

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """Add a turtle at x, y [m] with heading theta [rad]; return its name.

        Args:
            name: name of the turtle; empty: the next free one of turtle1, turtle2, ..., no number twice.

        Raises:
            TurtlesimError: the name is in use or not valid, or a number is not finite.
        """
        check_numbers(f'spawn {name}'.strip(), x=x, y=y, theta=theta)
        if name and not NAME.fullmatch(name):
            raise TurtlesimError(f'{name[:80]!r} is not a valid name: must be at most 200 letters, digits, _ and /, '
                                 'and begin with a letter or /')
        if name and self._is_taken(name):
            raise TurtlesimError(f'A turtled named [{name}] already exists')  # as turtlesim spells it
        name = name or self._next_name()
        self.changes += 1
        self._rows[name] = len(self._rows)
        self._numbers.append(self._came)
        self._came += 1
        self._pens.append(Pen())
        self._turtles.add((x, y, theta))
        self._clamp()
        self._at = np.vstack([self._at, self._pixels()[-1:]])
        return name

    def kill(self, name: str) -> None:
        """Remove a turtle; its lines stay.

        Raises:
            TurtlesimError: no turtle has that name.
        """
        if name not in self._rows:
            raise TurtlesimError(f'Tried to kill turtle [{name}], which does not exist: {self._known()}')
        row = self._row(name)
        self.changes += 1
        del self._rows[name], self._pens[row], self._numbers[row]
        self._rows = {name: row for row, name in enumerate(self._rows)}
        self._turtles.remove(row)
        self._at = np.delete(self._at, row, axis=0)

    def command(self, name: str, velocity: Sequence[float]) -> None:
        """Drive forward, to the left [m/s] and counter-clockwise [rad/s], for one second at most."""
        self._turtles.command(self._row(name), velocity)

    def set_pen(self, name: str, pen: Pen) -> None:
        """Give a turtle another pen."""
        self._pens[self._row(name)] = pen

    def teleport(self, name: str, x: float, y: float, theta: float) -> None:
        """Put a turtle at x, y [m] with heading theta [rad]; a pen that is down draws a line to there.

        Raises:
            TurtlesimError: no turtle has that name, or a number is not finite.
        """
        check_numbers(f'teleport {name}', x=x, y=y, theta=theta)
        self._turtles.place(self._row(name), (x, y, theta))
        self._clamp()
        self._is_drawn = False
        self.draw()

    def teleport_relative(self, name: str, linear: float, angular: float) -> None:
        """Turn a turtle by an angle [rad], then put it forward [m]; a pen that is down draws a line.

        Raises:
            TurtlesimError: no turtle has that name, or a number is not finite.
        """
        check_numbers(f'teleport {name}', linear=linear, angular=angular)
        x, y, theta = self.pose(name)
        theta += angular
        self.teleport(name, x + linear * math.cos(theta), y + linear * math.sin(theta), theta)

    def _next_name(self) -> str:
        while True:
            self._named += 1
            name = f'turtle{self._named}'
            if not self._is_taken(name):
                return name

    def _is_taken(self, name: str) -> bool:
        return self._resolved(topics(name)) in [self._resolved(topics(other)) for other in self._rows]

    def _row(self, name: str) -> int:
        try:
            return self._rows[name]
        except KeyError:
            raise TurtlesimError(f'there is no turtle [{name}]: {self._known()}') from None

    def _known(self) -> str:
        return f'the turtles are {", ".join(self._rows) or "none"}'

    # --- time -----------------------------------------------------------------------------------------------------

    def move(self) -> None:
        """Move all turtles by one step of 16 ms; until `draw`, they see the colours below their new lines."""
        if self._turtles.step():
            self._clamp()
            self._is_drawn = False

    def draw(self) -> None:
        """Draw lines from the last positions of the pens to the present ones."""
        if self._is_drawn:
            return
        self._is_drawn = True
        self.changes += 1
        before, self._at = self._at, self._pixels()
        for row in np.flatnonzero((before != self._at).any(axis=1)).tolist():
            if self._pens[row].is_down:
                self._canvas.line(before[row].tolist(), self._at[row].tolist(), self._pens[row])

    def _clamp(self) -> None:
        hits = self._turtles.clamp()
        if hits:
            names = self.names
            self.hits += [WallHit(names[row], x, EXTENT - y) for row, x, y in hits]

    def _pixels(self) -> NDArray[np.int64]:
        pixels: NDArray[np.int64] = np.floor(
            METRE * self._turtles.poses[:, :2] * (1, -1) + (0, PIXELS - 1) + NEARLY).astype(np.int64)
        return pixels

    # --- readings and pictures ------------------------------------------------------------------------------------

    def readings(self) -> NDArray[np.float32]:
        """Return the values of the pose messages.

        Returns:
            Shape (n, 5): x, y [m], theta [rad], speed [m/s], turn rate [rad/s].
        """
        poses, velocities = self._turtles.poses, self._turtles.velocities
        with np.errstate(over='ignore'):  # infinity is as good as the largest number
            speeds = np.hypot(velocities[:, 0], velocities[:, 1])
        readings = np.column_stack([poses, speeds, velocities[:, 2]])
        return np.clip(readings, FLOAT32.min, FLOAT32.max).astype(np.float32)

    def colour(self, name: str) -> Colour:
        """Return the colour under a turtle."""
        x, y, _ = self.pose(name)
        return self._canvas.colour((math.floor(METRE * x + 0.5), math.floor(PIXELS - 1 - METRE * y + 0.5)))

    def picture(self) -> Image.Image:
        """Return the field with its turtles, the latest on top, as an RGB image; y points up."""
        picture = self._canvas.image.copy()
        for number, (column, row), theta in zip(self._numbers, self._at.tolist(), self._turtles.poses[:, 2].tolist()):
            turtle = portrait(number, theta)
            picture.paste(turtle, (column - METRE // 2, row - METRE // 2), turtle)
        return picture


def topics(name: str) -> str:
    """Return what the names of the topics of a turtle begin with."""
    return re.sub('/+', '/', f'{name}/')
