"""The motion of turtles: one step moves all of them; each is a row of the arrays."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, List, NamedTuple, Sequence

import numpy as np

from turtlesim.model.errors import TurtlesimError

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

PIXELS = 500  # side of the field
METRE = 45  # [pixels] height of a turtle's picture
EXTENT = (PIXELS - 1) / METRE  # [m] x and y go from 0, the first pixel, to this, the last
STEP = 0.016  # [s]
HOLD = 63  # steps that a command lasts: those that begin within 1 s of it; the last begins after 62 * STEP = 0.992 s


class Hit(NamedTuple):
    """A turtle that a wall stopped, and the position that it would have reached [m]."""

    row: int
    x: float
    y: float


class Turtles:
    """Poses and velocities; turtles are rows, in the order in which they were added.

    Attributes:
        poses: shape (n, 3): x, y [m], theta [rad] in (-pi, pi].
        velocities: shape (n, 3): forward, to the left [m/s], counter-clockwise [rad/s].
    """

    def __init__(self) -> None:
        """Start without turtles."""
        self.poses: NDArray[np.float64] = np.zeros((0, 3))
        self.velocities: NDArray[np.float64] = np.zeros((0, 3))
        self._held_until: NDArray[np.int64] = np.zeros(0, np.int64)
        self._all_held_until = -1
        self._steps = 0

    def add(self, pose: Sequence[float]) -> None:
        """Add a turtle at rest, at x, y [m], theta [rad]."""
        self.poses = np.vstack([self.poses, pose])
        self.velocities = np.vstack([self.velocities, np.zeros(3)])
        self._held_until = np.append(self._held_until, 0)
        wrap(self.poses[:, 2])

    def remove(self, row: int) -> None:
        """Remove a turtle; the rows after it move up."""
        self.poses = np.delete(self.poses, row, axis=0)
        self.velocities = np.delete(self.velocities, row, axis=0)
        self._held_until = np.delete(self._held_until, row)

    def command(self, row: int, velocity: Sequence[float]) -> None:
        """Set a velocity: forward, to the left [m/s], counter-clockwise [rad/s], for HOLD steps."""
        self.velocities[row] = velocity
        self._held_until[row] = self._all_held_until = self._steps + HOLD

    def place(self, row: int, pose: Sequence[float]) -> None:
        """Put a turtle at x, y [m], theta [rad]; it keeps its velocity."""
        self.poses[row] = pose
        wrap(self.poses[:, 2])

    def step(self) -> bool:
        """Move by STEP: turn first, then go along the new heading; return whether any turtle may have moved.

        Walls are left to `clamp`, which the caller calls next.
        """
        self._steps += 1
        if self._steps > self._all_held_until + 1:
            return False
        self.velocities[self._held_until < self._steps] = 0.0
        forward, left, turn = STEP * self.velocities.T
        theta = self.poses[:, 2]
        theta += turn
        wrap(theta)
        cos, sin = np.cos(theta), np.sin(theta)
        self.poses[:, 0] += forward * cos - left * sin
        self.poses[:, 1] += forward * sin + left * cos
        return True

    def clamp(self) -> List[Hit]:
        """Move all turtles outside the field back to its edge; return these turtles with their positions before."""
        positions = self.poses[:, :2]
        outside = ((positions < 0.0) | (positions > EXTENT)).any(axis=1)
        if not outside.any():
            return []
        hits = [Hit(row, *positions[row].tolist()) for row in np.flatnonzero(outside).tolist()]
        np.clip(positions, 0.0, EXTENT, out=positions)
        return hits


def wrap(theta: NDArray[np.float64]) -> None:
    """Bring angles [rad] into (-pi, pi], in place; angles already in that range keep every bit."""
    outside = (theta > math.pi) | (theta <= -math.pi)
    if outside.any():
        theta[outside] = math.pi - (math.pi - theta[outside]) % (2.0 * math.pi)


def check_numbers(what: str, **numbers: float) -> None:
    """Refuse numbers that no pose or velocity can have.

    Raises:
        TurtlesimError: a number is not finite.
    """
    for name, number in numbers.items():
        if not math.isfinite(number):
            raise TurtlesimError(f'{what}: {name} is {number}: must be a finite number')
