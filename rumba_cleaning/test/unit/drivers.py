"""Has robots of a world do what behaviours say."""

from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import steps
from rumba_sim.model.floor_plan import OCCUPIED, FloorPlan


def context_of(plan, world, seed=1, **changes):
    """What a robot of a world, whose floor may differ from the plan, knows."""
    return Context(plan, world.config, CleaningConfig(**changes), seed)


def run(behaviour, world, name='rumba', seconds=600.0):
    """Update a behaviour until it ends or the time is up; returns the seconds that this took."""
    start = world.time
    for _ in steps(behaviour, world, name, seconds):
        pass
    return world.time - start


def with_box(plan, box):
    """The plan with something in the box (left, bottom, right, top) [m] that it does not show."""
    left, bottom, right, top = box
    (row, column), (last_row, last_column) = plan.cell(left, bottom), plan.cell(right, top)
    occupancy = plan.occupancy.copy()
    occupancy[row:last_row, column:last_column] = OCCUPIED
    return FloorPlan(plan.name, occupancy, plan.resolution, plan.origin, cliff=plan.cliff, carpet=plan.carpet,
                     dock=plan.dock, start=plan.start)
