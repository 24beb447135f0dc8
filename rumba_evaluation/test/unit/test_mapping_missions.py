"""Missions on floors that the robot was not shown, in which something goes wrong on the way."""

import math
import pathlib

import numpy as np
import pytest

from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import SLAM, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

STUDIO = pathlib.Path(__file__).resolve().parents[3] / 'rumba_sim' / 'maps' / 'studio.yaml'
ELSEWHERE = Pose(2.5, 2.0, 2.0)  # [m, rad]


@pytest.mark.thorough
def test_a_robot_that_is_carried_away_finds_its_place_goes_on_and_comes_home():
    trial = Trial(map_file.load(STUDIO), 'explore_and_clean', Conditions(pose=SLAM, target=0.95), seed=1)
    robot, mapper = trial.world.robots['rumba'], trial.sources['rumba'].mapper
    while trial.world.floor.coverage < 0.4:
        trial.step()
    assert math.hypot(robot.pose.x - ELSEWHERE.x, robot.pose.y - ELSEWHERE.y) > 1.5
    trial.world.teleport('rumba', ELSEWHERE)
    was_lost = False
    while not trial.is_over:
        trial.step()
        was_lost |= not mapper.estimate.is_sure
    result, believed = trial.result(), mapper.pose(robot.odometry)
    assert was_lost and result.outcome is Outcome.SUCCEEDED and result.docked == 1
    assert math.hypot(believed.x - robot.pose.x, believed.y - robot.pose.y) < 0.02
    assert 0.93 < result.coverage < 0.97


@pytest.mark.parametrize('x, y, seed', [(0.0001, 0.0487, 94), (0.024, 0.0073, 21), (0.0306, 0.0098, 39)])
def test_a_mission_begins_on_a_dock_that_its_first_map_shows_in_a_wall(x, y, seed):
    """The dock is 6 mm from the wall; the robot's map is finer than its errors, and shows less than its radius."""
    cells = np.full((62, 82), OCCUPIED, np.int8)
    cells[1:-1, 1:-1] = FREE
    plan = FloorPlan('room', cells, 0.05, (x - 0.05, y - 0.05), dock=Pose(1.5 + x, 3.0 + y - 0.18, 0.5 * math.pi))
    trial = Trial(plan, 'explore_and_clean', Conditions(pose=SLAM), seed)
    for _ in range(20):
        trial.step()
    assert trial.contexts[0].swept.reachable_area > 1.0
