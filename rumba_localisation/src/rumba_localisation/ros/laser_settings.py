"""Parameters of the nodes that say how the readings of a laser are taken. Those that amcl has have its names."""

import dataclasses

from rumba_localisation.scan import Reading
from rumba_sim.model.common.config import setting


@dataclasses.dataclass(frozen=True)
class LaserSettings:
    """Which ranges count."""

    laser_min_range: float = setting(0.0, 'shorter ranges are ignored; 0: range_min of the scan counts', 'm', 0.0,
                                     1000.0)
    laser_max_range: float = setting(0.0, 'ranges as long as that have no echo; 0: range_max of the scan counts', 'm',
                                     0.0, 1000.0)

    @property
    def reading(self) -> Reading:
        """The same for a scan."""
        return Reading(self.laser_min_range, self.laser_max_range)
