"""Groups of stretches, in each of which a tour is searched: all, or those of a region or of a part of it."""

from typing import Dict, List, NamedTuple, Sequence

import numpy as np

from rumba_cleaning.planning.common.stretches import Stretch
from rumba_sim.model.kernel import Array

# Variants in a group, and in each part of a region, if it has more: the time for a tour grows with their square and
# more, but from part to part the robot drives farther. Our choice, by halls of up to 3,500 m2 with pillars or chairs.
MANY, MOST = 1500, 350


class Group(NamedTuple):
    """Stretches that are driven one after the other."""

    region: int  # its label; 0: several regions
    stretches: List[Stretch]

    def middle(self) -> Array:
        """The first waypoint of a stretch that is nearest to the mean of all these: float64 (2) [m]."""
        entries = _entries(self.stretches)
        return np.asarray(entries[int(np.argmin(np.hypot(*(entries - entries.mean(axis=0)).T)))])


def groups(found: Sequence[Stretch], across: bool = False) -> List[Group]:
    """Stretches in groups, in the order of the first of each region.

    Args:
        found: the stretches.
        across: whether they may be one group, if they are few, so that a tour leads to and fro between regions.
    """
    if across and sum(len(part.variants) for part in found) <= MANY:
        return [Group(0, list(found))]
    by_region: Dict[int, List[Stretch]] = {}
    for part in found:
        by_region.setdefault(part.region, []).append(part)
    return [Group(region, part) for region, stretches in by_region.items() for part in _parts(stretches, MANY)]


def _parts(stretches: List[Stretch], most: int) -> List[List[Stretch]]:
    """Stretches as they are, if they have at most so many variants; or halves of them, side by side, and so on."""
    counts = np.array([len(stretch.variants) for stretch in stretches])
    if len(stretches) < 2 or counts.sum() <= most:
        return [stretches]
    middles = 0.5 * (_entries(stretches) + np.array([stretch.variants[0].ends()[3] for stretch in stretches]))
    along = int(np.argmax(np.ptp(middles, axis=0)))
    order = np.argsort(middles[:, along], kind='stable')
    half = int(np.searchsorted(np.cumsum(counts[order]), 0.5 * counts.sum()))
    half = min(max(half, 1), len(stretches) - 1)
    return [part for indices in (order[:half], order[half:])
            for part in _parts([stretches[index] for index in np.sort(indices)], MOST)]


def _entries(stretches: Sequence[Stretch]) -> Array:
    """The first waypoint of each stretch: float64 (any, 2) [m]."""
    return np.array([stretch.variants[0].ends()[0] for stretch in stretches])
