"""The laser of a robot on a mission is silent for a while: the robot goes on, waits, and goes on again."""

import math

from rooms import crooked

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import STEP_RATE, steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.pose_source import Localised, scan_of_robot
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

BEGUN, ENDED = 30.0, 60.0  # [s]


def test_a_mission_waits_for_a_laser_that_is_silent_once_its_pose_is_uncertain_and_then_goes_on():
    plan = crooked(0.05, dock=Pose(3.7, 1.2, 0.0))
    world = World(plan, RobotConfig(), STEP_RATE, seed=2)
    robot = world.spawn('rumba', brushes_up=True)
    world.step()
    source = Localised(plan, world, 'rumba', 2)
    source.scans = lambda world, name: None if BEGUN <= world.time < ENDED else scan_of_robot(world, name)
    mission = Mission(Context(plan, RobotConfig(), CleaningConfig(), seed=5), 'boustrophedon', 0.9)
    driven, waited, said, errors = [robot.distance], 0, set(), []
    for observation, command in steps(mission, world, seconds=600.0, source=source):
        errors.append(math.hypot(observation.pose.x - robot.pose.x, observation.pose.y - robot.pose.y))
        if BEGUN <= world.time < ENDED:
            driven.append(robot.distance)
            said.add(mission.message)
            waited += command.v == command.w == 0.0
    assert max(errors) < 0.15 and 0.3 < driven[-1] - driven[1] < 2.0 and waited > 200
    assert any('swept' in each and each.endswith('; the laser has been silent for 2 s') for each in said)
    assert 'the laser has been silent for 29 s: waits for it' in said
    assert mission.status is Status.SUCCEEDED and robot.is_docked and world.floor.coverage > 0.89
