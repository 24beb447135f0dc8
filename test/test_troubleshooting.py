"""Each message in docs/troubleshooting.md is what a newcomer reads, and its cure cures it.

Three packages that are right are broken in one place each, in a workspace of their own. Nodes of this repository are
started at masters of their own.
"""

import contextlib
import pathlib
import re
import shutil
import subprocess
import sys
from typing import NamedTuple

import pytest
from workspaces import ROOT, TIMEOUT, UNDERLAY, Space, Workspace, clean_environment, last_of, lines, master

DOC = (ROOT / 'docs' / 'troubleshooting.md').read_text()
MESSAGES = re.findall('^### `(.*)`$', DOC, re.MULTILINE)
PACKAGES = sorted((ROOT / 'test' / 'packages_to_break').iterdir())
USER, LIB, MSGS = 'parts_user/CMakeLists.txt', 'parts_lib/CMakeLists.txt', 'parts_msgs/CMakeLists.txt'
HEADER = 'fatal error: ....h: No such file or directory'
NO_MODULE = "ModuleNotFoundError: No module named '...'"
NO_PACKAGE = 'Could not find a package configuration file provided by "..." with any of the following names'
SECOND_CLEANER = ("robot '...' has a cleaner already: ... publishes ...: end it first, or name another robot: "
                  "_robot:=rumba2")
OTHER_WORLD = ('...: was saved with ... ..., which is ... now: start with what it was saved with, or give state '
               'another file')

# These need another system, two workspaces, or two nodes that start at the same moment.
ELSEWHERE = ['Compatibility with CMake < 3.5 has been removed from CMake.',
             "/usr/bin/env: 'python': No such file or directory",
             'another simulator starts at the same moment: only one of them can',
             "AttributeError: 'Thread' object has no attribute 'isAlive'",
             "[rospack] Error: package 'topic_tools' not found",
             'Cannot load message class for [rumba_msg/...]. Are your messages built?',
             'to have datatype/md5sum [...], but our version has [...]. Dropping connection.',
             'Unable to communicate with master!',
             'drive/wheel_base is ... m and cliff/distance ... m: no cliff sensor sees the floor before the '
             'wheels, ...']


class Break(NamedTuple):
    """One place in which something is wrong, and what catkin_make then says."""

    message: str
    file: str
    right: str
    wrong: str
    target: str = ''  # of make


BUILD = {
    'the package of the message is not looked for':
        Break(HEADER, USER, 'parts_lib parts_msgs', 'parts_lib'),
    'the message is generated after its user': Break(
        HEADER, USER, 'add_dependencies(parts_node ${catkin_EXPORTED_TARGETS})', '', 'parts_node'),
    'the library does not export its headers': Break(HEADER, LIB, 'INCLUDE_DIRS include ', ''),
    'the library is exported by another name': Break(
        "Project '...' tried to find library '...'. The library is neither a target nor built/installed properly.",
        LIB, 'LIBRARIES parts_lib', 'LIBRARIES part_lib'),
    'the library is not linked': Break(
        'undefined reference to ...', USER, 'target_link_libraries(parts_node ${catkin_LIBRARIES})', ''),
    'a package is misspelt': Break(NO_PACKAGE, USER, 'parts_lib parts_msgs', 'parts_lib parts_msg'),
    'a type without its package': Break(
        'Cannot locate message [...] in package [...]', 'parts_msgs/msg/Parts.msg', 'geometry_msgs/', ''),
    'a package of types that is not declared': Break(
        'Cannot locate message [...]: unknown package [...]', MSGS,
        'generate_messages(DEPENDENCIES geometry_msgs std_msgs)', 'generate_messages()'),
    'messages generated too late': Break(
        'generate_messages() must be called before catkin_package()', MSGS,
        'generate_messages(DEPENDENCIES geometry_msgs std_msgs)\n'
        'catkin_package(CATKIN_DEPENDS geometry_msgs message_runtime std_msgs)',
        'catkin_package(CATKIN_DEPENDS geometry_msgs message_runtime std_msgs)\n'
        'generate_messages(DEPENDENCIES geometry_msgs std_msgs)'),
    'rostest is not looked for': Break('Unknown CMake command "add_rostest"', USER, 'catkin_package()',
                                       'catkin_package()\nadd_rostest(test/nodes.test)'),
    'services without their folder': Break(
        'add_service_files() directory not found: ...', MSGS, 'add_message_files(FILES Parts.msg)',
        'add_message_files(FILES Parts.msg)\nadd_service_files(FILES AddTwoInts.srv)'),
    'a target of a package that is gone': Break(
        'The dependency target "..." of target "..." does not exist.', USER,
        'add_dependencies(parts_node ${catkin_EXPORTED_TARGETS})',
        'add_dependencies(parts_node beginner_tutorials_generate_messages_cpp)'),
    'a maintainer without an address': Break(
        'Invalid email "..." for person "..."', 'parts_msgs/package.xml', 'maintainers@rumba.invalid', 'me@todo'),
}


def workspace(folder, environment):
    """A workspace with copies of the packages, which may be broken."""
    packages = [shutil.copytree(str(package), str(folder / package.name)) for package in PACKAGES]
    return Workspace(folder / 'ws', [folder / package for package in packages], environment)


def replace(path, right, wrong):
    """Break a file in one place."""
    text = path.read_text()
    assert text.count(right) == 1
    path.write_text(text.replace(right, wrong))


def says(message, output):
    """See that a message of the page is in an output, however its lines are broken."""
    assert message in MESSAGES
    pattern = '.+'.join(map(re.escape, message.split('...')))
    flat = ' '.join(output.replace('‘', "'").replace('’', "'").split())
    assert re.search(pattern, flat), output[-3000:]


def fails(space, command):
    """What a command that must fail prints."""
    process = space.start(command, stderr=subprocess.STDOUT)
    output = process.communicate(timeout=TIMEOUT)[0]
    assert process.returncode != 0, output
    return output


@pytest.mark.thorough(except_for=['a type without its package'])
@pytest.mark.parametrize('case', BUILD.values(), ids=BUILD)
def test_what_catkin_make_says(environment, tmp_path, case):
    broken = workspace(tmp_path, environment)
    replace(tmp_path / case.file, case.right, case.wrong)
    with pytest.raises(AssertionError) as failure:
        broken.make(case.target)
    says(case.message, str(failure.value))


@pytest.mark.thorough
def test_the_packages_build_if_nothing_is_broken(environment, tmp_path):
    cured = workspace(tmp_path, environment)
    cured.make()
    assert cured.space('devel').run('rosrun parts_user reader') == 'hello from parts_lib parts_msgs/Parts\n'
    assert '3 places' in cured.space('devel').run('rosrun parts_user parts_node')
    forgotten = Space(UNDERLAY, environment)
    says("[rospack] Error: package '...' not found", fails(forgotten, 'rosrun parts_user reader'))
    says('[...] is neither a launch file in package [...] nor is [...] a launch file name',
         fails(forgotten, 'roslaunch parts_user parts.launch'))
    says('Unable to load msg [...]', fails(forgotten, 'rosmsg show parts_msgs/Parts'))


@pytest.mark.thorough
def test_a_module_that_is_not_exported_and_a_script_that_may_not_run(environment, tmp_path):
    broken = workspace(tmp_path, environment)
    replace(tmp_path / LIB, 'catkin_python_setup()\n', '')
    broken.make('parts_msgs_generate_messages_py')
    says(NO_MODULE, fails(broken.space('devel'), 'rosrun parts_user reader'))
    replace(tmp_path / USER, 'catkin_install_python(PROGRAMS scripts/reader', '#')
    shutil.rmtree(str(broken.path / 'devel' / 'lib' / 'parts_user'))
    (tmp_path / 'parts_user' / 'scripts' / 'reader').chmod(0o644)
    says("[rosrun] Couldn't find executable named ... below ...",
         fails(broken.space('devel'), 'rosrun parts_user reader'))


def test_two_packages_of_one_name(environment, tmp_path):
    broken = workspace(tmp_path, environment)
    shutil.copytree(str(tmp_path / 'parts_msgs'), str(broken.path / 'src' / 'copy'))
    with pytest.raises(AssertionError) as failure:
        broken.make()
    says('Multiple packages found with the same name "...":', str(failure.value))


def test_a_python_of_pyenv_or_conda(environment, tmp_path):
    broken = workspace(tmp_path, environment)
    subprocess.check_call([sys.executable, '-m', 'venv', '--without-pip', str(tmp_path / 'other')])
    with pytest.raises(AssertionError) as failure:
        broken.make(python=f'{tmp_path}/other/bin/python')
    says("No module named 'catkin_pkg'", str(failure.value))


def test_a_message_without_a_header_has_no_delay(environment):
    space = Space(UNDERLAY, environment)
    with space.running('rostopic pub -r 5 /troubleshooting std_msgs/String hello'):
        says('msg does not have header', first_line_with('header', space, 'rostopic delay /troubleshooting'))


def first_line_with(word, space, command):
    """The first line with a word that a command prints, which is ended then."""
    process = space.start(command, stderr=subprocess.STDOUT)
    try:
        return next((line for line in lines(process) if word in line), '')
    finally:
        process.kill()
        process.communicate()


def lonely(workspace):
    """The nodes of this repository, and the environment of a master that does not run yet."""
    environment = clean_environment()
    return workspace.space('devel', environment), environment


@pytest.mark.thorough
def test_two_cleaners_of_one_robot(workspace):
    here, environment = lonely(workspace)
    with master(environment), here.running('$LIB/rumba_cleaning/cleaner _map:=studio'):
        here.run('rostopic echo -n1 /rumba/mission_status')
        second = '$LIB/rumba_cleaning/cleaner __name:=second _map:=studio'
        says(SECOND_CLEANER, fails(here, second))
        with here.running(f'{second} _robot:=rumba2'):
            here.run('rostopic echo -n1 /rumba2/mission_status')


def test_simulated_time_without_a_clock(workspace):
    here, environment = lonely(workspace)
    publisher = '$LIB/rumba_sim/battery_status_publisher'
    with master(environment):
        here.run('rosparam set /use_sim_time true')
        says('/use_sim_time is true, but nothing publishes /clock', first_line_with('use_sim_time', here, publisher))
        here.run('rosparam delete /use_sim_time')
        with here.running(f'{publisher} __name:=again'):
            here.run('rostopic echo -n1 /rumba/battery_status')


def test_a_master_that_ends_and_comes_again(workspace):
    here, environment = lonely(workspace)
    with contextlib.ExitStack() as stack:
        with master(environment):
            node = stack.enter_context(here.running('$LIB/rumba_sim/battery_status_publisher 2>&1'))
            here.run('rostopic echo -n1 /rumba/battery_status')
        says('the master at ... does not answer: this node goes on, and registers again when there is a master',
             last_of(node, 'the master at'))
        with master(environment):
            assert '`the master was restarted: this node has registered again`' in DOC
            last_of(node, 'the master was restarted: this node has registered again')
            here.run('rostopic echo -n1 /rumba/battery_status')


@pytest.mark.thorough
def test_a_saved_world_that_does_not_fit(workspace, tmp_path):
    here, environment = lonely(workspace)
    simulator = f'$LIB/rumba_sim/simulator _map:=studio _state:={tmp_path}/state'
    with master(environment):
        with here.running(f'{simulator} _battery/drain:=5'):
            here.run('rostopic echo -n1 /simulator/state')
        says(OTHER_WORLD, fails(here, f'{simulator} _battery/drain:=20'))
        with here.running(f'{simulator} _battery/drain:=5 __name:=again 2>&1') as again:
            last_of(again, 'goes on from')


def test_every_message_of_the_page_was_met_here_or_elsewhere():
    lesson = ROOT / 'rumba_tutorials' / '07_lists_and_bytes' / 'lists_and_bytes' / 'test' / 'test_arrays.py'
    tests = pathlib.Path(__file__), ROOT / 'test' / 'test_course_code.py', lesson
    met = re.sub(r'([\'"])\n +\1', '', ''.join(path.read_text() for path in tests))  # texts in one line
    assert [message for message in MESSAGES if message not in met] == []
    assert set(ELSEWHERE) <= set(MESSAGES)
