"""What can be seen in the files of a submission as they were handed in, and what may be quoted from them."""

import os
import pathlib
import socket
import time

import pytest

from rumba_evaluation.submissions.diagnosis import installed_packages
from rumba_evaluation.submissions.diagnosis.mistakes import MOST, Wanted, of_submission
from rumba_evaluation.submissions.diagnosis.quotations import printable
from rumba_evaluation.submissions.diagnosis.submitted_files import MOST_BYTES

CLEANER = Wanted('sweeper', 'cleaner')
SCRIPT = '#!/usr/bin/env python3\nimport rospy\n'
XML = '''<?xml version="1.0"?>
<package format="2">
  <name>sweeper</name>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>std_msgs</depend>
  <depend>rospy</depend>
</package>
'''
CMAKE = '''cmake_minimum_required(VERSION 3.5)
project(sweeper)
find_package(catkin REQUIRED)
catkin_package()
'''
MESSAGES = '''project(sweeper)
find_package(catkin REQUIRED COMPONENTS message_generation std_msgs)
add_message_files(FILES Dirt.msg)
add_service_files(FILES Clean.srv)  # and Dust.msg
generate_messages(DEPENDENCIES std_msgs)
catkin_package()
'''
MESSAGES_XML = XML.replace('</package>', '<build_depend>message_generation</build_depend>'
                                         '<exec_depend>message_runtime</exec_depend></package>')


@pytest.fixture(autouse=True)
def installed(monkeypatch):
    """What is installed does not depend on the computer."""
    monkeypatch.setattr(installed_packages, 'names', lambda: {'catkin', 'rospy', 'std_msgs', 'rumba_msg',
                                                              'message_generation', 'message_runtime'})


@pytest.fixture
def submitted(tmp_path):
    """A function that makes a submission with the package sweeper; None leaves a file out."""
    def make(files=(), **others):
        contents = {'package.xml': XML, 'CMakeLists.txt': CMAKE, 'scripts/cleaner': SCRIPT, **dict(files), **others}
        for name, content in contents.items():
            if content is not None:
                path = tmp_path / 'sweeper' / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path
    return make


def test_a_submission_without_mistakes_has_no_reasons(submitted):
    assert of_submission(submitted(), [CLEANER, CLEANER]) == []


@pytest.mark.parametrize('script, begin, advice', [
    (SCRIPT.replace('\n', '\r\n'), " has Windows line ends (CR LF), so its first line names "
     "'python3\\r', which does not exist: ", "`sed -i 's/\\r$//' sweeper/scripts/cleaner`"),
    (b'\xef\xbb\xbf' + SCRIPT.encode(), ' begins with a byte order mark', '"UTF-8" without BOM'),
    ('import rospy\n', ' does not begin with #!', '#!/usr/bin/env python3'),
    ('\n' + SCRIPT, ' has empty lines or spaces before the #!', 'delete what is before it'),
    ('', ' is empty', 'save your program'),
    (SCRIPT.replace('env python3', 'pyton3'),
     ", line 1: the program '/usr/bin/pyton3' does not exist here",
     '#!/usr/bin/env python3'),
    (SCRIPT.replace('python3', '-S python2.3 -u'), ", line 1: the program 'python2.3' does not exist here", 'Python 3'),
    (SCRIPT.replace('python3', 'python3 -u'), ", line 1: the program 'python3 -u' does not exist here", 'python3'),
    (SCRIPT.replace('python3', ''), ", line 1: the program '' does not exist here", '#!/usr/bin/env python3')])
def test_the_first_line_of_a_script_must_name_a_program(submitted, script, begin, advice):
    [told] = of_submission(submitted({'scripts/cleaner': script}), [CLEANER])
    assert told.startswith(f'sweeper/scripts/cleaner{begin}') and advice in told


def test_scripts_that_no_test_starts_are_not_looked_at(submitted):
    assert of_submission(submitted({'scripts/helper': SCRIPT.replace('\n', '\r\n')}), [CLEANER]) == []


def test_one_script_that_can_run_is_enough(submitted):
    assert of_submission(submitted({'scripts/cleaner': 'import rospy', 'nodes/more/cleaner': SCRIPT}), [CLEANER]) == []


@pytest.mark.parametrize('name', ['cleaner.py', 'Cleaner', 'cleener', 'robot'])
def test_the_nearest_name_is_told_if_a_script_is_missing(submitted, name):
    [told] = of_submission(submitted({'scripts/cleaner': None, f'scripts/{name}': SCRIPT}), [CLEANER])
    assert told == (f'sweeper has no node cleaner, but sweeper/scripts/{name}: rename it to sweeper/scripts/cleaner, '
                    'exactly so')


def test_without_any_script_its_place_is_told(submitted):
    [told] = of_submission(submitted({'scripts/cleaner': None}), [CLEANER])
    assert told.startswith('sweeper has no node cleaner: put your program into the folder scripts')


@pytest.mark.parametrize('cmake, begin', [
    ('add_executable(cleaner src/cleaner.cpp)', ''),
    ('add_executable(${PROJECT_NAME}_node src/cleaner.cpp)',
     'sweeper has no node cleaner, but CMakeLists.txt builds sweeper_node: give add_executable'),
    ('add_executable(${NAME} src/cleaner.cpp)', ''),
    ('add_executable(c src/cleaner.cpp)\nset_target_properties(c PROPERTIES OUTPUT_NAME "cleaner")', ''),
    ('# add_executable(cleaner src/cleaner.cpp)', 'sweeper has no node cleaner: its source src/cleaner.cpp is there')])
def test_a_node_in_cpp_must_be_built_with_its_name(submitted, cmake, begin):
    told = of_submission(submitted({'scripts/cleaner': None, 'src/cleaner.cpp': 'int main() {}\n',
                                    'CMakeLists.txt': CMAKE + cmake}), [CLEANER])
    assert told[0].startswith(begin) if begin else told == []


def test_the_packages_that_are_there_are_told_if_the_wanted_one_is_missing(submitted):
    [told] = of_submission(submitted(), [Wanted('sweper', 'cleaner')])
    assert told == ('there is no package sweper, but sweeper: write <name>sweper</name> in '
                    'sweeper/package.xml, and project(sweper) in CMakeLists.txt')


def test_a_submission_may_be_the_folder_of_the_package_itself(submitted):
    folder = submitted({'scripts/cleaner': 'import rospy'}) / 'sweeper'
    assert of_submission(folder, [CLEANER])[0].startswith('scripts/cleaner does not begin with #!')
    (folder / 'scripts' / 'cleaner').unlink()
    assert of_submission(folder, [CLEANER])[0].startswith('the package sweeper has no node cleaner')


def test_a_submission_needs_a_package(tmp_path):
    assert of_submission(tmp_path, [CLEANER]) == ['the submission is empty: hand in the folder of your package']
    (tmp_path / 'cleaner').write_text(SCRIPT)
    assert of_submission(tmp_path, [CLEANER])[0].startswith('there is no package.xml: hand in the whole folder')
    (tmp_path / 'sweeper.zip').write_text('')
    assert of_submission(tmp_path, [CLEANER])[0].startswith('there is no package.xml, but sweeper.zip: unpack it')
    (tmp_path / 'Package.xml').write_text(XML)
    assert of_submission(tmp_path, [CLEANER]) == ['Package.xml must have the name package.xml, exactly so: rename it']


@pytest.mark.parametrize('xml, problem', [
    (XML.replace('</name>', ''), 'mismatched tag: line 7, column 2'), ('', 'it is empty'),
    (XML.replace('std_msgs', '&b;'), 'undefined entity'),
    (f'<!DOCTYPE a [<!ENTITY b "{"c" * 1000}">]>{XML}', 'it has a <!DOCTYPE>')])
def test_a_package_xml_that_is_none_is_told_with_its_line(submitted, xml, problem):
    [told] = of_submission(submitted({'package.xml': xml}), [CLEANER])
    assert told.startswith(f'sweeper/package.xml cannot be read: {problem}')


def test_the_name_of_a_package_is_the_same_in_both_files(submitted):
    [told] = of_submission(submitted({'CMakeLists.txt': CMAKE.replace('sweeper', 'robot')}), [CLEANER])
    assert told == ('sweeper/CMakeLists.txt: project(robot) is not the name in package.xml, sweeper: write '
                    'project(sweeper)')


def messages(cmake=MESSAGES, xml=MESSAGES_XML):
    """The files of a package with a message and a service."""
    return {'msg/Dirt.msg': 'float64 weight\n', 'srv/Clean.srv': '---\n', 'CMakeLists.txt': cmake, 'package.xml': xml}


@pytest.mark.parametrize('cmake, xml, begin, advice', [
    (MESSAGES.replace('Dirt.msg', 'Dust.msg'), MESSAGES_XML, 'CMakeLists.txt does not name Dirt.msg',
     'add_message_files(FILES Dirt.msg)'),
    (MESSAGES.replace('add_service_files', '# '), MESSAGES_XML, 'CMakeLists.txt does not name Clean.srv',
     'add_service_files(FILES Clean.srv)'),
    (MESSAGES.replace('generate_messages', '# '), MESSAGES_XML, 'CMakeLists.txt has no generate_messages(...)',
     'before catkin_package'),
    (MESSAGES.replace(' message_generation', ''), MESSAGES_XML, 'CMakeLists.txt does not find message_generation',
     'COMPONENTS message_generation'),
    (MESSAGES, XML, 'package.xml lacks <build_depend>message_generation</build_depend> and '
     '<exec_depend>message_runtime</exec_depend>', 'needs that')])
def test_messages_need_entries_in_both_files(submitted, cmake, xml, begin, advice):
    [told] = of_submission(submitted(messages(cmake, xml)), [CLEANER])
    assert told.startswith(f'sweeper/{begin}') and advice in told


@pytest.mark.parametrize('cmake', [MESSAGES, MESSAGES.replace('FILES Dirt.msg', ''),
                                   MESSAGES.replace('COMPONENTS message_generation std_msgs)',
                                                    ')\nfind_package(message_generation)')])
def test_messages_with_all_entries_are_no_mistake(submitted, cmake):
    assert of_submission(submitted(messages(cmake)), [CLEANER]) == []


def test_what_a_script_imports_must_be_declared(submitted):
    script = SCRIPT + 'from rumba_msg.msg import Bumper\nimport math\nfrom sweeper.msg import Dirt\n'
    assert of_submission(submitted({'scripts/cleaner': script}), [CLEANER]) == [
        'sweeper/package.xml lacks <exec_depend>rumba_msg</exec_depend>: sweeper/scripts/cleaner imports that']


def test_packages_that_are_not_installed_are_named_in_one_line(submitted, monkeypatch):
    folder = submitted({'package.xml': XML.replace('std_msgs', 'rumba_msgs').replace(
        '</package>', '<depend>costmap_3d</depend><depend>eigen</depend><test_depend>a_test</test_depend></package>')})
    assert of_submission(folder, [CLEANER]) == [
        'sweeper/package.xml names costmap_3d, rumba_msgs, which are not installed here: look at the spelling; use '
        'only packages that the exercise names']
    submitted({'package.xml': XML.replace('std_msgs', 'rumba_msgs')})
    assert of_submission(folder, [CLEANER]) == [
        'sweeper/package.xml names rumba_msgs, which is not installed here: look at the spelling; did you mean '
        'rumba_msg?']
    monkeypatch.setattr(installed_packages, 'names', set)
    assert of_submission(folder, [CLEANER]) == []


def test_the_installed_packages_are_those_of_the_environment(tmp_path, monkeypatch):
    monkeypatch.undo()
    for path in ('one/share/a_msgs/package.xml', 'src/b_msgs/package.xml', 'src/clone/c_msgs/package.xml',
                 'two/share/d_msgs/cmake/d_msgsConfig.cmake'):
        (tmp_path / path).parent.mkdir(parents=True)
        (tmp_path / path).write_text('')
    monkeypatch.setenv('CMAKE_PREFIX_PATH', f'{tmp_path}/one:{tmp_path}/two')
    monkeypatch.setenv('ROS_PACKAGE_PATH', f'{tmp_path}/src')
    assert installed_packages.names() >= {'a_msgs', 'b_msgs', 'c_msgs', 'd_msgs'}


def test_files_that_are_no_regular_files_or_too_large_are_never_opened(submitted, tmp_path):
    secret = tmp_path.parent / f'{tmp_path.name}.secret'
    secret.write_text('#!secret\n')
    folder = submitted({'large': b'import rospy\n' + bytes(MOST_BYTES)})
    os.mkfifo(folder / 'sweeper' / 'fifo')
    os.symlink('/dev/zero', folder / 'sweeper' / 'device')
    os.symlink(secret, folder / 'sweeper' / 'link')
    os.symlink('.', folder / 'sweeper' / 'round')
    with socket.socket(socket.AF_UNIX) as server:
        here = os.getcwd()
        os.chdir(folder)  # the path of a socket is short
        try:
            server.bind('sweeper/socket')
        finally:
            os.chdir(here)
        names = ('large', 'fifo', 'device', 'link', 'socket')
        assert of_submission(folder, [Wanted('sweeper', name) for name in names]) == []


def test_files_with_any_name_can_be_told(submitted):
    folder = submitted({'scripts/cleaner': None, 'scripts/README.md': ''})
    path = os.fsencode(folder / 'sweeper' / 'scripts') + b'/clea\xff\x1b[2Jner'
    with open(path, 'w', encoding='utf-8') as file:
        file.write(SCRIPT)
    [told] = of_submission(folder, [CLEANER])
    assert told.isprintable() and 'but sweeper/scripts/clea\\xff\\x1b[2Jner: rename it' in told


@pytest.mark.parametrize('name', ['package.xml', 'CMakeLists.txt', 'scripts/cleaner'])
@pytest.mark.parametrize('piece', ['a', 'a(', '<a>', '<name>', '#!', '\n', ' ', 'import ', 'from a.', 'add_executable(',
                                   '\0', '(', '\u20ac'])
def test_a_megabyte_of_anything_is_read_within_seconds(submitted, name, piece):
    began = time.process_time()
    data = piece.encode()
    assert len(of_submission(submitted({name: data * (MOST_BYTES // len(data))}), [CLEANER])) <= MOST
    assert time.process_time() - began < 10.0


@pytest.mark.parametrize('text, shown', [
    ('grün', 'grün'), ('a\r\n\tb', 'a\\r\\n\\tb'), ('\x1b]0;title\x07', '\\x1b]0;title\\x07'), ('\udcff', '\\xff'),
    ('\x9b31m', '\\x9b31m'), ('\u202eevil', '\\u202eevil'), ('\ud800', '\\ud800'), ('a' * 200, 'a' * 200),
    ('a' * 201, 'a' * 200 + '...'), ('\0' * 1_000_000, '\\x00' * 50 + '...')])
def test_what_is_quoted_can_be_printed(text, shown):
    assert printable(text) == shown


def test_a_folder_that_is_left_out_when_copying_is_not_looked_at(submitted):
    folder = submitted()
    for name in ('.git', 'build', 'devel'):
        (folder / name).mkdir()
        (folder / name / 'package.xml').write_text('')
    assert of_submission(pathlib.Path(folder), [CLEANER]) == []
