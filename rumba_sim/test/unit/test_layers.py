"""Arrows point one way: model <- cleaning <- evaluation <- ros, viewer <- scripts; what is pure knows no ROS, no Qt."""

import ast
import pathlib

import pytest

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
SOURCE = PACKAGE / 'src' / 'rumba_sim'
LAYERS = {
    'model': {'model'},
    'cleaning': {'model', 'cleaning'},
    'evaluation': {'model', 'cleaning', 'evaluation'},
    'ros': {'model', 'cleaning', 'evaluation', 'ros'},
    'viewer': {'model', 'ros', 'viewer'},
}
PURE = ('model', 'cleaning', 'evaluation')
NOT_PURE = ('rospy', 'roslib', 'rospkg', 'actionlib', 'rosbag', 'tf', 'tf2', 'python_qt_binding', 'PyQt5')
MODULES = sorted(SOURCE.glob('*/**/*.py'))


def imports(path):
    """Full names of all that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{path}: relative import'
            yield from (f'{node.module}.{alias.name}' for alias in node.names)


def layer(path):
    """Name of the layer that a module of this package belongs to."""
    return path.relative_to(SOURCE).parts[0]


def test_every_folder_is_a_known_layer():
    assert {layer(path) for path in MODULES} <= set(LAYERS)


@pytest.mark.parametrize('path', MODULES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_a_module_imports_only_from_its_layer_and_those_below(path):
    for name in imports(path):
        if name.startswith('rumba_sim.'):
            assert name.split('.')[1] in LAYERS[layer(path)], name


@pytest.mark.parametrize('path', [path for path in MODULES if layer(path) in PURE], ids=lambda path: path.name)
def test_a_pure_module_imports_no_ros_no_messages_no_window_and_no_clock(path):
    for name in imports(path):
        top = name.split('.')[0]
        assert top not in NOT_PURE and not top.endswith(('_msgs', '_msg', '_srvs', '_ros')) and top != 'time', name


@pytest.mark.parametrize('path', sorted((PACKAGE / 'scripts').iterdir()), ids=lambda path: path.name)
def test_a_script_is_a_few_lines_executable_and_installed(path):
    assert len(path.read_text().splitlines()) <= 5
    assert path.stat().st_mode & 0o111
    assert f'scripts/{path.name}\n' in (PACKAGE / 'CMakeLists.txt').read_text()
