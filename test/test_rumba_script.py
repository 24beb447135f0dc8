"""./rumba in checkouts of its own: what it says of bad input, and that its verdict is true."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import zipfile

import pytest
from checkouts import SAMPLE, commands, make_checkout, on_system, rumba, surroundings, write_package
from sockets import wait_for
from workspaces import ROOT, Space, last_of

NODE = '''#!/usr/bin/env python3
import rospy
rospy.init_node('node')
print('handles signals', flush=True)
rospy.spin()
'''
NOBODY = 65534  # number of the user nobody
WHEEL = 'tiny-1.0-py3-none-any.whl'
APT_WITHOUT_NETWORK = '''#!/bin/sh
[ "$1" = update ] || { echo 'E: Unable to locate package catkin'; exit 100; }
'''


@pytest.fixture
def checkout(tmp_path):
    """A checkout with spaces in its path."""
    return make_checkout(tmp_path / 'a checkout')


@pytest.fixture(scope='module')
def built(tmp_path_factory):
    """Another one that is built, for tests that change nothing in it, and the environment in which it was built."""
    folder = make_checkout(tmp_path_factory.mktemp('built') / 'a checkout')
    cache = folder.parent / 'cache'
    environment = {'XDG_CACHE_HOME': str(cache)}
    code, _, error = rumba(folder, 'shell', 'true', **environment)
    assert code == 0, error
    assert (f'rumba: {folder} has spaces, where rosrun and catkin_make install of ROS fail: the workspace is in {cache}'
            in error)
    return folder, environment


def need_wheel(checkout, folder):
    """Have lesson 11 need a package of Python that is in a folder; returns the environment with which pip finds it."""
    lesson = checkout / 'rumba_tutorials' / '11_record_and_read' / 'mission_bag'
    lesson.mkdir(parents=True)
    (lesson / 'requirements.txt').write_text('tiny==1.0\n')
    about = {'METADATA': 'Metadata-Version: 2.1\nName: tiny\nVersion: 1.0\n', 'RECORD': '',
             'WHEEL': 'Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n'}
    with zipfile.ZipFile(str(folder / WHEEL), 'w') as wheel:
        for name, text in about.items():
            wheel.writestr(f'tiny-1.0.dist-info/{name}', text)
    return {'PIP_NO_INDEX': '1', 'PIP_FIND_LINKS': str(folder), 'XDG_CACHE_HOME': str(folder / 'cache')}


@pytest.mark.thorough
def test_without_what_a_lesson_needs_from_a_package_index_the_tests_run_all_the_same(checkout, tmp_path):
    environment = need_wheel(checkout, tmp_path)
    (tmp_path / WHEEL).unlink()
    code, out, _ = rumba(checkout, 'test', **environment)
    assert (code, out.splitlines()[-1]) == (1, '4 passed, 1 failed')
    assert 'rumba: they cannot be fetched, so that its tests are skipped: ' in out
    assert 'No matching distribution found for tiny==1.0' in out


def test_a_failing_test_fails_the_whole_and_is_named_and_the_last_line_counts(checkout, tmp_path):
    code, out, _ = rumba(checkout, 'test', **need_wheel(checkout, tmp_path))
    assert 'rumba: fetching the Python packages of lesson 11\n' in out
    assert ((checkout / '.ws').resolve() / 'wheels' / WHEEL).exists()
    # The rostest counts twice: the parameter test, and its launch file.
    assert (code, out.splitlines()[-2:]) == (1, [
        'the tests that take longest were left out: ./rumba test --thorough', '4 passed, 1 failed'])
    verdict = out[out.index('failure: '):]
    assert verdict.startswith('failure: sample.test_unit.test_fails\n')
    assert 'AssertionError: on purpose' in verdict


@pytest.mark.thorough
def test_the_tests_of_a_package_run_alone_thoroughly_if_wanted_and_an_unknown_one_is_refused(checkout, tmp_path):
    (checkout / 'twin').mkdir()
    for name, text in SAMPLE.items():
        (checkout / 'twin' / name.replace('sample', 'twin')).write_text(text.replace('sample', 'twin'))
    code, out, _ = rumba(checkout, 'test', '--thorough', 'twin', XDG_CACHE_HOME=str(tmp_path / 'cache'))
    assert (code, out.splitlines()[-1]) == (1, '9 passed, 1 failed') and 'left out' not in out
    assert 'twin/pytest.xml' in out and 'sample/pytest.xml' not in out
    code, _, error = rumba(checkout, 'test', 'sample', 'twn', XDG_CACHE_HOME=str(tmp_path / 'cache'))
    assert (code, error.splitlines()[-1]) == (
        2, "rumba: there is no package 'twn' with tests: give names of packages, or nothing")


def test_help_names_every_command():
    code, out, _ = rumba(ROOT, 'help')
    assert code == 0
    assert [line.split()[0] for line in out.splitlines() if re.match('  [a-z]', line)] == [
        'run', 'test', 'build', 'shell', 'lint', 'bench', 'deb', 'docs', 'mutate', 'stress', 'help']


def test_an_unknown_command_is_refused():
    commands = 'run, test, build, shell, lint, bench, deb, docs, mutate, stress or help'
    assert rumba(ROOT, 'biuld') == (2, '', f"rumba: unknown command 'biuld': {commands}\n")


@pytest.mark.parametrize('argument', ['drian:=5', 'drain', '--screen'])
def test_an_unknown_argument_of_run_is_refused(argument):
    assert rumba(ROOT, 'run', argument) == (
        2, '', f"rumba: unknown argument '{argument}': use NAME:=VALUE with one of these names: "
        'robots map speed seed obstacles laser laser_model drain localisation percentage strategy target_coverage '
        'map_file state gui page rviz\n')


def test_no_network_leaves_nothing_behind(checkout, tmp_path):
    nothing_installed = '#!/bin/sh\nexit 1\n'
    path = commands(tmp_path / 'bin', **{
        'apt-get': APT_WITHOUT_NETWORK, 'dpkg-query': nothing_installed, 'id': '#!/bin/sh\necho 0\n'})
    code, _, said = rumba(checkout, 'build', PATH=f'{path}:{os.environ["PATH"]}', TMPDIR=str(tmp_path))
    assert code == 1
    ros, error = said.splitlines()
    assert ros.startswith('rumba: ROS ') and not (checkout / '.ws').exists()
    assert error.startswith('rumba: cannot install packages: Unable to locate package catkin (is the network up? ')


def test_no_root_and_no_sudo_says_what_an_administrator_must_do(checkout, tmp_path):
    system = dict.fromkeys(('sh', 'dirname', 'readlink', 'cat', 'tr', 'flock'))
    path = commands(tmp_path / 'bin', **{'id': '#!/bin/sh\necho 1000\n', 'dpkg-query': '#!/bin/sh\nexit 1\n', **system})
    code, out, said = rumba(checkout, 'build', PATH=str(path), **on_system(tmp_path))
    assert (code, out) == (1, '')
    _, error = said.splitlines()
    assert error.startswith('rumba: not root, and there is no sudo; as root: apt-get install ')
    assert ' python3-rostest' in error and not (checkout / '.ws').exists()


@pytest.mark.parametrize('command, display, wanted, unwanted', [
    (['run'], '', ['python3-rospy', 'python3-skimage'], ['python3-pyqt5', 'python3-matplotlib', 'xvfb']),
    (['run'], ':0', ['python3-pyqt5'], ['python3-matplotlib', 'xvfb']),
    (['run', 'gui:=auto'], ':0', ['python3-pyqt5'], []),
    (['run', 'gui:=false'], ':0', ['python3-skimage'], ['python3-pyqt5', 'python3-matplotlib']),
    (['run', 'gui:=true'], '', ['python3-pyqt5'], []),
    (['shell'], '', ['python3-matplotlib', 'python3-venv'], ['python3-pyqt5', 'xvfb']),
    (['build'], ':0', ['python3-matplotlib', 'python3-venv'], ['python3-pyqt5', 'xvfb', 'mypy']),
    (['test'], '', ['python3-pyqt5', 'python3-matplotlib', 'python3-venv', 'xvfb', 'python3-rosidl'], ['mypy']),
    (['deb'], '', ['catkin', 'python3-yaml'], ['python3-skimage', 'python3-pyqt5', 'rviz']),
    (['lint'], '', ['mypy', 'python3-skimage', 'python3-tornado', 'python3-pyqt5'], ['xvfb'])], ids=str)
def test_a_command_installs_what_its_roles_need_and_no_more(checkout, tmp_path, command, display, wanted, unwanted):
    (checkout / 'rumba_launch' / 'launch').mkdir(parents=True)
    shutil.copy(ROOT / 'rumba_launch' / 'launch' / 'demo.launch', checkout / 'rumba_launch' / 'launch')
    apt = f'#!/bin/sh\n[ "$1" = update ] || {{ echo "$*" >{tmp_path}/asked; exit 100; }}\n'
    path = commands(tmp_path / 'bin', **{'apt-get': apt, 'apt-cache': '#!/bin/sh\n', 'id': '#!/bin/sh\necho 0\n',
                                         'dpkg-query': '#!/bin/sh\nexit 1\n'})
    code, _, _ = rumba(checkout, *command, PATH=f'{path}:{os.environ["PATH"]}', DISPLAY=display, WAYLAND_DISPLAY='',
                       **on_system(tmp_path))
    asked = (tmp_path / 'asked').read_text().split()
    assert code == 1
    assert set(wanted) <= set(asked) and not set(unwanted) & set(asked)


def test_if_nothing_is_missing_nothing_is_asked_for(built, tmp_path):
    checkout, environment = built
    forbidden = f'#!/bin/sh\ntouch {tmp_path}/asked\nexit 1\n'
    path = commands(tmp_path / 'bin', **{'apt-get': forbidden, 'sudo': forbidden})
    code, out, error = rumba(checkout, 'shell', 'pwd', PATH=f'{path}:{os.environ["PATH"]}', **environment)
    assert (code, out, error.count('\n')) == (0, os.getcwd() + '\n', 1), error  # which ROS it is
    assert not (tmp_path / 'asked').exists()


def test_a_python_that_shadows_the_system_s_does_no_harm(checkout, tmp_path):
    path = commands(tmp_path / 'bin', python3='#!/bin/sh\nexit 1\n', python='#!/bin/sh\nexit 1\n')
    code, out, _ = rumba(checkout, 'shell', 'sh', '-c', 'command -v python3; rospack find sample',
                         PATH=f'{path}:{os.environ["PATH"]}', XDG_CACHE_HOME=str(tmp_path / 'cache'))
    python, sample = out.splitlines()
    assert (code, python) == (0, '/usr/bin/python3')
    assert sample.endswith('/src/sample')


@pytest.mark.parametrize('given, found', [
    ({}, 'localhost'), ({'ROS_MASTER_URI': 'http://127.0.0.1:11311/'}, 'localhost'),
    ({'ROS_MASTER_URI': 'http://[::1]:11311'}, 'localhost'), ({'ROS_MASTER_URI': 'http://robot:11311'}, ''),
    ({'ROS_MASTER_URI': 'http://localhost.lab:11311'}, ''), ({'ROS_IP': '10.0.0.1'}, ''),
    ({'ROS_HOSTNAME': 'desk'}, 'desk')], ids=str)
def test_ros_keeps_to_this_machine_unless_an_address_or_a_master_elsewhere_is_given(built, given, found):
    checkout, environment = built
    environment = {**environment, 'ROS_HOSTNAME': '', 'ROS_IP': '', 'ROS_MASTER_URI': '', **given}
    code, out, error = rumba(checkout, 'shell', 'sh', '-c', 'echo "$ROS_HOSTNAME"', **environment)
    assert (code, out) == (0, found + '\n'), error


def test_a_roscore_and_a_node_in_the_shell_cannot_be_reached_from_other_machines(built, tmp_path):
    checkout, environment = built
    node = commands(tmp_path / 'bin', node=NODE) / 'node'
    environment = surroundings(**{'ROS_HOSTNAME': '', **environment})
    shell = Space([], environment, f'cd "{checkout}";')
    with shell.running(f'./rumba shell roscore -p {environment["ROS_MASTER_URI"].rpartition(":")[2]}') as core:
        wait_for(core, {'rosmaster': 0, 'roscore': 0, 'rosout': 1})
        with shell.running(f'./rumba shell {node}') as process:
            last_of(process, 'handles signals')
            wait_for(process, {'node': 0})


@pytest.mark.parametrize('home', ['', None])
def test_if_a_path_has_spaces_and_there_is_no_home_nothing_is_put_where_others_could_change_it(checkout, home):
    environment = {name: value for name, value in surroundings().items() if name not in ('HOME', 'XDG_CACHE_HOME')}
    done = subprocess.run([str(checkout / 'rumba'), 'build'], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, env={**environment, **({} if home is None else {'HOME': home})})
    assert (done.returncode, done.stdout) == (2, '')
    _, error = done.stderr.splitlines()
    assert error == f'rumba: {checkout} has spaces, so that the workspace belongs below HOME, which is not set'


@pytest.mark.thorough
def test_a_package_of_compat_is_built_only_if_the_system_has_none(checkout, tmp_path):
    for name in ('lacking', 'std_srvs'):
        write_package(checkout / 'compat' / name)
    (checkout / 'compat' / 'CATKIN_IGNORE').touch()

    def found():
        code, out, error = rumba(checkout, 'shell', 'sh', '-c', 'rospack find lacking; rospack find std_srvs',
                                 XDG_CACHE_HOME=str(tmp_path / 'cache'))
        assert code == 0, error
        return out.splitlines()

    lacking, srvs = found()
    source = (checkout / '.ws').resolve() / 'src'
    assert (lacking, srvs.endswith('/share/std_srvs')) == (str(source / 'lacking'), True)
    # As it is when a package appears in the system that was lacking at the last build.
    (source / 'std_srvs').symlink_to(checkout / 'compat' / 'std_srvs')
    built = source.parent / 'devel' / 'built_of_std_srvs'
    built.touch()
    assert found() == [lacking, srvs]
    assert not (source / 'std_srvs').exists() and not built.exists()


@pytest.mark.thorough
def test_lessons_are_built_once_they_are_asked_for_and_remain(checkout, tmp_path):
    write_package(checkout / 'rumba_tutorials' / '01_first' / 'a_lesson')
    (checkout / 'rumba_tutorials' / 'CATKIN_IGNORE').touch()
    cache = {'XDG_CACHE_HOME': str(tmp_path / 'cache')}
    find = ('shell', 'rospack', 'find', 'a_lesson')
    code, _, error = rumba(checkout, *find, **cache)
    assert (code, error.splitlines()[-1]) == (
        2, 'rumba: a_lesson belongs to a lesson, and the lessons are not built yet: ./rumba build')
    typed = subprocess.run(['sh', '-c', f'printf "rosrun a_lesson node\nexit 3\n" | "{checkout}/rumba" shell'],
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                           env=surroundings(**cache))
    assert 'a_lesson belongs to a lesson, and the lessons are not built yet: ./rumba build\n' in typed.stdout
    assert typed.returncode == 3
    assert rumba(checkout, 'build', **cache)[0] == 0
    assert rumba(checkout, *find, **cache)[1].endswith('/src/a_lesson\n')


@pytest.mark.thorough
def test_a_shell_builds_again_only_if_something_changed(checkout, tmp_path):
    def has_built():
        code, out, error = rumba(checkout, 'shell', 'rospack', 'find', 'sample', XDG_CACHE_HOME=str(tmp_path / 'cache'))
        assert (code, out.endswith('/src/sample\n')) == (0, True), error
        return 'rumba: building\n' in error

    assert has_built() and not has_built()
    os.utime(checkout / 'sample' / 'CMakeLists.txt', (1.0, 1.0))  # older, but another file
    assert has_built() and not has_built()
    (checkout / 'sample' / 'test_unit.py').unlink()
    assert has_built() and not has_built()
    write_package(checkout / 'another')
    assert has_built() and not has_built()
    shutil.rmtree((checkout / '.ws').resolve() / 'devel')
    assert has_built()


@pytest.fixture
def open_folder():
    """A new folder that everybody can enter."""
    with tempfile.TemporaryDirectory(dir='/tmp') as folder:
        os.chmod(folder, 0o755)
        yield pathlib.Path(folder)


@pytest.mark.skipif(os.getuid() != 0, reason='only root can make a checkout of root')
@pytest.mark.parametrize('has_built', [False, True])
def test_a_checkout_that_belongs_to_somebody_else_is_named_in_one_line(open_folder, has_built):
    checkout = make_checkout(open_folder / 'checkout')
    if has_built:
        (checkout / '.ws' / 'src').mkdir(parents=True)
    done = subprocess.run(['setpriv', f'--reuid={NOBODY}', '--clear-groups', str(checkout / 'rumba'), 'shell', 'true'],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=60.0,
                          env=surroundings(HOME='/nonexistent'))
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == (
        f'rumba: nobody cannot write to {checkout}/.ws, since somebody else made the checkout, or built there: run '
        f"./rumba as root, or have root run: chown -R nobody '{checkout}'")
    assert 'ermission denied' not in done.stderr


def test_a_folder_for_temporary_files_that_cannot_be_written_is_named_in_one_line(tmp_path):
    code, _, error = rumba(make_checkout(tmp_path / 'checkout'), 'shell', 'true', TMPDIR=str(tmp_path / 'none'))
    assert code == 1
    assert error.splitlines()[-1] == (f'rumba: no file can be written to {tmp_path}/none: free some space there, or '
                                      'let TMPDIR name another folder')
    assert 'Traceback' not in error
