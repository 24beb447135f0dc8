"""The README lists exactly the parameters, programs, launch files and definitions of the package."""

import pathlib
import re

from turtlesim.ros import turtle_teleop_key, turtlesim_node

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
README = (PACKAGE / 'README.md').read_text()


def test_it_lists_every_parameter_with_its_default():
    rows = dict(re.findall(r'^\| `~(\w+)`[^|]* \| ([^|]+) \|', README, re.MULTILINE))
    background = ', '.join(str(turtlesim_node.PARAMETERS[name].default) for name in turtlesim_node.BACKGROUND)
    expected = {name: f'{parameter.default:g}' if isinstance(parameter.default, float) else str(parameter.default)
                for name, parameter in turtlesim_node.PARAMETERS.items() if name not in turtlesim_node.BACKGROUND}
    assert rows == {**expected, 'background_r': background}
    for name, parameter in turtle_teleop_key.SCALES.items():
        assert f'rosparam set {name} {parameter.default:g}' in README


def test_it_lists_every_program_and_launch_file():
    assert set(re.findall(r'^\| `rosrun turtlesim (\w+)', README, re.MULTILINE)) == {
        path.name for path in (PACKAGE / 'scripts').iterdir()}
    assert set(re.findall(r'^\| `roslaunch turtlesim ([\w.]+)`', README, re.MULTILINE)) == {
        path.name for path in (PACKAGE / 'launch').iterdir()}


def test_it_lists_every_definition():
    for path in [*(PACKAGE / 'msg').iterdir(), *(PACKAGE / 'srv').iterdir()]:
        assert re.search(rf'`(turtlesim/)?{path.stem}`', README), path.name
