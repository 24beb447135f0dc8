"""Checkouts of their own for tests of ./rumba, with a small package in each, and what a user does in them."""

import shutil
import subprocess

from workspaces import BELOW, BUILD_TIMEOUT, ROOT, clean_environment

SAMPLE = {
    'package.xml': '''<package format="3"><name>sample</name><version>0.1.0</version><description>Sample.</description>
        <maintainer email="a@b.invalid">x</maintainer><license>BSD</license>
        <buildtool_depend>catkin</buildtool_depend></package>''',
    'CMakeLists.txt': '''
        cmake_minimum_required(VERSION 3.5)
        project(sample)
        find_package(catkin REQUIRED)
        find_package(rostest REQUIRED)
        catkin_package()
        catkin_run_tests_target(pytest unit pytest.xml
          COMMAND "${PYTHON_EXECUTABLE} -m pytest --junitxml=${CATKIN_TEST_RESULTS_DIR}/sample/pytest.xml ."
          WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
        add_rostest(sample.test)''',
    'test_unit.py': '''
import pytest


@pytest.mark.thorough
@pytest.mark.parametrize('number', [1, 2, 3])
def test_takes_long(number):
    pass


@pytest.mark.thorough(except_for=['2'])
@pytest.mark.parametrize('number', [1, 2, 3])
def test_takes_long_but_for_one(number):
    pass


def test_passes():
    pass


def test_fails():
    raise AssertionError('on purpose')
''',
    'sample.test': '''<launch><param name="here" value="1"/>
        <test test-name="here" pkg="rostest" type="paramtest" name="paramtest">
        <param name="param_name_target" value="/here"/><param name="test_duration" value="0.1"/>
        <param name="wait_time" value="20.0"/></test></launch>''',
}


def make_checkout(folder):
    """A checkout that holds one small package of one passing and one failing test."""
    (folder / 'sample').mkdir(parents=True)
    (folder / 'packaging').mkdir()
    for name in ('rumba', 'packaging/platform.sh', 'packaging/progress.sh', 'packaging/which_ros.sh', 'packages.txt',
                 'conftest.py', 'pyproject.toml'):
        shutil.copy(ROOT / name, folder / name)
    for name, text in SAMPLE.items():
        (folder / 'sample' / name).write_text(text)
    return folder


def write_package(folder):
    """An empty package with its folder's name."""
    folder.mkdir(parents=True)
    (folder / 'package.xml').write_text(SAMPLE['package.xml'].replace('sample', folder.name))
    (folder / 'CMakeLists.txt').write_text(f'''
        cmake_minimum_required(VERSION 3.5)
        project({folder.name})
        find_package(catkin REQUIRED)
        catkin_package()''')


def surroundings(**environment):
    """An environment for ./rumba, with the ROS that this repository is built with, and with some variables."""
    return {**clean_environment(), 'CMAKE_PREFIX_PATH': ':'.join(map(str, BELOW)), **environment}


def on_system(folder, codename='bookworm', name='Debian GNU/Linux 12 (bookworm)'):
    """The variables that have ./rumba believe to be on another system, with a folder for /opt/ros."""
    release = folder / 'os-release'
    release.write_text(f'PRETTY_NAME="{name}"\nVERSION_CODENAME="{codename}"\n')
    return {'RUMBA_OS_RELEASE': str(release), 'RUMBA_OPT_ROS': str(folder / 'opt'), 'CMAKE_PREFIX_PATH': ''}


def rumba(folder, *arguments, **environment):
    """Exit code, output and error output of ./rumba."""
    done = subprocess.run([str(folder / 'rumba'), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, timeout=BUILD_TIMEOUT, env=surroundings(**environment))
    return done.returncode, done.stdout, done.stderr


def commands(folder, **scripts):
    """A folder with commands to find before the system's, or alone: scripts by name; None links to the system's."""
    folder.mkdir()
    for name, script in scripts.items():
        path = folder / name
        if script is None:
            path.symlink_to(shutil.which(name))
        else:
            path.write_text(script)
            path.chmod(0o755)
    return folder
