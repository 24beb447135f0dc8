"""How turtles move: all of them in one step, an array row each."""

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
HOLD = 63  # steps that a command is held: those that begin within 1 s of it, 62 * STEP = 0.992 s the last
LARGEST = 1e9  # [m, m/s, rad, rad/s] more than any turtle needs, and still a float32


class Hit(NamedTuple):
    """A turtle that was stopped at a wall, and where it would be otherwise [m]."""

    row: int
    x: float
    y: float


class Turtles:
    """Poses and velocities; turtles are rows, in the order in which they came.

    Attributes:
        poses: shape (n, 3): x, y [m], theta [rad] in (-pi, pi].
        velocities: shape (n, 3): forward, to the left [m/s], counter-clockwise [rad/s].
    """

    def __init__(self) -> None:
        """Begin with none."""
        self.poses: NDArray[np.float64] = np.zeros((0, 3))
        self.velocities: NDArray[np.float64] = np.zeros((0, 3))
        self._held_until: NDArray[np.int64] = np.zeros(0, np.int64)
        self._all_held_until = -1
        self._steps = 0

    def add(self, pose: Sequence[float]) -> None:
        """One more turtle, at rest, at x, y [m], theta [rad]."""
        self.poses = np.vstack([self.poses, pose])
        self.velocities = np.vstack([self.velocities, np.zeros(3)])
        self._held_until = np.append(self._held_until, 0)
        wrap(self.poses[:, 2])

    def remove(self, row: int) -> None:
        """One turtle less; those after it move up."""
        self.poses = np.delete(self.poses, row, axis=0)
        self.velocities = np.delete(self.velocities, row, axis=0)
        self._held_until = np.delete(self._held_until, row)

    def command(self, row: int, velocity: Sequence[float]) -> None:
        """Set a velocity: forward, to the left [m/s], counter-clockwise [rad/s], for HOLD steps."""
        self.velocities[row] = velocity
        self._held_until[row] = self._all_held_until = self._steps + HOLD

    def place(self, row: int, pose: Sequence[float]) -> None:
        """Put a turtle elsewhere: x, y [m], theta [rad]; it keeps its velocity."""
        self.poses[row] = pose
        wrap(self.poses[:, 2])

    def step(self) -> bool:
        """Let STEP pass: turn first, then go along the new heading; returns whether any turtle may have moved.

        No walls yet: `clamp` is to follow.
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
        """Bring back all turtles that left the field; returns which, and where they were."""
        places = self.poses[:, :2]
        outside = ((places < 0.0) | (places > EXTENT)).any(axis=1)
        if not outside.any():
            return []
        hits = [Hit(row, *places[row].tolist()) for row in np.flatnonzero(outside).tolist()]
        np.clip(places, 0.0, EXTENT, out=places)
        return hits


def wrap(theta: NDArray[np.float64]) -> None:
    """Bring angles [rad] into (-pi, pi], in place; those that are there stay what they are to the last bit."""
    outside = (theta > math.pi) | (theta <= -math.pi)
    if outside.any():
        theta[outside] = math.pi - (math.pi - theta[outside]) % (2.0 * math.pi)


def check_numbers(what: str, **numbers: float) -> None:
    """Refuse numbers with which no turtle could go on.

    Raises:
        TurtlesimError: one is not finite, or beyond LARGEST.
    """
    for name, number in numbers.items():
        if not abs(number) <= LARGEST:
            raise TurtlesimError(f'{what}: {name} is {number}: must be a number from {-LARGEST:g} to {LARGEST:g}')
