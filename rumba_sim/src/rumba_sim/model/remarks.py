"""What people should know about a map before a robot sets off: a line for each matter."""

from typing import List

from rumba_sim.model.reachability import Parts
from rumba_sim.model.world import World

MUCH = 0.03  # share of the floor: rather a part of a room than a corner; our choice


def remarks(world: World) -> List[str]:
    """What is odd about the file of the map of a world, and how much of its floor robots cannot reach."""
    return [*world.plan.remarks, *_out_of_reach(world)]


def _out_of_reach(world: World) -> List[str]:
    """A line if robots that begin at the start cannot reach much of the floor on which they could stand."""
    parts = Parts(world.reachable_plan, float(world.constants[0]['reach']))
    start, here = world.start, parts.at(*world.start[:2])
    others = [(number, area) for number, area in enumerate(parts.areas.tolist(), 1) if number != here]
    share = sum(area for _, area in others) / max(float(parts.areas.sum()), 1e-9)
    if share < MUCH:
        return []
    x, y, _ = parts.open_pose(others[0][0])
    return [f'{world.plan.name}: {100.0 * share:.0f} % of the floor on which a robot can stand is out of reach of '
            f'the start at ({start.x:.2f}, {start.y:.2f}) m. To reach the largest part of it, give the map '
            f'start: [{x:.2f}, {y:.2f}, 0.0]']
