"""A margin to walls: fewer collisions, for what the brush leaves beside the walls."""

import numpy as np
from rooms import RADIUS, quiet, room

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan
from rumba_sim.model.simulation.world import World


def ragged(**kwargs):
    """A room of 3 x 2.5 m whose walls are as uneven as those that a laser maps: a quarter of the cells beside them."""
    plan = room(3.0, 2.5, 0.05)
    cells, generator = plan.occupancy.copy(), np.random.default_rng(4)
    beside = np.zeros(cells.shape, bool)
    beside[[1, -2], 1:-1] = beside[1:-1, [1, -2]] = True
    cells[beside & (generator.random(cells.shape) < 0.25)] = OCCUPIED
    return FloorPlan('ragged', cells, plan.resolution, plan.origin, **kwargs)


def cleaned(plan, margin, start=None):
    """A world after a mission to 98 %, and the mission."""
    world = World(plan, quiet(), step_rate=50)
    world.spawn('rumba', start, brushes_up=True)
    world.step()
    mission = Mission(Context(plan, world.config, CleaningConfig(margin=margin)), 'boustrophedon', 0.98)
    for _ in steps(mission, world, seconds=4000.0):
        pass
    return world, mission


def test_a_margin_saves_collisions_and_costs_what_lies_beside_the_walls():
    bare, _ = cleaned(ragged(), 0.0)
    quieter, mission = cleaned(ragged(), 0.03)
    assert bare.robots['rumba'].bumps > 8 and quieter.robots['rumba'].bumps <= 2
    assert (mission.outcome, mission.message) == (Outcome.SUCCEEDED, '98.0 % swept')
    assert 0.85 < quieter.floor.coverage < 0.96 < bare.floor.coverage


def test_a_robot_that_begins_and_ends_on_a_dock_closer_to_the_wall_than_the_margin_comes_home():
    dock = Pose(3.0 - RADIUS - 0.07, 1.2, 0.0)
    world, mission = cleaned(ragged(dock=dock), 0.1)
    assert (mission.outcome, world.robots['rumba'].is_docked) == (Outcome.SUCCEEDED, True)


def test_a_passage_narrower_than_robot_and_two_margins_is_not_driven():
    plan = room(4.0, 2.0, 0.05, [(1.9, 0.0, 2.0, 0.8), (1.9, 1.2, 2.0, 2.0)])  # 0.4 m wide
    through, _ = cleaned(plan, 0.02, Pose(1.0, 1.0, 0.0))
    before, mission = cleaned(plan, 0.04, Pose(1.0, 1.0, 0.0))
    assert through.floor.coverage > 0.9 and before.floor.coverage < 0.6
    assert mission.outcome is Outcome.SUCCEEDED  # of what it reaches with the margin


def test_the_ground_keeps_off_by_the_margin_and_no_margin_changes_nothing():
    ground = Ground(room(2.0, 2.0, 0.05), quiet())
    before = ground.fits.copy()
    ground.keep_off(0.0)
    assert (ground.fits == before).all()
    ground.keep_off(0.05)
    assert (ground.fits == (ground.clearance >= Ground(ground.plan, quiet()).reach + 0.05 + 0.003 - 1e-9)).all()
