"""Compiles the localisation before its first use; the build runs `python3 -m rumba_localisation.mapping.warm_up`."""

import math

import numpy as np

from rumba_localisation.localiser import Localiser
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.scan import scan_of
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FloorPlan


def main() -> None:
    """Look for a scan on the map of a room, and make a map of it."""
    plan = FloorPlan('a room of 4 m', np.zeros((40, 40), np.int8), 0.1, (0.0, 0.0))
    angles = np.linspace(-math.pi, math.pi, 90, endpoint=False)
    ranges = 2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    scan = scan_of(ranges, -math.pi, math.pi / 45.0, 8.0)
    localiser = Localiser(plan, 0.17, 8.0)
    localiser.observe(Pose(0.0, 0.0, 0.0), scan)
    mapper = Mapper()
    for x in (0.0, 0.2):
        mapper.observe(Pose(x, 0.0, 0.0), scan)


if __name__ == '__main__':
    main()
