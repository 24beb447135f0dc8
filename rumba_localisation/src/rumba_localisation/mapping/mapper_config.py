"""Parameters of the mapper. Those that gmapping or amcl have too have their names, and mean the same."""

import dataclasses

from rumba_sim.model.common.config import setting


@dataclasses.dataclass(frozen=True)
class MapperConfig:
    """When a scan is used, how wheels err, and how a laser."""

    update_min_d: float = setting(0.1, 'distance after which the next scan is used', 'm', 0.0, 10.0)
    update_min_a: float = setting(0.1, 'turn after which the next scan is used', 'rad', 0.0, 6.3)
    odom_alpha1: float = setting(0.01, 'variance of a turn that comes from turning', 'rad^2/rad^2', 0.0, 10.0)
    odom_alpha2: float = setting(0.02, 'variance of a turn that comes from driving', 'rad^2/m^2', 0.0, 10.0)
    odom_alpha3: float = setting(0.01, 'variance of a distance that comes from driving', 'm^2/m^2', 0.0, 10.0)
    odom_alpha4: float = setting(0.0005, 'variance of a distance that comes from turning', 'm^2/rad^2', 0.0, 10.0)
    sigma: float = setting(0.0, 'standard deviation of the distance from the end of a beam to the wall that it hit; 0: '
                                'it is estimated', 'm', 0.0, 1.0)
    delta: float = setting(0.0, 'side of a cell of the map; 0: 0.02 m, and more if the laser is not as exact or the '
                                'map is large', 'm', 0.0, 1.0)
