"""What people should know before missions begin: about the map, the robot, and what both will take."""

from typing import List

from rumba_cleaning.mission.outlook import outlook, without_dock
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.remarks import remarks


def remarks_on(trial: Trial) -> List[str]:
    """A line for each matter, about a trial that has not begun."""
    world, cleaning = trial.world, trial.contexts[0].config
    expected = outlook(world.plan, *world.start[:2], world.config, cleaning)
    found = [*remarks(world), without_dock(world.plan, expected)]
    fastest = world.config.drive.max_speed
    if fastest < cleaning.speed:
        found.append(f'the robot drives at {fastest:g} m/s at most: T is the time at that, and not at the usual '
                     f'cleaning speed of {cleaning.speed:g} m/s')
    return [remark for remark in found if remark]
