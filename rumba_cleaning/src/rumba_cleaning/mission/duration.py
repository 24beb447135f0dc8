"""How long a mission may take on a floor."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # who only wants the figures, as the console does, need not wait for what compiles
    from rumba_cleaning.belief.context import Context

PATIENCE = 3.0  # times what the floor takes without any overlap: boustrophedon needs less than 1.7 of them, our choice
TAPER = 1.3  # times what a charge takes without the taper of the charger; to 95 % it is 1.2


def longest(context: 'Context') -> float:
    """Time after which a mission is given up if its goal names no limit [s].

    It is the limit of the settings, or longer if the floor of the map takes longer to sweep, with all the charging.
    """
    plan, robot, config = context.plan, context.robot, context.config
    area = float(np.count_nonzero(plan.free)) * plan.resolution ** 2
    working = area / (robot.brush.width * config.speed)
    battery = robot.battery
    charging = TAPER * battery.cleaning_current / battery.charge_current  # times the time of working
    return max(config.time_limit.clean, PATIENCE * working * (1.0 + charging))
