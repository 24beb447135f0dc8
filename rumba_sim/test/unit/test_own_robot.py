"""The file that says what a robot of somebody else is like."""

import pytest

from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.settings.mounting import Mounting
from rumba_sim.model.settings.own_robot import load
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.common.frames import frames
from rumba_sim.ros.common.own_robots import frames_of, own_robot


def written(folder, text):
    """A file with a text."""
    path = folder / 'robot.yaml'
    path.write_text(text)
    return str(path)


def test_what_the_file_leaves_out_is_as_for_a_rumba_and_tf_tells_where_the_laser_is(tmp_path):
    own = load(written(tmp_path, 'drive: {radius: 0.105, wheel_base: 0.16}\nlaser: {range_max: 3.5}'))
    assert (own.config.drive.radius, own.config.drive.wheel_base) == (0.105, 0.16)
    assert own.config.brush == RobotConfig().brush
    assert type(own.config) is RobotConfig
    assert own.mounting is None
    assert (own.frames.odom, own.frames.base) == ('odom', 'base_link')


def test_the_place_of_the_laser_counts_if_the_file_has_any_part_of_it(tmp_path):
    own = load(written(tmp_path, 'laser: {x: -0.03, upside_down: true}'))
    assert own.mounting == Mounting(-0.03, 0.0, 0.0, True)


def test_frames_are_those_of_the_file_or_go_by_the_name(tmp_path):
    own = own_robot(written(tmp_path, 'frames: {odom: /wheels, base: chassis}'))
    assert frames_of('rumba2', own)[:3] == ('wheels', 'chassis', 'chassis')
    assert frames_of('rumba2', own_robot('')) == frames('rumba2')


@pytest.mark.parametrize('text, message', [
    ('drive: {radios: 1}', "drive/radios is unknown: did you mean 'radius'"),
    ('drive: {radius: 0}', 'drive/radius is 0.0: must be'),
    ('frames: {base: /}', "frames/base is '/': must be the name of a frame"),
    ('laser: 3', 'laser is 3: must be a mapping'),
    ('- 1', 'must hold keys and values')])
def test_what_is_wrong_is_named_with_file_and_key(tmp_path, text, message):
    path = written(tmp_path, text)
    with pytest.raises(ConfigError) as caught:
        load(path)
    assert str(caught.value).startswith(f'{path}: {message}')


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigError, match='missing.yaml'):
        own_robot(str(tmp_path / 'missing.yaml'))
