"""go_to reaches a pose, around walls and unknown obstacles, even if somebody moves the robot, or says why not."""

import math

import numpy as np
import pytest
from drivers import context_of, drive_by_hand, run, slanted_gap, with_box
from rooms import RADIUS, crooked, quiet, room

from rumba_cleaning.behaviour import STOP, Status
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, observe, steps
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.pose_source import seeing, truth
from rumba_cleaning.route import Route
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

PLAN = crooked()
HALL = room(4.0, 3.0, 0.02)
START = Pose(0.4, 0.4, 1.0)
TARGET = Pose(3.5, 2.4, -2.0)


def going(target=TARGET, plan=PLAN, start=START, truth=None):
    """A world, and a robot in it that is to go to a target."""
    world = World(truth or plan, quiet())
    world.spawn('rumba', start)
    return world, GoTo(context_of(plan, world), target)


def off(world, target):
    """How far a robot is from a pose [m, rad]."""
    pose = world.robots['rumba'].pose
    return math.hypot(pose.x - target.x, pose.y - target.y), abs(wrap_angle(pose.theta - target.theta))


@pytest.mark.parametrize('seed', range(12))
def test_it_comes_to_rest_at_the_pose_from_anywhere(seed):
    generator = np.random.default_rng(seed)
    nodes = np.argwhere(PLAN.clearance >= RADIUS + 0.01)[:, ::-1] * PLAN.resolution + PLAN.origin
    start, target = (Pose(*nodes[generator.integers(len(nodes))].tolist(), float(generator.uniform(-3.1, 3.1)))
                     for _ in range(2))
    world, behaviour = going(target, start=start)
    seconds = run(behaviour, world, seconds=60.0)
    assert behaviour.status is Status.SUCCEEDED, behaviour.message
    assert off(world, target)[0] < 0.03 and off(world, target)[1] < 0.05
    assert seconds < 30.0


def test_without_a_heading_in_the_goal_any_heading_will_do():
    world, behaviour = going(TARGET._replace(theta=math.nan))
    run(behaviour, world, seconds=60.0)
    assert behaviour.status is Status.SUCCEEDED
    assert off(world, TARGET)[0] < 0.03


def test_the_brushes_are_up_and_it_answers_stop_at_the_end():
    world, behaviour = going()
    commands = [command for _, command in steps(behaviour, world)]
    assert all(command.brushes_up for command in commands)
    assert commands[-1] == STOP


def test_the_distance_left_is_known_and_shrinks():
    world, behaviour = going()
    left = [behaviour.remaining for _ in steps(behaviour, world)]
    direct = math.hypot(TARGET.x - START.x, TARGET.y - START.y)
    assert direct <= left[0] < 1.5 * direct
    assert left[-1] < 0.05
    assert np.all(np.diff(left) < 0.02)


@pytest.mark.parametrize('target, message', [
    (Pose(1.3, 0.6, 0.0), 'target at .1.30, 0.60. m is .* from the nearest wall: a robot of radius'),
    (Pose(0.1, 1.5, 0.0), 'from the nearest wall'),
    (Pose(7.0, 1.5, 0.0), 'lies outside the map .x -0.05 to')])
def test_a_target_in_a_wall_or_outside_is_refused(target, message):
    with pytest.raises(MapError, match=message):
        going(target)


def test_if_no_path_leads_to_the_target_it_fails_at_once():
    plan = room(4.0, 2.0, boxes=[(1.9, 0.0, 2.1, 2.0)])
    world, behaviour = going(Pose(3.0, 1.0, 0.0), plan, Pose(1.0, 1.0, 0.0))
    assert run(behaviour, world) < 0.2
    assert behaviour.status is Status.FAILED
    assert behaviour.message == 'no path from (1.00, 1.00) to (3.00, 1.00) m'
    assert behaviour.outcome is Outcome.NO_PATH


def test_it_gets_around_what_the_map_does_not_show():
    plan = room(5.0, 2.0)
    world, behaviour = going(Pose(4.5, 1.0, 0.0), plan, Pose(0.5, 1.0, 0.0), with_box(plan, (2.0, 0.5, 2.4, 1.5)))
    assert run(behaviour, world, seconds=120.0) < 90.0
    assert behaviour.status is Status.SUCCEEDED
    assert off(world, Pose(4.5, 1.0, 0.0))[0] < 0.03


def test_it_gives_up_if_an_unknown_obstacle_closes_every_path():
    plan = room(5.0, 2.0)
    world, behaviour = going(Pose(4.5, 1.0, 0.0), plan, Pose(0.5, 1.0, 0.0), with_box(plan, (2.0, 0.0, 2.4, 2.0)))
    run(behaviour, world, seconds=1200.0)
    assert behaviour.status is Status.FAILED
    assert 'in the way' in behaviour.message and behaviour.outcome is Outcome.BLOCKED


def test_it_gets_around_another_robot():
    plan = room(5.0, 2.0)
    world, behaviour = going(Pose(4.5, 1.0, 0.0), plan, Pose(0.5, 1.0, 0.0))
    world.spawn('rumba2', Pose(2.0, 1.0, 0.0))
    run(behaviour, world, seconds=120.0)
    assert behaviour.status is Status.SUCCEEDED


def test_it_arrives_even_if_somebody_moves_it():
    world, behaviour = going()
    for number, _ in enumerate(steps(behaviour, world, seconds=120.0)):
        if number == 40:
            world.teleport('rumba', Pose(0.4, 2.7, 0.0))
    assert behaviour.status is Status.SUCCEEDED
    assert off(world, TARGET)[0] < 0.03


@pytest.mark.parametrize('share', [0.1, 0.5, 1.0])
def test_driven_elsewhere_by_a_person_it_arrives(share):
    world, behaviour = going()
    direct = math.hypot(TARGET.x - START.x, TARGET.y - START.y)
    for observation, _ in steps(behaviour, world, seconds=120.0):
        if behaviour.status is Status.RUNNING and behaviour.remaining <= (1.0 - share) * direct + 0.02:
            drive_by_hand(behaviour, world, 0.3, 0.8, 6.0)
            assert math.isnan(behaviour.remaining)
            break
    assert run(behaviour, world, seconds=60.0) < 40.0
    assert behaviour.status is Status.SUCCEEDED
    assert off(world, TARGET)[0] < 0.03 and off(world, TARGET)[1] < 0.05


@pytest.mark.parametrize('theta', [-2.0, math.nan])
@pytest.mark.parametrize('push', [0.025, 0.06, 0.4])
def test_pushed_while_it_turns_to_its_heading_it_comes_back(push, theta):
    world, behaviour = going(TARGET._replace(theta=theta))
    pushed = False
    for observation, command in steps(behaviour, world, seconds=120.0):
        if not pushed and command.v == 0.0 and math.hypot(observation.pose.x - TARGET.x,
                                                          observation.pose.y - TARGET.y) < 0.02:
            pose = world.robots['rumba'].pose
            world.teleport('rumba', pose._replace(x=pose.x - push))
            pushed = True
    assert pushed and behaviour.status is Status.SUCCEEDED
    assert off(world, TARGET)[0] < 0.02


def test_restarted_it_arrives():
    world, behaviour = going()
    for number, _ in enumerate(steps(behaviour, world)):
        if number == 30:
            break
    behaviour.restart()
    run(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED
    assert off(world, TARGET)[0] < 0.03


@pytest.mark.parametrize('laser', [False, True])
def test_with_its_laser_it_touches_nothing_that_the_laser_sees(laser):
    world = World(HALL, quiet(), 50, 1, [Obstacle('box', Pose(2.0, 1.5, 0.4), 0.3, length=0.4, width=0.6)])
    world.spawn('rumba', Pose(0.5, 1.5, 0.0))
    behaviour = GoTo(context_of(HALL, world, laser=laser), Pose(3.5, 1.5, 0.0))
    run(behaviour, world, seconds=60.0, source=seeing(truth))
    assert behaviour.status is Status.SUCCEEDED, behaviour.message
    assert (world.robots['rumba'].bumps == 0) == laser


def test_it_backs_off_from_what_it_touches_and_sees():
    world = World(HALL, quiet(), 50, 1, [Obstacle('box', Pose(2.0, 1.5, 0.0), 0.3, length=0.4, width=0.6)])
    world.spawn('rumba', Pose(1.75 - RADIUS, 1.5, 0.0))
    robot = world.robots['rumba']
    robot.command(0.2, 0.0, world.tick)
    world.step(20)
    assert any(robot.bumper)
    route = Route(np.array([[1.8 - RADIUS, 1.5], [3.5, 1.5]]), np.array([0.2]))
    travel = Travel(context_of(HALL, world, laser=True), route)
    while travel.going is Going.ON:
        command = travel.command(observe(world, 'rumba', CONTROL_DT, seeing(truth)), brushes_up=True)
        robot.command(command.v, command.w, world.tick)
        world.step(CONTROL_TICKS)
    assert travel.going is Going.BLOCKED and robot.pose.x < 1.77 - RADIUS


@pytest.mark.parametrize('angle', [0.3, 0.5, 0.7])
def test_it_squeezes_through_a_gap_that_is_hardly_wider_than_the_robot(angle):
    plan = room(4.0, 2.4, 0.02)
    world = World(plan, quiet(), obstacles=slanted_gap(2.0 * RADIUS + 0.015, angle))
    world.spawn('rumba', Pose(0.5, 1.0, 0.0))
    behaviour = GoTo(context_of(plan, world, laser=True), Pose(3.5, 1.0, 0.0))
    run(behaviour, world, source=seeing(truth))
    assert behaviour.status is Status.SUCCEEDED


def test_it_waits_for_somebody_who_stands_in_its_only_way():
    world = World(HALL, quiet(), 50, 1, [Obstacle('crowd', Pose(2.0, 1.5, 0.0), 1.5, length=0.2, width=2.9)])
    world.spawn('rumba', Pose(0.5, 1.5, 0.0))
    behaviour = GoTo(context_of(HALL, world, laser=True), Pose(3.5, 1.5, 0.0))
    messages = {behaviour.message for _ in steps(behaviour, world, seconds=40.0, source=seeing(truth))}
    assert behaviour.status is Status.RUNNING and 'waiting for what is in the way' in messages
    assert world.robots['rumba'].bumps == 0
    world.remove_obstacle('crowd')
    run(behaviour, world, seconds=60.0, source=seeing(truth))
    assert behaviour.status is Status.SUCCEEDED, behaviour.message
