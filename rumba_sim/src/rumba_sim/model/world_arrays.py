"""The arrays in which a world is: what the kernel reads and changes."""

from typing import NamedTuple

from rumba_sim.model.kernel import Array


class WorldArrays(NamedTuple):
    """Arrays as `kernel` describes them; those of a floor plan, which never change, are not among them."""

    robots: Array
    constants: Array
    obstacles: Array
    stops: Array
    noise: Array
    cells: Array
    samples: Array
    dirt: Array
    tally: Array
