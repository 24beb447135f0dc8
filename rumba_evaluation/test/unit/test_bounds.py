"""How long boustrophedon takes to clean 98 and 99 %, on the package's maps and on odd ones."""

import pathlib

import numpy as np
import pytest
from rooms import crooked, room

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import ANYWHERE, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

MAPS = pathlib.Path(__file__).resolve().parents[3] / 'rumba_sim' / 'maps'


@pytest.mark.thorough
@pytest.mark.parametrize('seed', [1, 2])
@pytest.mark.parametrize('name, most, longest', [
    ('apartment', 1.75, 2.3), ('studio', 1.7, 2.15), ('field', 1.04, 1.06)])
def test_it_keeps_to_the_bounds_from_anywhere_on_the_maps_of_the_package(name, most, longest, seed):
    trial = Trial(map_file.load(MAPS / f'{name}.yaml'), 'boustrophedon', Conditions(start=ANYWHERE), seed)
    while not trial.is_over:
        trial.step()
    result = trial.result()
    assert (result.outcome, result.docked, result.penetrated) == (Outcome.SUCCEEDED, 1, False), result.message
    assert trial.curve[97] < most * trial.ideal_time
    assert trial.curve[98] < longest * trial.ideal_time


def turned_hall(angle, resolution=0.05):
    """A hall of 6 m x 4 m with a box in it, turned against the map's axes."""
    y, x = np.mgrid[0:180, 0:180] * resolution - 4.5
    u, v = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    free = (np.abs(u) < 3.0) & (np.abs(v) < 2.0) & ~((np.abs(u - 1.0) < 0.4) & (np.abs(v) < 0.3))
    return FloorPlan('hall', np.where(free, FREE, OCCUPIED).astype(np.int8), resolution, (-4.5, -4.5))


@pytest.mark.thorough(except_for=['crooked, fine'])
@pytest.mark.parametrize('plan', [
    crooked(), crooked(0.02), turned_hall(0.0), turned_hall(0.4), room(8.0, 5.0, 0.05, cliff=(3.0, 2.0, 5.0, 3.0),
                                                                       start=Pose(1.0, 1.0, 0.0)),
    room(7.0, 5.0, boxes=[(3.4, 0.0, 3.6, 2.0), (3.4, 2.9, 3.6, 5.0)])],
    ids=['crooked', 'crooked, fine', 'hall', 'turned hall', 'hall around a cliff', 'two rooms'])
def test_it_keeps_to_the_bounds_on_other_floors(plan):
    trial = Trial(plan, 'boustrophedon', seed=1)
    while not trial.is_over:
        trial.step()
    result = trial.result()
    assert (result.outcome, result.penetrated) == (Outcome.SUCCEEDED, False), result.message
    assert trial.curve[97] < 1.5 * trial.ideal_time
    assert trial.curve[98] < 1.8 * trial.ideal_time
