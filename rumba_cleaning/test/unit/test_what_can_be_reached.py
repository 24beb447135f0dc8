"""A mission ends soon after it has swept what it can reach, and names both shares: of the map, and of that."""

import re

import numpy as np
import pytest
from drivers import context_of, run
from missions import mission
from rooms import RADIUS, quiet, room

from rumba_cleaning.control import CONTROL_DT, steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.pose_source import seeing, truth
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.sweep import Sweep
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

SHARES = r'(.*) % swept, (.*) % of what '
LEAST = 0.001  # of the coverage in the end: what is swept last is no matter
DOCK = Pose(4.0 - RADIUS - 0.01, 0.5, 0.0)
DOCKING = 100  # steps of the last half metre, at most, which any mission takes


def two_parts():
    """Two rooms of 6 m^2; the corners of the walls between them leave 6 mm to spare on each side of a robot."""
    cells = np.full((80, 60), FREE, np.int8)
    cells[:40, :20] = cells[44:, 26:] = OCCUPIED
    return FloorPlan('corners', np.pad(cells, 1, mode='constant', constant_values=OCCUPIED), 0.05, (-0.05, -0.05),
                     start=Pose(2.0, 1.0, 0.0))


def test_a_mission_succeeds_on_its_side_of_a_passage_through_which_nothing_is_planned():
    world, behaviour = mission(two_parts())
    run(behaviour, world, seconds=400.0)
    assert behaviour.outcome is Outcome.SUCCEEDED
    of_all, planned = map(float, re.fullmatch(SHARES + 'is planned', behaviour.message).groups())
    assert 100.0 * world.floor.coverage == pytest.approx(of_all, abs=0.2) and 60.0 < of_all < 70.0
    assert planned >= 98.0


def test_without_such_a_passage_one_share_is_all():
    world, behaviour = mission(room(2.0, 1.5))
    run(behaviour, world, seconds=400.0)
    assert re.fullmatch(r'[\d.]* % swept', behaviour.message)


@pytest.mark.parametrize('laser', [False, True])
def test_a_mission_that_cannot_get_into_a_niche_ends_soon_after_it_has_swept_the_rest(laser):
    plan = room(4.0, 3.0, boxes=[(0.9, 2.0, 1.0, 3.0), (0.0, 2.0, 0.2, 2.1)], dock=DOCK)
    world = World(plan, quiet(), obstacles=[Obstacle('crate', Pose(0.5, 2.1, 0.0), 0.3, length=0.7, width=0.3)])
    world.spawn('rumba', brushes_up=True)
    world.step()
    behaviour = Mission(context_of(plan, world, laser=laser), 'boustrophedon', 0.98)
    swept = [world.floor.coverage for _ in steps(behaviour, world, seconds=4000.0, source=seeing(truth))]
    reached = next(step for step, share in enumerate(swept) if share >= swept[-1] - LEAST)
    assert len(swept) < 1.15 * reached + DOCKING, (CONTROL_DT * reached, CONTROL_DT * len(swept))
    assert swept[-1] > 0.98 and world.robots['rumba'].is_docked
    assert behaviour.outcome is Outcome.SUCCEEDED
    of_map, beside = map(float, re.fullmatch(SHARES + 'lies beside obstacles', behaviour.message).groups())
    assert of_map < 97.0 and beside >= 98.0


def test_a_mission_asks_what_is_swept_before_a_passage_only_if_it_may_be_enough(monkeypatch):
    """Each answer takes as much computing as many steps of the robot."""
    asked, within = [], Sweep.within
    monkeypatch.setattr(Sweep, 'within', lambda sweep, *args: asked.append(sweep.coverage) or within(sweep, *args))
    world, behaviour = mission(two_parts())
    run(behaviour, world, seconds=400.0)
    assert behaviour.outcome is Outcome.SUCCEEDED
    assert sum(share < 0.5 for share in asked) < 10, asked
