"""Parameters of the localisation. Those that amcl has too have its names, and mean the same."""

import dataclasses

from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError


@dataclasses.dataclass(frozen=True)
class LocaliserConfig:
    """Particles, motion, laser, and when the robot counts as localised."""

    min_particles: int = setting(150, 'least number of particles', '', 10, 100000)
    max_particles: int = setting(3000, 'largest number of particles', '', 10, 100000)
    kld_err: float = setting(0.05, 'largest error between the true distribution and the particles (Fox 2003)', '',
                             0.001, 1.0)
    kld_z: float = setting(2.33, 'quantile of the standard normal distribution for the probability that the error is '
                                 'smaller; 2.33: 99 %', '', 0.1, 6.0)
    update_min_d: float = setting(0.1, 'distance after which the next scan is used', 'm', 0.0, 10.0)
    update_min_a: float = setting(0.1, 'turn after which the next scan is used', 'rad', 0.0, 6.3)
    odom_alpha1: float = setting(0.01, 'variance of a turn that comes from turning', 'rad^2/rad^2', 0.0, 10.0)
    odom_alpha2: float = setting(0.02, 'variance of a turn that comes from driving: wheels whose scales differ by two '
                                       'standard deviations', 'rad^2/m^2', 0.0, 10.0)
    odom_alpha3: float = setting(0.01, 'variance of a distance that comes from driving: carpet takes 8 % of it',
                                 'm^2/m^2', 0.0, 10.0)
    odom_alpha4: float = setting(0.0005, 'variance of a distance that comes from turning', 'm^2/rad^2', 0.0, 10.0)
    laser_max_beams: int = setting(60, 'number of beams of a scan by which particles are weighed', '', 4, 10000)
    laser_z_hit: float = setting(0.9, 'share of beams that end at a wall of the map', '0..1', 0.01, 1.0)
    laser_z_rand: float = setting(0.1, 'share of beams that end anywhere', '0..1', 0.001, 1.0)
    laser_sigma_hit: float = setting(0.1, 'standard deviation of the distance from the end of a beam to the wall that '
                                          'it hits', 'm', 0.005, 5.0)
    laser_independence: float = setting(0.15, 'by how much less the beams of a scan count than if they erred '
                                              'independently; our choice', '0..1', 0.001, 1.0)
    recovery_alpha_slow: float = setting(0.02, 'rate at which the long-term average of the likelihood follows; with '
                                               'the next, decides how many particles are drawn from the scan', '',
                                         0.0, 1.0)
    recovery_alpha_fast: float = setting(0.3, 'rate at which the short-term average follows', '', 0.0, 1.0)

    def __post_init__(self) -> None:
        """Refuse bounds and rates in the wrong order."""
        if self.max_particles < self.min_particles:
            raise ConfigError(f'max_particles is {self.max_particles}: must not be below min_particles, '
                              f'{self.min_particles}')
        if self.recovery_alpha_fast < self.recovery_alpha_slow:
            raise ConfigError(f'recovery_alpha_fast is {self.recovery_alpha_fast:g}: must not be below '
                              f'recovery_alpha_slow, {self.recovery_alpha_slow:g}')
