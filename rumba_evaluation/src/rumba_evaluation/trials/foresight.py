"""What people should know before missions begin: about the map, the robot, and what both will take."""

from typing import List

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.edges.guard import why_it_creeps
from rumba_cleaning.mission import outlook
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model import remarks


def remarks_on(trial: Trial) -> List[str]:
    """A line for each matter, about a trial that has not begun."""
    world = trial.world
    return [*remarks.remarks(world),
            *outlook.remarks(world.plan, *world.start[:2], world.config, CleaningConfig()),
            *filter(None, [why_it_creeps(world.config)])]
