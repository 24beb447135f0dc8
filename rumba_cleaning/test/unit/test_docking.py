"""dock reaches the dock by the beams alone from anywhere in their field, else by the map; undock leaves the dock."""

import math

import numpy as np
import pytest
from drivers import context_of, drive_by_hand, run, with_box
from rooms import RADIUS, crooked, quiet, room

from rumba_cleaning.behaviour import Status
from rumba_cleaning.behaviours.dock import Dock, approach
from rumba_cleaning.behaviours.homing import BUOYS, Homing
from rumba_cleaning.behaviours.undock import Undock
from rumba_cleaning.control import observe, steps
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

DOCK = Pose(5.0 - RADIUS - 0.01, 1.3, 0.0)
PLAN = room(5.0, 3.0, boxes=[(2.0, 2.2, 2.3, 3.0)], dock=DOCK)


def at(pose, plan=PLAN, truth=None):
    """A world with a robot at a pose, and what it knows."""
    world = World(truth or plan, quiet())
    world.spawn('rumba', pose)
    return world, context_of(plan, world)


def anywhere(seed, in_field):
    """A free pose, in the field of the buoys or not."""
    generator = np.random.default_rng(seed)
    nodes = np.argwhere(PLAN.clearance >= RADIUS + 0.01)[:, ::-1] * PLAN.resolution + PLAN.origin
    while True:
        pose = Pose(*nodes[generator.integers(len(nodes))].tolist(), float(generator.uniform(-3.1, 3.1)))
        world, context = at(pose)
        if bool(world.infrared('rumba').omni & BUOYS) is in_field:
            return world, context


@pytest.mark.parametrize('seed', range(25))
def test_the_beams_alone_lead_home_from_anywhere_in_their_field(seed):
    world, context = anywhere(seed, True)
    context.ground = context.swept = None  # what the robot must not use, the plan and its dock included
    behaviour = Homing(context)
    assert run(behaviour, world, seconds=120.0) < 60.0
    assert behaviour.status is Status.SUCCEEDED, behaviour.message
    assert world.robots['rumba'].is_docked


@pytest.mark.parametrize('seed', range(15))
def test_the_map_leads_to_where_the_beams_are(seed):
    world, context = anywhere(seed, False)
    behaviour = Dock(context)
    assert not behaviour.is_homing
    assert run(behaviour, world, seconds=120.0) < 60.0
    assert behaviour.status is Status.SUCCEEDED, behaviour.message
    assert world.robots['rumba'].is_docked


@pytest.mark.parametrize('turn', [0.0, 0.5 * math.pi, -2.2])
def test_a_dock_may_face_anywhere(turn):
    dock = {0.0: DOCK, 0.5 * math.pi: Pose(1.0, 3.0 - RADIUS - 0.01, 0.5 * math.pi), -2.2: Pose(3.5, 1.5, -2.2)}[turn]
    world, context = at(Pose(3.5, 2.5, 1.0), room(5.0, 3.0, dock=dock))
    behaviour = Dock(context)
    run(behaviour, world, seconds=200.0)
    assert behaviour.status is Status.SUCCEEDED, behaviour.message


def test_a_docked_robot_is_home_already():
    world, context = at(DOCK)
    world.step()
    behaviour = Dock(context)
    assert run(behaviour, world) < 0.2
    assert behaviour.status is Status.SUCCEEDED


def test_without_a_dock_there_is_no_home():
    with pytest.raises(MapError, match=r'room: no dock on the map: its YAML file may name one, dock: \[x, y, theta\]'):
        Dock(at(Pose(1.0, 1.0, 0.0), crooked())[1])


def test_a_dock_in_a_niche_too_narrow_is_refused():
    plan = room(5.0, 3.0, boxes=[(2.0, 0.0, 2.3, 1.4), (2.0, 1.6, 2.3, 3.0)], dock=Pose(2.55, 1.5, 0.0))
    with pytest.raises(MapError, match='too little space before the dock at .2.55, 1.50. m'):
        Dock(at(Pose(1.0, 1.0, 0.0), plan)[1])


def test_if_no_path_leads_to_the_dock_it_fails_at_once():
    plan = room(5.0, 3.0, boxes=[(2.0, 0.0, 2.3, 3.0)], dock=DOCK)
    world, context = at(Pose(1.0, 1.0, 0.0), plan)
    behaviour = Dock(context)
    assert run(behaviour, world) < 0.5
    assert behaviour.status is Status.FAILED
    assert behaviour.message.startswith('cannot get to the dock: no path from (1.00, 1.00) to')
    assert behaviour.outcome is Outcome.NO_PATH


def test_a_dock_with_something_before_it_is_given_up():
    world, context = at(Pose(1.0, 1.0, 0.0), truth=with_box(PLAN, (4.3, 0.8, 4.5, 1.8)))
    behaviour = Dock(context)
    run(behaviour, world, seconds=1500.0)
    assert (behaviour.status, behaviour.outcome) == (Status.FAILED, Outcome.FAILED)
    assert behaviour.message == '3 attempts to dock failed: the beams of the dock are lost'
    assert not world.robots['rumba'].is_docked


def test_with_something_at_the_point_before_the_dock_it_begins_nearer():
    thing = Obstacle('thing', Pose(DOCK.x - 0.95, DOCK.y + 0.05, 0.0), 0.3, radius=0.15)
    world = World(PLAN, quiet(), 50, 1, [thing])
    world.spawn('rumba', Pose(1.0, 2.5, 0.0))
    context = context_of(PLAN, world)
    before = approach(context)
    assert math.hypot(before.x - thing.pose.x, before.y - thing.pose.y) < thing.radius + RADIUS
    context.ground.mark(thing.pose.x, thing.pose.y, thing.radius)
    assert DOCK.x - 0.8 < approach(context).x < DOCK.x - 0.3
    context.forget_obstacles()
    behaviour = Dock(context)
    run(behaviour, world, seconds=200.0)
    assert behaviour.status is Status.SUCCEEDED, behaviour.message


def test_moved_elsewhere_while_the_beams_guide_it_it_still_comes_home():
    world, context = at(Pose(3.5, 1.3, 2.0))
    behaviour = Dock(context)
    was_homing = False
    for _ in steps(behaviour, world, seconds=300.0):
        if behaviour.is_homing and not was_homing and world.time > 5.0:
            was_homing = True
            world.teleport('rumba', Pose(0.5, 2.5, 0.0))
    assert was_homing
    assert behaviour.status is Status.SUCCEEDED


@pytest.mark.parametrize('is_homing', [False, True])
def test_driven_elsewhere_by_a_person_it_still_comes_home(is_homing):
    world, context = at(Pose(0.5, 2.5, 0.0))
    behaviour = Dock(context)
    for _ in steps(behaviour, world, seconds=300.0):
        if behaviour.is_homing is is_homing and world.time > 3.0:
            break
    before = world.robots['rumba'].pose
    drive_by_hand(behaviour, world, -0.3, 0.2, 8.0)
    after = world.robots['rumba'].pose
    assert math.hypot(after.x - before.x, after.y - before.y) > 1.0 and not behaviour.is_homing
    assert run(behaviour, world, seconds=200.0) < 100.0
    assert behaviour.status is Status.SUCCEEDED


@pytest.mark.parametrize('seconds', [2.0, 6.0, 12.0, 20.0])
def test_turned_and_pushed_by_a_person_the_beams_lead_it_home_again(seconds):
    world, context = at(Pose(3.5, 1.8, 2.0))
    behaviour = Homing(context)
    run(behaviour, world, seconds=seconds)
    drive_by_hand(behaviour, world, -0.1, 1.0, 4.0)
    assert run(behaviour, world, seconds=120.0) < 60.0
    assert behaviour.status is Status.SUCCEEDED, behaviour.message


def test_without_any_beam_the_beams_are_lost():
    world, context = at(Pose(1.0, 2.6, 0.0))
    behaviour = Homing(context)
    assert 8.0 < run(behaviour, world, seconds=120.0) < 9.0
    assert (behaviour.message, behaviour.outcome) == ('the beams of the dock are lost', Outcome.FAILED)


# --- undock ---------------------------------------------------------------------------------------------------------

def test_undocking_backs_off_and_turns_around():
    world, context = at(DOCK)
    world.step()
    behaviour = Undock(context)
    assert run(behaviour, world) < 8.0
    pose = world.robots['rumba'].pose
    assert behaviour.status is Status.SUCCEEDED
    assert not world.robots['rumba'].is_docked
    assert 0.4 <= DOCK.x - pose.x < 0.5 and abs(pose.y - DOCK.y) < 0.01
    assert abs(wrap_angle(pose.theta - math.pi)) < 0.03


def test_a_mission_undocks_without_turning():
    world, context = at(DOCK)
    world.step()
    run(Undock(context, turns=False), world)
    assert abs(world.robots['rumba'].pose.theta) < 0.01


def test_a_robot_that_stands_free_has_nothing_to_leave():
    world, context = at(Pose(1.0, 1.0, 0.0))
    behaviour = Undock(context)
    assert run(behaviour, world) < 0.2
    assert (behaviour.status, behaviour.message) == (Status.SUCCEEDED, 'was not docked')


def test_something_right_behind_keeps_it_on_the_dock():
    world, context = at(DOCK)
    world.spawn('rumba2', DOCK._replace(x=DOCK.x - 2.0 * RADIUS - 0.02))
    world.step()
    behaviour = Undock(context)
    run(behaviour, world)
    assert (behaviour.status, behaviour.message) == (
        Status.FAILED, 'something behind the robot keeps it on the dock')
    assert behaviour.outcome is Outcome.BLOCKED


def test_wheels_that_never_turn_are_named_and_nothing_behind_the_robot_is_blamed():
    world = World(PLAN, updated(quiet(), {'drive': {'max_speed': 0.05, 'dead_band': 0.08}}, 'test'))
    world.spawn('rumba', DOCK)
    world.step()
    behaviour = Undock(context_of(PLAN, world))
    run(behaviour, world)
    assert behaviour.message == ('the wheels do not turn: drive/max_speed is 0.05 m/s, and below drive/dead_band, '
                                 '0.08 m/s, they stand still')
    assert behaviour.outcome is Outcome.BLOCKED


def test_a_long_step_before_it_moves_is_no_obstacle():
    """The node was busy, with planning for example."""
    world, context = at(DOCK)
    world.step()
    behaviour = Undock(context)
    behaviour.restart()
    for dt in (0.0, 9.0, 9.0, 0.1):
        command = behaviour.step(observe(world, 'rumba', dt))
    assert behaviour.status is Status.RUNNING and command.v < 0.0


def test_brought_back_to_the_dock_by_a_person_it_backs_off_again():
    world, context = at(DOCK)
    world.step()
    behaviour = Undock(context)
    run(behaviour, world, seconds=1.8)
    assert 0.0 < behaviour.remaining < 0.2
    drive_by_hand(behaviour, world, 0.2, 0.0, 6.0)
    assert world.robots['rumba'].is_docked
    assert run(behaviour, world) < 10.0
    assert behaviour.status is Status.SUCCEEDED and not world.robots['rumba'].is_docked
