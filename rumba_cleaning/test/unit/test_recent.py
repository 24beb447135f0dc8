"""A robot without a map knows where it is, about, although its wheels turn on while it touches something."""

import math

import pytest
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import SIDE, Observation
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.recent import Recent
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS, observe
from rumba_cleaning.pose_source import DeadReckoning
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

STEP = 0.03  # [m] between observations


def corrected(steps, bumper, slant=0.0):
    """The poses of a robot whose wheels drive straight on, along a slant [rad], as its bumper is pressed or not."""
    recent, found = Recent(), []
    for number, pressed in enumerate(bumper):
        pose = Pose(number * STEP * math.cos(slant), number * STEP * math.sin(slant), slant)
        found.append(recent.corrected(Observation(CONTROL_DT, pose, bumper=pressed)).pose)
    assert len(found) == steps
    return found


@pytest.mark.parametrize('slant', [0.0, 1.0, 3.0])
def test_it_does_not_get_beyond_what_it_meets_head_on_and_half_of_the_step_until_then_counts(slant):
    poses = corrected(6, [(False, False)] * 3 + [(True, True)] * 3, slant)
    assert [math.hypot(*pose[:2]) for pose in poses] == pytest.approx([0.0, STEP, 2 * STEP] + [2.5 * STEP] * 3)


@pytest.mark.parametrize('pressed, side', [((True, False), 1.0), ((False, True), -1.0)])
def test_what_it_touches_on_one_side_lets_it_slide_to_the_other_only(pressed, side):
    poses = corrected(3, [pressed] * 3)
    away = [pose.y for pose in poses]
    ahead = poses[-1].x - poses[-2].x
    assert side * away[-1] < side * away[-2] < 0.0 and 0.0 < ahead < STEP
    assert (poses[-1].y - poses[-2].y) / ahead == pytest.approx(-side / math.tan(SIDE))


def test_as_it_backs_off_it_moves_as_its_wheels_drive():
    recent = Recent()
    poses = [recent.corrected(Observation(CONTROL_DT, Pose(-number * STEP, 0.0, 0.0), bumper=(True, True))).pose
             for number in range(3)]
    assert [pose.x for pose in poses] == pytest.approx([0.0, -STEP, -2 * STEP])


def test_put_elsewhere_it_begins_there():
    recent = Recent()
    for x in (0.0, STEP, 2 * STEP, 5.0):
        found = recent.corrected(Observation(CONTROL_DT, Pose(x, 0.0, 0.0), bumper=(True, True))).pose
    assert found == Pose(5.0, 0.0, 0.0)


@pytest.mark.parametrize('slant', [0.0, 0.5, -0.9])
def test_after_ten_contacts_with_a_wall_it_knows_how_far_away_that_is(slant):
    """By its wheels alone, the wall would be decimetres off by then."""
    plan = room(4.0, 4.0, 0.02)
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(4.0 - RADIUS - 0.1, 2.0, slant))
    context, source = Context.without_map(world.config, CleaningConfig()), DeadReckoning()
    off, wheels = [], []
    for number in range(300):
        seen = observe(world, 'rumba', CONTROL_DT, source)
        wheels.append(seen.pose.x - robot.pose.x)
        off.append(context.sense(seen).pose.x - robot.pose.x)
        robot.command(0.25 if number % 30 < 15 else -0.25, 0.0, world.tick)
        world.step(CONTROL_TICKS)
    assert robot.bumps >= 8
    assert max(map(abs, off)) < 0.04 < 0.1 < wheels[-1]
