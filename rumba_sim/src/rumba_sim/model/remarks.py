"""What people should know about a map before a robot sets off: a line for each matter."""

from typing import List

import numpy as np

from rumba_sim.model.floors.reachability import Parts, reach
from rumba_sim.model.kernel.sweeping.samples import REACHABLE
from rumba_sim.model.simulation.world import World

MUCH = 0.03  # share of the floor: rather a part of a room than a corner; our choice
LEAST = 0.002  # share of what can be reached: what a mission tells of its coverage is as exact; our choice


def remarks(world: World) -> List[str]:
    """What is odd about the file of the map of a world, and how much of its floor robots cannot or will not reach."""
    return [*world.plan.remarks, *_out_of_reach(world), *_behind_straits(world)]


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


def _behind_straits(world: World) -> List[str]:
    """A line if part of the floor lies behind straits, through which robots fit, but do not plan their way."""
    plan, (x, y) = world.reachable_plan, world.start[:2]
    every, planned = (reach(plan, world.config, x, y, is_exact) for is_exact in (True, False))
    behind = np.argwhere((every.samples & REACHABLE > 0) & (planned.samples & REACHABLE == 0))
    if len(behind) < LEAST * every.reachable:
        return []
    left, bottom = plan.origin
    row, column = ((behind[len(behind) // 2] + 0.5) * plan.sample_pitch).tolist()
    return [f'{world.plan.name}: {100.0 * len(behind) / every.reachable:.1f} % of what a robot can reach, about '
            f'({left + column:.2f}, {bottom + row:.2f}) m, lies behind gaps with a few millimetres to spare. It is not '
            'planned, and a mission succeeds with its target of the rest']
