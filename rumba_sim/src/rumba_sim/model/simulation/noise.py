"""The random numbers of a world: each robot draws its own, so that what one robot does changes nothing for another."""

from typing import Any, List, Mapping, Sequence, Tuple

import numpy as np

from rumba_sim.model.kernel import Array
from rumba_sim.model.simulation import world_state

NOISE_TICKS = 256  # ticks for which the noise of the wheels is drawn at once
FLOOR, WHEELS, LASER, BIAS = 0, 1, 2, 4  # purposes of random generators, beside that of `Obstacles`
MOST_BIAS = 2.0  # [standard deviations] the maker's limits, which no laser exceeds


def sequence(seed: int, purpose: int, number: int) -> np.random.SeedSequence:
    """The seed for a purpose in a world with a seed, the same with each version of NumPy.

    Since 1.19, NumPy fills entropy of less than 128 bits with zeros before it adds the key: here it has them already.
    """
    words = [seed >> shift & 0xFFFFFFFF for shift in range(0, max(128, seed.bit_length()), 32)]
    return np.random.SeedSequence(words, spawn_key=(purpose, number))


def generator(seed: int, purpose: int, number: int) -> np.random.Generator:
    """A random generator for a purpose in a world with a seed."""
    return np.random.default_rng(sequence(seed, purpose, number))


class Noise:
    """The noise of wheels and lasers, by the index of the robot.

    Attributes:
        wheels: float64 (robots, NOISE_TICKS, 2), standard normal; tick t uses row t modulo NOISE_TICKS.
        biases: of the systematic errors of the lasers, in their standard deviations.
        spawned: how many robots there have been since the beginning or the last reset of the world.
    """

    def __init__(self, seed: int) -> None:
        """That of a world with a seed and without robots."""
        self.wheels: Array = np.zeros((0, NOISE_TICKS, 2))
        self.biases: List[float] = []
        self.spawned = 0
        self._seed = seed
        self._wheels: List[np.random.Generator] = []
        self._lasers: List[np.random.Generator] = []

    def add(self, scale_error: float) -> Array:
        """Begin that of another robot; returns the errors of the scales of its wheels: float64 (2).

        Args:
            scale_error: their standard deviation.
        """
        wheels = generator(self._seed, WHEELS, self.spawned)
        scales = wheels.normal(0.0, scale_error, 2)
        self._wheels.append(wheels)
        self._lasers.append(generator(self._seed, LASER, self.spawned))
        bias = generator(self._seed, BIAS, self.spawned).standard_normal()
        self.biases.append(float(min(max(bias, -MOST_BIAS), MOST_BIAS)))
        self.wheels = np.concatenate([self.wheels, wheels.standard_normal((1, NOISE_TICKS, 2))])
        self.spawned += 1
        return scales

    def remove(self, index: int) -> None:
        """End that of a robot."""
        del self._wheels[index], self._lasers[index], self.biases[index]
        self.wheels = np.delete(self.wheels, index, axis=0)

    def draw(self, tick: int) -> None:
        """Draw that of the wheels for the next NOISE_TICKS ticks, if that of the last ones is used up."""
        if tick % NOISE_TICKS == 0:
            for row, wheels in zip(self.wheels, self._wheels):
                wheels.standard_normal(out=row)

    def draw_laser(self, index: int, noise: Array) -> None:
        """Draw that of a scan: `noise`, float64 (1 or 2, beams), receives it, as for the kernel."""
        self._lasers[index].standard_normal(out=noise[0])
        if len(noise) > 1:
            self._lasers[index].random(out=noise[1])

    def states(self) -> List[Tuple[Mapping[str, Any], Mapping[str, Any], float]]:
        """The states of the bit generators of wheels and laser of each robot, and the bias of its laser."""
        return [(wheels.bit_generator.state, laser.bit_generator.state, bias)
                for wheels, laser, bias in zip(self._wheels, self._lasers, self.biases)]

    def restore(self, spawned: int, members: Sequence[world_state.Member]) -> None:
        """Go on from a saved state; the array is to be filled next.

        Raises:
            WorldError: it is damaged.
        """
        self.spawned = spawned
        self.wheels = np.zeros((len(members), NOISE_TICKS, 2))
        self._wheels = [world_state.generator(member.wheels) for member in members]
        self._lasers = [world_state.generator(member.laser) for member in members]
        self.biases = [member.bias for member in members]
