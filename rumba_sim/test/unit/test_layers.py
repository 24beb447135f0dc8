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
QT = ('PyQt5',)
NOT_PURE = ('rospy', 'roslib', 'rospkg', 'rosgraph', 'actionlib', 'rosbag', 'tf', 'tf2', *QT)
OF_MESSAGES = ('_msgs', '_msg', '_srvs', '_ros')
# Of the viewer: what speaks with ROS, and what is made of plain values.
VIEWER_WITH_ROS = ('viewer', 'application', 'listener', 'robot_ear', 'surroundings', 'actor', 'hands')
VIEWER_WITHOUT_QT = ('snapshot', 'view_transform', 'track', 'dock_field', 'theme', 'acts', 'files')
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
        assert top not in NOT_PURE and not top.endswith(OF_MESSAGES) and top != 'time', name


@pytest.mark.parametrize('path', [path for path in MODULES if layer(path) == 'viewer'
                                  and path.stem not in VIEWER_WITH_ROS], ids=lambda path: path.name)
def test_what_paints_and_what_shows_knows_neither_ros_nor_messages(path):
    for name in imports(path):
        top = name.split('.')[0]
        assert top in QT or top not in NOT_PURE and not top.endswith(OF_MESSAGES), name
        assert not name.startswith('rumba_sim.ros'), name
        assert not name.startswith('rumba_sim.viewer') or name.split('.')[2] not in VIEWER_WITH_ROS, name


@pytest.mark.parametrize('path', [path for path in MODULES if layer(path) == 'viewer'
                                  and path.stem in VIEWER_WITHOUT_QT], ids=lambda path: path.name)
def test_what_is_made_of_plain_values_in_the_viewer_knows_no_qt(path):
    for name in imports(path):
        assert name.split('.')[0] not in QT, name
        assert not name.startswith('rumba_sim.viewer') or name.split('.')[2] in VIEWER_WITHOUT_QT, name


@pytest.mark.parametrize('path', sorted((PACKAGE / 'scripts').iterdir()), ids=lambda path: path.name)
def test_a_script_is_a_few_lines_executable_and_installed(path):
    assert len(path.read_text().splitlines()) <= 5
    assert path.stat().st_mode & 0o111
    assert f'scripts/{path.name}\n' in (PACKAGE / 'CMakeLists.txt').read_text()
