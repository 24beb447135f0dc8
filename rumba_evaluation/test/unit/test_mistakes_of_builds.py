"""Why a submission cannot be built, by what catkin_make, CMake, the compiler, the linker and genmsg printed."""

import time

import pytest
from printed import sections

from rumba_evaluation.submissions.diagnosis.mistakes import MOST, of_build

PRINTED = sections('printed_by_builds.txt')
CMAKE = 'sweeper/CMakeLists.txt, line '


@pytest.mark.parametrize('name, begin, advice', [
    ('bad_cmake', f'{CMAKE}4: a bracket', 'Function missing ending ")"'),
    ('bad_msg', f'{CMAKE}5: a message uses the type float, which does not exist', 'float64'),
    ('bad_msg_syntax', 'sweeper/msg/Dirt.msg is no message: Invalid declaration: float64', 'a type and a name'),
    ('bad_xml', 'sweeper/package.xml cannot be used: ', 'mismatched tag: line 13, column 2'),
    ('generate_undeclared_dependency',
     f'{CMAKE}5: messages of geometry_msgs are used', '<depend>geometry_msgs</depend>'),
    ('install_no_script', f'{CMAKE}5: sweeper/scripts/cleaner does not exist', 'spelling'),
    ('late_generate', f'{CMAKE}6: generate_messages(...) must stand before catkin_package(...)', 'move it up'),
    ('no_cmakelists', 'sweeper has no CMakeLists.txt', 'hand in the whole folder'),
    ('no_component', f'{CMAKE}3: the package costmap_3d is not installed here', 'spelling'),
    ('no_generation', f'{CMAKE}4: add_message_files is unknown', 'COMPONENTS message_generation'),
    ('no_header', 'sweeper/src/cleaner.cpp, line 1: there is no rumba_msg/Bumper.h', 'include_directories('),
    ('no_libraries', 'cleaner uses ros::init, but', 'target_link_libraries(cleaner ${catkin_LIBRARIES})'),
    ('no_main', 'cleaner: no source has a function main', 'add_executable(cleaner ...)'),
    ('no_msg_file', f'{CMAKE}4: sweeper/msg/Dust.msg does not exist', 'spelling'),
    ('no_package', f'{CMAKE}4: the package Gazebo9000 is not installed here', 'spelling'),
    ('no_runtime_in_xml', f'{CMAKE}6: package.xml lacks ', '<exec_depend>message_runtime</exec_depend>'),
    ('no_setup_py', f'{CMAKE}4: catkin_python_setup() needs a file setup.py', 'delete this line'),
    ('no_source', f'{CMAKE}6: src/cleener.cpp does not exist', 'spelling'),
    ('no_std_in_xml', f'{CMAKE}6: package.xml lacks ', '<depend>std_msgs</depend>'),
    ('no_such_header', 'sweeper/src/cleaner.cpp, line 1: there is no rumba_msgs/Bumper.h', 'spelling'),
    ('no_version', 'sweeper/package.xml cannot be used: ', 'exactly one "version" tag'),
    ('other_project', f'{CMAKE}4: project(cleaner_robot) is not the name', 'write project(sweeper)'),
    ('semicolon', 'sweeper/src/cleaner.cpp, line 5: the compiler says "expected initializer before', 'line before'),
    ('twice', 'there are several packages with one name, in copy and sweeper', 'only one'),
    ('unknown_command', f'{CMAKE}4: there is no command catkin_pakage', 'spelling'),
    ('unknown_msg_type', f'{CMAKE}5: a message uses geometry_msgs/Twist', 'generate_messages(DEPENDENCIES'),
    ('unknown_name', 'sweeper/src/cleaner.cpp, line 5: the compiler says "‘speed’ was not declared', 'spelling'),
    ('upper_name', 'sweeper/package.xml cannot be used: ', 'Package name "My Sweeper" does not follow')])
def test_a_build_that_failed_has_one_reason_with_its_place_and_what_to_do(name, begin, advice):
    [told] = of_build(PRINTED[name])
    assert told.startswith(begin) and advice in told[len(begin) - 1:]


def test_each_text_is_tested():
    tested = test_a_build_that_failed_has_one_reason_with_its_place_and_what_to_do.pytestmark[0].args[1]
    assert set(PRINTED) == {'in_header', *(name for name, *_ in tested)}


def test_an_error_of_cmake_that_is_not_known_is_quoted():
    printed = PRINTED['unknown_command'].replace('Unknown CMake command', 'Strange \033]0;command')
    assert of_build(printed) == [f'{CMAKE}4: CMake says: Strange \\x1b]0;command "catkin_pakage".']


def test_an_error_in_a_header_of_ros_is_told_where_the_submission_causes_it():
    assert of_build(PRINTED['in_header'])[0].startswith(
        'sweeper/src/cleaner.cpp, line 6: the compiler says "no match for ‘operator<’')


def test_a_message_of_its_own_that_is_not_made_yet_needs_an_order():
    [told] = of_build(PRINTED['no_header'].replace('rumba_msg/Bumper.h', 'sweeper/Dirt.h'))
    assert 'there is no sweeper/Dirt.h yet' in told and 'add_dependencies(' in told


def test_a_build_that_succeeded_has_no_mistakes():
    assert of_build('') == of_build('[100%] Built target cleaner\n') == []


@pytest.mark.parametrize('piece', [
    'CMake Error at ', 'CMake Error at submission/a:1:\n  Cannot locate message [\n', "  Assertion failed: file '",
    'undefined reference to `', ': error: ', 'a:1:1: error: ', '\033[', '(', ' ', '\n',
    'Error(s) in package \'\n', 'a'])
def test_a_megabyte_of_anything_is_read_within_seconds(piece):
    began = time.process_time()
    assert len(of_build(piece * (1_000_000 // len(piece)))) <= MOST
    assert len(of_build('CMake Error at submission/a:1:\n  ' + piece * (1_000_000 // len(piece)))) <= MOST
    assert time.process_time() - began < 10.0
