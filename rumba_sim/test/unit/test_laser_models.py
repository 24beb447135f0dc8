"""Lasers that people buy: where their beams go, what errors they make, and what they tell if there is no echo."""

import dataclasses
import math

import numpy as np
import pytest
import yaml
from pytest import approx
from rooms import crooked, hall, quiet, room
from things import box, disc

from rumba_sim.model.common import yaml_file
from rumba_sim.model.common.config import from_mapping, updated
from rumba_sim.model.common.errors import ConfigError, WorldError
from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.devices.laser_scan import laser_scan
from rumba_sim.model.kernel.sensors import laser as kernel
from rumba_sim.model.settings.laser_config import MODELS, LaserConfig
from rumba_sim.model.settings.mounting import Mounting
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.worlds import Worlds

REAL = [model for model in MODELS if model != 'ideal']
EXACT = {'noise': 0.0, 'relative_noise': 0.0, 'bias': 0.0, 'relative_bias': 0.0, 'resolution': 0.0, 'dropouts': 0.0,
         'beam_width': 0.0, 'sure_range': 1000.0}


def model_of(name, **changes):
    """A laser of a model, but for changes."""
    return from_mapping(LaserConfig, {'model': name, **changes}, 'test')


def world_with(laser, plan=None, pose=Pose(2.1, 1.3, 0.7), seed=0, obstacles=()):
    """A world with a robot that has a laser."""
    world = World(plan or crooked(), dataclasses.replace(quiet(), laser=laser), seed=seed, obstacles=obstacles)
    world.spawn('rumba', pose)
    return world


def scans(world, count):
    """Many scans: float64 (count, beams)."""
    return np.array([world.scan('rumba') for _ in range(count)])


# --- the settings -------------------------------------------------------------------------------------------------

def test_a_model_sets_what_depends_on_it_and_what_is_given_beside_it_overrides_that():
    laser = model_of('urg04lx', noise=0.1)
    assert (laser.beams, laser.per_turn, laser.range_max, laser.nothing) == (682, 1024, 5.6, 'zero')
    assert laser.noise == 0.1 and laser.relative_noise == 0.005
    assert laser.first_angle + 340 * laser.increment == approx(0.0) and model_of('ideal') == LaserConfig()
    assert math.degrees(681 * laser.increment) == approx(239.4, abs=0.1)
    tim = model_of('tim561')
    assert tim.first_angle + 810 * tim.increment == approx(0.75 * math.pi)


def test_another_model_takes_nothing_over_but_the_mounting_and_the_direction():
    mounted = model_of('tim561', x=0.1, upside_down=True, clockwise=True, noise=0.5)
    assert updated(mounted, {'model': 'lds01'}, 'test') == model_of('lds01', x=0.1, upside_down=True, clockwise=True)
    assert updated(mounted, {'noise': 0.1}, 'test') == dataclasses.replace(mounted, noise=0.1)


@pytest.mark.parametrize('model', MODELS)
def test_whoever_changes_the_model_in_a_printed_file_gets_that_model(model):
    text = yaml_file.as_yaml(RobotConfig()).replace('model: ideal', f'model: {model}')
    assert from_mapping(RobotConfig, yaml.safe_load(text), 'test').laser == model_of(model)


def test_a_printed_file_keeps_what_is_not_as_the_model_has_it():
    laser = model_of('lds01', noise=0.3, x=0.2)
    assert from_mapping(LaserConfig, yaml.safe_load(yaml_file.as_yaml(laser)), 'test') == laser


@pytest.mark.parametrize('model', MODELS)
def test_all_settings_of_a_robot_make_the_same_robot_again(model):
    config = dataclasses.replace(RobotConfig(), laser=model_of(model, noise=0.3))
    assert from_mapping(RobotConfig, dataclasses.asdict(config), 'test') == config


@pytest.mark.parametrize('mapping, message', [
    ({'model': 'lds02'},
     r"^here: model is 'lds02': must be ideal or rplidar_a1 or lds01 or urg04lx or tim561 or camera$"),
    ({'per_turn': 359}, r'laser/per_turn is 359: must be 0, or not below beams, 360$'),
    ({'model': 'urg04lx', 'beams': 1025}, r'laser/per_turn is 1024: must be 0, or not below beams, 1025$')])
def test_a_wrong_laser_is_refused(mapping, message):
    with pytest.raises(ConfigError, match=message):
        from_mapping(LaserConfig, mapping, 'here')


# --- where beams go -----------------------------------------------------------------------------------------------

@pytest.mark.parametrize('changes', [
    {'x': 0.1, 'y': -0.05}, {'yaw': math.pi}, {'x': -0.08, 'yaw': 2.5}, {'upside_down': True}, {'clockwise': True},
    {'x': 0.12, 'y': 0.03, 'yaw': -1.0, 'upside_down': True}, {'clockwise': True, 'upside_down': True, 'yaw': 0.5},
    {'first_angle': 0.0}, {'first_angle': 2.0 * math.pi, 'clockwise': True}, {'beams': 90, 'yaw': 1.1},
    {'first_angle': -0.75 * math.pi, 'beams': 271, 'x': 0.1}, {'beams': 1}, {'beams': 90, 'clockwise': True}])
@pytest.mark.parametrize('theta', [0.7, -2.9])
def test_a_mounted_laser_sees_what_one_at_its_place_sees_in_another_order(changes, theta):
    things = [disc('leg', 2.0, 2.2, 0.05), box('crate', 1.2, 1.6, 0.6, 0.4, 0.2), disc('bin', 3.2, 1.2, 0.15)]
    laser = LaserConfig(**{'beams': 360, 'per_turn': 360, 'noise': 0.0, **changes})
    robot = Pose(2.1, 1.3, theta)
    place = compose(robot, Pose(laser.x, laser.y, laser.yaw))
    mounted, there = world_with(laser, pose=robot, obstacles=things), world_with(quiet().laser, obstacles=things)
    there._states['x'], there._states['y'], there._states['theta'] = place
    all_around = there.scan('rumba')
    side = -1.0 if laser.upside_down else 1.0
    angles = side * (laser.first_angle + laser.increment * np.arange(laser.beams))
    beams = np.rint((angles + math.pi) / math.radians(1.0)).astype(int) % 360
    seen = mounted.scan('rumba')
    assert len(seen) == laser.beams and np.isfinite(seen).all()
    assert np.sum(abs(seen - all_around[beams]) > 1e-6) <= 1  # a beam that passes a corner by less than rounding


def test_a_partial_fan_sees_another_robot_only_where_it_looks():
    laser = LaserConfig(beams=91, per_turn=360, first_angle=-0.25 * math.pi, noise=0.0)
    for bearing, is_seen in ((0.0, True), (0.7, True), (-0.7, True), (1.6, False), (math.pi, False), (-1.6, False)):
        world = world_with(laser, hall(), Pose(10.0, 10.0, 1.0))
        world.spawn('other', Pose(10.0 + math.cos(1.0 + bearing), 10.0 + math.sin(1.0 + bearing), 0.0))
        seen = world.scan('rumba')
        assert np.isfinite(seen).any() == is_seen
        if is_seen:
            assert seen[np.rint(math.degrees(bearing) + 45.0).astype(int)] == approx(1.0 - 0.17425, abs=0.001)


# --- errors -------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('model, distance, deviation', [
    ('rplidar_a1', 0.4, 0.005), ('rplidar_a1', 5.0, 0.05), ('lds01', 0.2, 0.005), ('lds01', 3.0, 0.0525),
    ('urg04lx', 0.5, 0.005), ('urg04lx', 3.0, 0.015), ('tim561', 0.5, 0.02), ('tim561', 7.0, 0.02)])
def test_noise_is_as_the_data_sheet_has_it(model, distance, deviation):
    laser = model_of(model, beams=1, per_turn=0, first_angle=0.0, bias=0.0, relative_bias=0.0)
    world = world_with(laser, room(9.0, 2.0), Pose(9.0 - distance, 1.0, 0.0))
    seen = scans(world, 2000)
    seen = seen[(seen > laser.range_min) & (seen < laser.range_max)]
    assert np.std(seen) == approx(deviation, rel=0.08) and np.mean(seen) == approx(distance, abs=0.005)
    steps = seen / laser.resolution
    assert np.allclose(steps, np.rint(steps), atol=1e-6)


def test_a_systematic_error_stays_that_of_a_robot_and_within_the_limits_of_its_maker():
    laser = model_of('tim561', noise=0.0, resolution=0.0, dropouts=0.0, beam_width=0.0)
    found = []
    for seed in range(60):
        world = world_with(laser, room(9.0, 2.0), Pose(7.0, 1.0, 0.0), seed)
        ahead = scans(world, 3)[:, 405]
        assert ahead[0] == ahead[1] == ahead[2]
        found.append(ahead[0] - 2.0)
    assert np.std(found) == approx(0.03, rel=0.25) and max(np.abs(found)) <= 0.06 + 1e-6
    world.spawn('other', Pose(3.0, 1.0, 0.0))
    assert world.noise.biases[0] != world.noise.biases[1]


def test_a_systematic_error_grows_with_the_range_if_the_data_sheet_says_so():
    laser = model_of('lds01', noise=0.0, relative_noise=0.0, resolution=0.0, dropouts=0.0, beam_width=0.0)
    errors = {}
    for distance in (0.2, 1.5, 3.0):
        world = world_with(laser, room(9.0, 9.0), Pose(9.0 - distance, 4.5, 0.0), seed=3)
        errors[distance] = (world.scan('rumba')[0] - distance) / world.noise.biases[0]
    assert errors == approx({0.2: 0.0056, 1.5: 0.0179 * 1.5, 3.0: 0.0179 * 3.0}, abs=1e-6)


def test_a_world_that_is_loaded_goes_on_with_the_same_laser():
    world = world_with(model_of('tim561'), seed=5)
    state = world.state()
    again = World.restored(state, world.plan, world.config, world.step_rate, world.seed)
    np.testing.assert_array_equal(again.scan('rumba'), world.scan('rumba'))
    assert again.noise.biases == world.noise.biases


@pytest.mark.parametrize('distance, missing', [(1.0, 0.003), (4.0, 0.003), (4.848, 0.503), (5.4, 0.87)])
def test_echoes_are_missed_now_and_then_and_often_beyond_what_the_maker_promises(distance, missing):
    laser = model_of('urg04lx', beams=1, per_turn=0, first_angle=0.0, noise=0.0, relative_noise=0.0)
    seen = scans(world_with(laser, room(9.0, 2.0), Pose(9.0 - distance, 1.0, 0.0)), 4000)
    assert np.mean(seen == 0.0) == approx(missing, abs=0.02)
    assert np.mean(seen == 0.0) > 0.0


@pytest.mark.parametrize('nothing, far, near', [
    ('rep117', math.inf, -math.inf), ('inf', math.inf, math.inf), ('zero', 0.0, 0.0), ('nan', math.nan, math.nan)])
def test_what_has_no_echo_or_is_too_near_is_told_as_the_driver_does(nothing, far, near):
    laser = LaserConfig(beams=4, range_min=0.6, range_max=3.0, noise=0.0, nothing=nothing)
    seen = world_with(laser, room(6.0, 4.0), Pose(0.5, 2.0, 0.0)).scan('rumba')
    np.testing.assert_array_equal(seen[[0, 2]], [near, far])
    assert seen[[1, 3]] == approx([2.0, 2.0], abs=1e-6)


@pytest.mark.parametrize('model', REAL)
def test_a_range_is_within_its_limits_or_what_the_driver_tells_of_none(model):
    laser = model_of(model)
    seen = scans(world_with(laser, hall(), Pose(2.0, 3.0, 1.85)), 30)
    is_range = (seen >= laser.range_min) & (seen < laser.range_max)
    assert 0.1 < is_range.mean() < 0.999
    np.testing.assert_array_equal(seen[~is_range], laser.too_far)


# --- beams of some width ------------------------------------------------------------------------------------------

def wide(**changes):
    """A laser of wide beams that makes no other errors."""
    return LaserConfig(**{'beams': 720, 'noise': 0.0, 'beam_width': 0.01, **changes})


def test_at_an_edge_a_range_lies_between_near_and_far_and_at_straight_walls_it_is_right():
    plan, pose = room(4.0, 3.0, boxes=[(2.0, 0.0, 2.3, 1.2)]), Pose(1.0, 0.6, 0.4)
    exact = world_with(wide(beam_width=0.0), plan, pose).scan('rumba')
    seen = scans(world_with(wide(), plan, pose), 200)
    is_off = np.abs(seen - exact) > 0.01
    mixed = np.flatnonzero(is_off.any(axis=0))
    assert 1 <= len(mixed) <= 4  # at the upper corner of the box
    for beam in mixed:
        low, high = np.min(exact[beam - 1:beam + 2]), np.max(exact[beam - 1:beam + 2])
        assert np.all((seen[:, beam] >= low - 0.01) & (seen[:, beam] <= high + 0.01))
        assert np.std(seen[:, beam]) > 0.02
    others = np.setdiff1d(np.arange(720), mixed)
    assert np.abs(seen[:, others] - exact[others]).max() < 0.01


def test_surfaces_that_are_too_far_apart_do_not_mix():
    plan, pose = room(4.0, 3.0, boxes=[(2.0, 0.0, 2.3, 1.2)]), Pose(1.0, 0.6, 0.4)
    exact = world_with(wide(beam_width=0.0), plan, pose).scan('rumba')
    seen = scans(world_with(wide(mixing_depth=0.3), plan, pose), 20)
    assert np.abs(seen - exact).max() < 0.01


def test_a_wall_that_a_beam_only_grazes_sends_no_echo_back():
    plan, pose = room(15.0, 4.0), Pose(1.0, 0.3, 0.0)
    exact = world_with(wide(beam_width=0.0, range_max=12.0), plan, pose).scan('rumba')
    seen = world_with(wide(range_max=12.0), plan, pose).scan('rumba')
    angles = np.degrees(wide().first_angle + wide().increment * np.arange(720))
    on_wall = (exact < 11.0) & (angles < 0.0) & (angles > -90.0)  # the wall on the right, up to the end of the room
    grazes = on_wall & (angles > -4.9)
    assert grazes.sum() > 3 and np.isposinf(seen[grazes]).all()
    assert np.isfinite(seen[on_wall & (angles < -5.1)]).all()


# --- the same everywhere ------------------------------------------------------------------------------------------

@pytest.mark.parametrize('model', MODELS)
def test_compiled_and_plain_kernel_tell_the_same(model):
    world = world_with(model_of(model, x=0.05, yaw=0.4), obstacles=[
        disc('leg', 2.0, 2.2, 0.05), box('crate', 1.2, 1.6, 0.6, 0.4, 0.2)])
    laser = world.config.laser
    noise = np.empty((laser.draws, laser.beams))
    world.noise.draw_laser(0, noise)
    told = np.empty((2, laser.beams))
    for functions, ranges in zip((fast, kernel), told):
        functions.scan(world.arrays.robots, 0, world.constants, world.arrays.obstacles, world.terrain.skips,
                       world.fans, noise, world.noise.biases[0], ranges)
    np.testing.assert_allclose(told[0], told[1], 1e-9, 1e-9)


@pytest.mark.parametrize('model', MODELS)
def test_scans_repeat_and_another_robot_changes_none(model):
    alone, again, beside = (world_with(model_of(model), hall(), Pose(3.0, 3.0, 1.0), 8) for _ in range(3))
    beside.spawn('far', Pose(17.0, 17.0, 0.0))
    for _ in range(3):
        beside.scan('far')
        seen = alone.scan('rumba')
        np.testing.assert_array_equal(again.scan('rumba'), seen)
        np.testing.assert_array_equal(beside.scan('rumba'), seen)


def test_many_worlds_scan_as_each_of_them_alone():
    def made():
        return [world_with(model_of('tim561', x=0.1), seed=seed) for seed in range(3)]
    worlds, alone = Worlds(made()), made()
    for _ in range(2):
        for seen, world in zip(worlds.scan(), alone):
            np.testing.assert_array_equal(seen, world.scan('rumba'))
    with pytest.raises(WorldError, match='the lasers ideal and tim561 have other beams: must be the same in all'):
        Worlds([world_with(model_of('tim561', beams=360, per_turn=0)), world_with(model_of('ideal'))])


# --- when, and what is told of it ---------------------------------------------------------------------------------

@pytest.mark.parametrize('model, rate', [
    ('ideal', 50), ('rplidar_a1', 5), ('lds01', 5), ('urg04lx', 10), ('tim561', 10)])
def test_a_laser_tells_scans_as_fast_as_it_turns_as_far_as_ticks_allow(model, rate):
    world = world_with(model_of(model))
    due = []
    for _ in range(100):
        world.step()
        due.append(world.is_scan_due)
    assert sum(due) == 2 * rate and due[0] and due == (([True] + [False] * (50 // rate - 1)) * 2 * rate)
    assert model_of('tim561').rate_at(60) == 15


def test_a_scan_has_the_numbers_of_a_message_and_the_mounting():
    world = world_with(model_of('urg04lx', x=0.1, yaw=1.0, upside_down=True))
    told = laser_scan(world, 'rumba')
    assert told.ranges.dtype == np.float32 and told.ranges.shape == (682,)
    assert (told.range_min, told.range_max) == (float(np.float32(0.02)), float(np.float32(5.6)))
    assert told.angle_min + 340 * told.angle_increment == approx(0.0, abs=1e-4)
    assert told.mounting == Mounting(0.1, 0.0, 1.0, True)
