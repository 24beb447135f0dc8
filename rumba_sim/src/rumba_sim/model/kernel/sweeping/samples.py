"""The sample points of the floor: where they lie, and how often the brush passed them."""

from typing import Tuple

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.hashing import scrambled

SWEEPABLE, REACHABLE, PASS = 1, 2, 4  # bits of a sample; the bits from PASS on count how often the brush passed it
MOST_PASSES = 63  # that fit into a byte; after so many no dirt is left


def sample_point(row: int, column: int) -> Tuple[float, float]:
    """The sample point of a square (row, column) of the floor, along x and along y [squares].

    It lies anywhere in its square, as a hash of row and column says (stratified sampling). So a strip of floor contains
    points in proportion to its area whatever its heading; points in the middles of the squares would form lines.
    """
    bits = scrambled(row, column)
    return across_of(column, bits), up_of(row, bits)


def across_of(column: int, bits: int) -> float:
    """Where in a column the point lies whose hash is `bits` [squares]."""
    return column + (bits & 0xFFFF) / 65536.0


def up_of(row: int, bits: int) -> float:
    """Where in a row the point lies whose hash is `bits` [squares]."""
    return row + (bits >> 16) / 65536.0


def clean(k: Record, samples: Array, row: int, column: int) -> Tuple[int, float]:
    """Count one more pass over the sample of a square (row, column), if there is floor.

    There are no branches in it: the processor could not foresee them.

    Returns:
        How many more samples are swept, and the share of the first dirt that is taken.
    """
    sample = int(samples[row, column])
    before = sample // PASS
    passes = sample // SWEEPABLE & int(before < MOST_PASSES)
    samples[row, column] = sample + PASS * passes
    passes &= sample // REACHABLE
    return passes & int(before == 0), passes * k.takes[before]
