"""The settings of a robot: each is documented and in its range, and reaches the kernel."""

import ast
import dataclasses
import inspect
import math
import re

import numpy as np
import pytest
from pytest import approx
from rooms import crooked, quiet

from rumba_sim.model.common.config import describe, from_mapping, leaves, updated
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import kernel_modules
from rumba_sim.model.floors.constants import Constants, check_speed, constants
from rumba_sim.model.settings.robot_config import DockConfig, RobotConfig

LEAVES = dict(leaves(RobotConfig))
NUMBERS = {path: field for path, field in LEAVES.items() if type(field.default) in (float, int)}


def nested(path, value):
    """{'a': {'b': value}} of a/b."""
    first, _, rest = path.partition('/')
    return {first: nested(rest, value) if rest else value}


def test_every_setting_tells_its_meaning():
    assert all(field.metadata['doc'] for field in LEAVES.values())


@pytest.mark.parametrize('path', NUMBERS)
def test_every_number_has_a_range_that_holds_its_default(path):
    field = LEAVES[path]
    assert field.metadata['low'] <= field.default <= field.metadata['high']
    section, _, name = path.partition('/')
    at_limits = [field.metadata['low'], field.metadata['high']]
    for limit in map(type(field.default), at_limits):
        try:
            settings = from_mapping(RobotConfig, nested(path, limit), 'here')
        except ConfigError as error:  # a range may depend on another setting
            assert path.startswith(('dock/contact', 'dock/release')) and 'must not be below' in str(error)
        else:
            assert getattr(getattr(settings, section), name) == limit


@pytest.mark.parametrize('path', NUMBERS)
@pytest.mark.parametrize('side', ['low', 'high'])
def test_a_value_beyond_its_range_is_refused_by_its_path(path, side):
    field = LEAVES[path]
    limit = field.metadata[side]
    wrong = type(field.default)(limit - 1 if side == 'low' else limit * 2 + 1)
    with pytest.raises(ConfigError, match=rf'^here: {path} is {re.escape(repr(wrong))}: must be '):
        from_mapping(RobotConfig, nested(path, wrong), 'here')


@pytest.mark.parametrize('mapping, message', [
    ({'batery': {}}, r"^here: batery is unknown: did you mean 'battery'\?$"),
    ({'battery': {'drian': 2.0}}, r"^here: battery/drian is unknown: did you mean 'drain'\?$"),
    ({'battery': 3}, r'^here: battery is 3: must be a mapping of capacity, resistance, '),
    ({'brush': None}, r'^here: brush is None: must be a mapping of width, pickup$'),
    ({'laser': {'beams': 360.0}}, r'^here: laser/beams is 360\.0: must be 1 to 10000$'),
    ({'drive': {'radius': '0.2'}}, r"^here: drive/radius is '0\.2': must be 0\.02 to 5 \[m\]$"),
    ({'dock': {'release_distance': 0.05}}, r'release_distance is 0\.05: must not be below contact_distance, 0\.075$'),
    ({'dock': {'contact_angle': 0.2}}, r'release_angle is 0\.157: must not be below contact_angle, 0\.2$'),
])
def test_a_wrong_setting_is_named_by_its_path(mapping, message):
    with pytest.raises(ConfigError, match=message):
        from_mapping(RobotConfig, mapping, 'here')


def test_contacts_may_open_at_the_distance_at_which_they_close():
    dock = DockConfig(contact_distance=0.1, release_distance=0.1, contact_angle=0.157)
    assert dock.release_angle == dock.contact_angle == 0.157


def test_a_description_names_every_path_once():
    lines = describe(RobotConfig).splitlines()
    assert [line.split()[0] for line in lines] == list(LEAVES)
    assert 'drive/wheel_base' in LEAVES and 'battery/drain' in LEAVES


def test_an_update_keeps_all_other_settings():
    config = updated(quiet(), {'battery': {'drain': 9.0}, 'laser': {'beams': 10}}, 'here')
    assert config == dataclasses.replace(
        quiet(), battery=dataclasses.replace(quiet().battery, drain=9.0),
        laser=dataclasses.replace(quiet().laser, beams=10))


# --- the constants of the kernel ----------------------------------------------------------------------------------

@pytest.mark.parametrize('name', Constants._fields)
def test_a_constant_that_is_left_out_or_misspelt_is_an_error(name):
    values = dict.fromkeys(Constants._fields, 1)
    del values[name]
    with pytest.raises(TypeError, match=f"missing 1 required positional argument: '{name}'"):
        Constants(**values)
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}_'"):
        Constants(**values, **{f'{name}_': 1})


def test_the_kernel_reads_every_constant_and_no_other():
    read = {node.attr for module in kernel_modules() for node in ast.walk(ast.parse(inspect.getsource(module)))
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == 'k'}
    assert read == set(Constants._fields)


def test_the_constants_have_the_values_of_the_configuration_and_of_the_plan():
    config = from_mapping(RobotConfig, {'drive': {'wheel_base': 0.3, 'dead_band': 0.02},
                                        'battery': {'drain': 3.0, 'taper_start': 0.7}}, 'here')
    k = constants(config, crooked(dock=Pose(3.8, 1.0, 0.5)), 40)[0]
    assert (k.wheel_base, k.dead_band, k.drain, k.taper_start) == (0.3, 0.02, 3.0, 0.7)
    assert (k.dt, k.timeout_ticks, k.resolution, k.origin_x) == (0.025, 20, 0.05, -0.05)
    assert k.ticks_per_metre == approx(508.8 / (math.pi * 0.072))
    assert k.sample_pitch == approx(0.01)
    assert k.takes[:3] == approx((0.9, 0.09, 0.009))
    assert k.takes.tolist() == [0.9 * (1.0 - 0.9) ** passes for passes in range(len(k.takes))]  # on each processor
    none = {'origin_x', 'origin_y', 'has_layers', 'has_cliffs', 'noise', 'relative_noise', 'range_bias',
            'relative_bias', 'range_step', 'dropouts', 'beam_width', 'laser_x', 'laser_y'}  # here, and of this laser
    for name in k.dtype.names:
        assert np.all(np.isfinite(k[name])) or name in ('too_far', 'too_near')
        assert np.all(k[name] != 0.0) or name in none, name


def another(path, field):
    """A value of a setting, near its default if that is not 0."""
    if field.metadata['choices']:
        return field.metadata['choices'][-1]
    if type(field.default) is bool:
        return not field.default
    if field.default == 0:
        return type(field.default)(0.5 * field.metadata['high'])
    return type(field.default)(field.default * (1.05 if path.startswith('dock/release') else 0.95))


@pytest.mark.parametrize('section', ['drive', 'battery', 'odometry', 'bumper', 'cliff', 'laser', 'dock', 'brush'])
def test_every_setting_changes_the_constants_or_is_used_elsewhere(section):
    """Settings are changed one by one: a setting that no constant is computed from would be noticed."""
    elsewhere = {'odometry/scale_error', 'laser/rate', 'battery/resistance'}
    plan = crooked(dock=Pose(3.8, 1.0, 0.5))
    before = constants(RobotConfig(), plan, 1000)[0]
    for path, field in LEAVES.items():
        if path.startswith(section) and path not in elsewhere:
            after = constants(from_mapping(RobotConfig, nested(path, another(path, field)), 'here'), plan, 1000)[0]
            assert any(np.any(before[name] != after[name]) for name in Constants._fields), path


@pytest.mark.parametrize('layers, has_layers, has_cliffs', [
    ({}, False, False), ({'cliff': (0.0, 0.0, 1.0, 1.0)}, True, True), ({'carpet': (0.0, 0.0, 1.0, 1.0)}, True, False)])
def test_a_plan_tells_the_constants_whether_it_has_layers(layers, has_layers, has_cliffs):
    k = constants(RobotConfig(), crooked(**layers), 50)[0]
    assert (bool(k.has_layers), bool(k.has_cliffs)) == (has_layers, has_cliffs)


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
def test_the_reach_is_larger_than_the_radius_by_no_more_than_the_error_of_interpolation(resolution):
    k = constants(RobotConfig(), crooked(resolution), 50)[0]
    assert 0.0 < k.reach - 0.17425 < resolution ** 2


def test_the_limit_of_speed_is_still_allowed():
    config = quiet(drive={'radius': 0.1, 'max_speed': 1.0})
    check_speed(config, 10)
    with pytest.raises(ConfigError, match=r'^drive/max_speed is 1: at 9 ticks a second must be at most 0\.9 \[m/s\]'):
        check_speed(config, 9)


def test_the_limit_of_cell_size_is_still_allowed():
    assert constants(quiet(drive={'radius': 0.1}), crooked(0.1), 50)[0].radius == 0.1
    with pytest.raises(MapError, match=r'^room: cells of 0\.1 m are too coarse for a robot of radius 0\.09 m$'):
        constants(quiet(drive={'radius': 0.09}), crooked(0.1), 50)
