"""Packages and the folders in them depend one way; package.xml, imports and docs/architecture.md agree on it."""

import ast
import pathlib
import re
import xml.etree.ElementTree as ElementTree

import pytest
from workspaces import ROOT

from rumba_sim.ros.common import definitions

KERNEL_FOLDERS = {'model/kernel', 'model/kernel/sensors', 'model/kernel/sweeping', 'model/kernel/ticking'}
MODEL_FOLDERS = {'model/common', 'model/settings', 'model/compiling', 'model/maps', 'model/floors', 'model/simulation',
                 'model/devices', *KERNEL_FOLDERS}
MODEL = {'model', *MODEL_FOLDERS}
SHARED_BY_NODES = {'ros/common', 'ros/running', 'ros/participants'}
# Of each package, from the lowest to the highest: its folders, and which folders of the same package each may import.
# Modules outside these folders belong to ''.
FOLDERS = {
    'rumba_sim': {
        'model/kernel': set(), 'model/kernel/sensors': {'model/kernel'}, 'model/kernel/sweeping': {'model/kernel'},
        'model/kernel/ticking': {'model/kernel', 'model/kernel/sensors', 'model/kernel/sweeping'},
        'model/common': {'model/kernel'}, 'model/settings': {'model/common', *KERNEL_FOLDERS},
        'model/compiling': {'model/common', *KERNEL_FOLDERS},
        'model/maps': {'model/common', 'model/settings', 'model/compiling', *KERNEL_FOLDERS},
        'model/floors': {'model/common', 'model/settings', 'model/compiling', 'model/maps', *KERNEL_FOLDERS},
        'model/simulation': {'model/common', 'model/settings', 'model/compiling', 'model/maps', 'model/floors',
                             *KERNEL_FOLDERS},
        'model/devices': {'model/common', 'model/settings', 'model/compiling', 'model/maps', 'model/floors',
                          'model/simulation', *KERNEL_FOLDERS},
        'model': MODEL_FOLDERS,
        'ros/common': MODEL, 'ros/running': {*MODEL, 'ros/common'}, 'ros/participants': {*MODEL, *SHARED_BY_NODES},
        'ros/robot': {*MODEL, *SHARED_BY_NODES}, 'ros/simulator': {*MODEL, *SHARED_BY_NODES, 'ros/robot'},
        'ros/turtlesim_body': {*MODEL, *SHARED_BY_NODES, 'ros/robot'},
        'ros/teleop_key': {*MODEL, *SHARED_BY_NODES}, 'ros': {*MODEL, *SHARED_BY_NODES}},
    'rumba_localisation': {'': set(), 'mapping/grids': {''}, 'mapping': {'', 'mapping/grids'}, 'logs': {''},
                           'ros': {'', 'mapping', 'mapping/grids', 'logs'}},
    'rumba_cleaning': {
        '': set(), 'edges': {''}, 'belief': {'', 'edges'}, 'behaviours': {'', 'edges', 'belief'},
        'planning/common': {'', 'belief', 'behaviours'}, 'planning/decompose': {'', 'belief', 'planning/common'},
        'planning/simulate': {'', 'edges', 'belief', 'behaviours', 'planning/common'},
        'planning/swaths': {'', 'belief', 'planning/common', 'planning/decompose', 'planning/simulate'},
        'planning/order': {'', 'belief', 'planning/common', 'planning/decompose', 'planning/swaths'},
        'planning/search': {'', 'belief', 'behaviours', 'planning/common', 'planning/simulate', 'planning/swaths',
                            'planning/order'},
        'planning/team': {'', 'belief', 'planning/common', 'planning/simulate'},
        'planning': {'', 'belief', 'behaviours', 'planning/common', 'planning/decompose', 'planning/simulate',
                     'planning/swaths', 'planning/order', 'planning/search'},
        'strategies': {'', 'belief', 'behaviours', 'planning', 'planning/team'},
        'mission': {'', 'edges', 'belief', 'behaviours', 'strategies'},
        'own_robot': set(), 'ros/own_robot': {'own_robot'},
        'ros/cleaner/robots': {'', 'edges', 'belief', 'behaviours', 'strategies', 'mission', 'own_robot'},
        'ros/cleaner/goals': {'', 'edges', 'belief', 'behaviours', 'strategies', 'mission', 'own_robot',
                              'ros/cleaner/robots'},
        'ros/cleaner': {'', 'edges', 'belief', 'behaviours', 'strategies', 'mission', 'own_robot', 'ros/cleaner/robots',
                        'ros/cleaner/goals'}},
    'rumba_evaluation': {
        'inspection': set(), 'scoring': set(), 'trials': {'scoring'}, 'report': set(), 'verdicts': set(),
        'submissions/diagnosis': set(), 'submissions': {'submissions/diagnosis'},
        'marks': {'trials', 'verdicts', 'submissions', 'submissions/diagnosis'}, 'ros/mission_report': {'report'},
        'learning': {'trials'}, 'ros/judge': {'verdicts'},
        'ros': {'scoring', 'trials', 'verdicts', 'marks', 'submissions', 'submissions/diagnosis', 'ros/judge'}},
    'rumba_viewer': {
        'scene': set(), 'painting': {'scene'}, 'window': {'scene', 'painting'}, 'ros': {'scene', 'window'},
        'page/messages': set(), 'page': {'page/messages'}, 'ros/page/rosapi': {'page', 'page/messages'},
        'ros/page': {'page', 'page/messages', 'ros/page/rosapi'}, 'ros/console': {'scene', 'ros'}}}
# Which packages each may import, and which of their folders are there for others.
BELOW = {'rumba_sim': set(), 'rumba_localisation': {'rumba_sim'}, 'rumba_cleaning': {'rumba_sim', 'rumba_localisation'},
         'rumba_evaluation': {'rumba_sim', 'rumba_cleaning'}, 'rumba_viewer': {'rumba_sim', 'rumba_cleaning'}}
OFFERED = {'rumba_sim': {*MODEL, *SHARED_BY_NODES}, 'rumba_localisation': {'', 'mapping', 'mapping/grids'},
           'rumba_cleaning': {'', 'edges', 'belief', 'behaviours', 'strategies', 'mission'}}
ROS = ('rospy', 'roslib', 'rospkg', 'rosgraph', 'rosservice', 'actionlib', 'rosbag', 'rostopic', 'rosunit', 'tf',
       'tf2', 'turtlesim')
ROS_ENDINGS = ('_msgs', '_msg', '_srvs', '_ros')
QT = ('PyQt5',)
CLOCK = ('time',)
WITH_CLOCK = {'rumba_evaluation/submissions', 'rumba_viewer/window'}
WITH_QT = {'rumba_viewer/painting', 'rumba_viewer/window', 'rumba_viewer/ros'}
# How rosdep calls what is imported, if it is not the name of the import.
KEYS = {'PIL': 'python3-pil', 'PyQt5': 'python3-pyqt5', 'matplotlib': 'python3-matplotlib',
        'numba': 'python3-numba', 'numpy': 'python3-numpy', 'rospkg': 'python3-rospkg', 'scipy': 'python3-scipy',
        'skimage': 'python3-skimage', 'tornado': 'python3-tornado', 'tqdm': 'python3-tqdm', 'yaml': 'python3-yaml'}
# Imported only if they are installed.
OPTIONAL = {'create_msgs', 'dask', 'distributed', 'gymnasium', 'stable_baselines3', 'turtlesim'}
SOURCES = [(package, path) for package in FOLDERS
           for path in sorted((ROOT / package / 'src' / package).glob('**/*.py'))]
ARCHITECTURE = (ROOT / 'docs' / 'architecture.md').read_text()


def source(package):
    """The folder of the modules of a package."""
    return ROOT / package / 'src' / package


def folder(package, path):
    """The folder of a module inside its package."""
    return '/'.join(path.relative_to(source(package)).parts[:-1])


def name_of(value):
    """What a test of a module is called."""
    return value if isinstance(value, str) else value.stem


def imports(path):
    """Full names of all that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{path}: relative import'
            yield from (f'{node.module}.{alias.name}' for alias in node.names)


def place(name):
    """Package and folder of something that is imported from our packages by its full name."""
    package, *parts = name.split('.')
    path = source(package)
    while parts and (path / parts[0]).is_dir():
        path /= parts.pop(0)
    return package, '/'.join(path.relative_to(source(package)).parts)


def dependencies(package, kind):
    """What the package.xml of a package names as a dependency of a kind."""
    root = ElementTree.parse(ROOT / package / 'package.xml').getroot()
    return {element.text for element in root.findall(kind)}


@pytest.mark.parametrize('package, path', SOURCES, ids=name_of)
def test_a_module_imports_only_what_its_folder_may(package, path):
    here = folder(package, path)
    for name in imports(path):
        if name.split('.')[0] in FOLDERS:
            other, there = place(name)
            if other == package:
                assert there == here or there in FOLDERS[package][here], name
            else:
                assert other in BELOW[package] and there in OFFERED[other], name


@pytest.mark.parametrize('package, path', [(package, path) for package, path in SOURCES
                                           if not folder(package, path).startswith('ros')], ids=name_of)
def test_outside_the_folder_ros_no_module_imports_ros_messages_or_a_clock(package, path):
    has_clock = f'{package}/{folder(package, path)}' in WITH_CLOCK
    for name in imports(path):
        top = name.split('.')[0]
        assert top not in ROS and not top.endswith(ROS_ENDINGS) and (has_clock or top not in CLOCK), name


@pytest.mark.parametrize('package', FOLDERS)
def test_whatever_imports_messages_has_those_of_the_first_rumba_msg_with_all_of_ours(package):
    first, *_ = imports(source(package) / 'ros' / '__init__.py')
    assert first == ('rumba_sim.ros.common.definitions' if package == 'rumba_sim' else 'rumba_sim.ros.common')
    defined = {f'{path.parent.name}/_{path.stem}' for path in (ROOT / 'rumba_msg').glob('*/*.*')
               if path.suffix in ('.msg', '.srv')}
    defined |= {f'msg/_{path.stem}Action' for path in (ROOT / 'rumba_msg').glob('action/*.action')}
    assert set(definitions.MODULES) == defined


@pytest.mark.parametrize('package, path', SOURCES, ids=name_of)
def test_only_the_folders_of_the_window_import_qt(package, path):
    for name in imports(path):
        assert name.split('.')[0] not in QT or f'{package}/{folder(package, path)}' in WITH_QT, name


KERNEL = 'rumba_sim.model.compiling.compiled.fast'  # the functions of the kernel, compiled


def is_compiled(name):
    """Whether something that is imported by its full name is a function with the decorator `compiled`."""
    package, *parts, function = name.split('.')
    path = source(package).joinpath(*parts).with_suffix('.py')
    return path.is_file() and any(
        isinstance(node, ast.FunctionDef) and node.name == function
        and 'compiled' in [getattr(decorator, 'id', '') for decorator in node.decorator_list]
        for node in ast.walk(ast.parse(path.read_text())))


def is_seen(name, names):
    """Whether numba sees it change if a compiled file imports all these names: by a compiled function of its file."""
    files = {other.rpartition('.')[0] for other in names if is_compiled(other)}
    return is_compiled(name) or name.rpartition('.')[0] in files or name == KERNEL or (
        KERNEL in names and is_of_the_kernel(name))


def is_of_the_kernel(name):
    """Whether something that is imported by its full name belongs to the kernel."""
    package, there = place(name)
    return package == 'rumba_sim' and there in KERNEL_FOLDERS


def test_compiled_files_use_of_others_only_what_numba_sees_change():
    ours = {path: {name for name in imports(path) if name.split('.')[0] in FOLDERS} for _, path in SOURCES}
    decorator = 'rumba_sim.model.compiling.jit.compiled'
    found = [names - {decorator} for names in ours.values() if decorator in names]
    assert found and all(is_seen(name, names) for names in found for name in names)
    assert not is_seen('rumba_sim.model.common.geometry.compose', {'rumba_sim.model.common.geometry.compose'})
    assert not is_compiled('rumba_sim.model.common.geometry.compose')
    assert not is_compiled('rumba_sim.model.compiling.jit')
    assert all(is_of_the_kernel(name) for name in ours[source('rumba_sim') / 'model' / 'compiling' / 'batch.py'])


@pytest.mark.parametrize('package', FOLDERS)
def test_the_tests_of_a_package_use_no_package_above_it(package):
    imported = {name.split('.')[0] for path in (ROOT / package / 'test').glob('**/*.py') for name in imports(path)}
    assert imported & set(FOLDERS) <= {package, *BELOW[package]}


@pytest.mark.parametrize('package', FOLDERS)
def test_a_package_declares_what_it_imports_and_no_package_of_ours_besides(package):
    imported = {name.split('.')[0] for path in source(package).glob('**/*.py') for name in imports(path)}
    declared = dependencies(package, 'exec_depend')
    for name in imported - {package} - OPTIONAL:
        is_ours_or_ros = (ROOT / name).is_dir() or name in ROS or name.endswith(ROS_ENDINGS)
        if name in KEYS or is_ours_or_ros:
            assert KEYS.get(name, name) in declared, f'{name} is imported'
    assert {name for name in declared if name.startswith('rumba_')} == {
        name for name in imported - {package} if name.startswith('rumba_')}


def test_the_launch_files_that_join_the_packages_depend_on_all_of_them():
    assert {'rumba_msg', *FOLDERS} <= dependencies('rumba_launch', 'exec_depend')
    assert {path.parts[-3] for path in (ROOT / 'rumba_launch').glob('**/*.py')} == {'test'}


@pytest.mark.parametrize('package', FOLDERS)
def test_every_folder_is_in_the_table_of_its_package(package):
    folders = {folder(package, path) for path in source(package).glob('**/*.py') if path.name != '__init__.py'}
    assert folders == set(FOLDERS[package])
    table = re.search(rf'^## {package}\n\n\| folder .*?\n\n', ARCHITECTURE, re.MULTILINE | re.DOTALL)
    assert table, f'docs/architecture.md has no table of {package}'
    assert set(re.findall(r'^\| `([\w/]*)` ', table.group(0), re.MULTILINE)) == {name or package for name in folders}


def test_the_picture_of_the_packages_shows_the_arrows_of_their_package_files():
    arrows = set(re.findall(r'^(\w+) -> (\w+)$', ARCHITECTURE, re.MULTILINE))
    ours = {'rumba_msg', 'rumba_launch', *FOLDERS}
    assert arrows == {(package, name) for package in ours for name in dependencies(package, 'exec_depend')
                      if name in ours}


@pytest.mark.parametrize('path', sorted(path for package in FOLDERS
                                        for path in (ROOT / package / 'scripts').iterdir()), ids=name_of)
def test_a_script_is_a_few_lines_executable_and_installed(path):
    assert len(path.read_text().splitlines()) <= 5
    assert path.stat().st_mode & 0o111
    assert f'scripts/{path.name}\n' in (pathlib.Path(path).parents[1] / 'CMakeLists.txt').read_text()
