"""What is on disk, what CMake generates and what the manifest promises are the same."""

import re
from typing import Dict, List

import catkin_pkg.package
import pytest
from definitions import FILES, NAME, PACKAGE, parts

MANIFEST = catkin_pkg.package.parse_package(str(PACKAGE))
BUILD_FILE = (PACKAGE / 'CMakeLists.txt').read_text()
CALLS: Dict[str, List[str]] = {
    name: words.split() for name, words in re.findall(r'^(\w+)\(([^()]*)\)', BUILD_FILE, re.MULTILINE)}
USED = {field_type.split('/')[0] for path in FILES for part in parts(path) for field_type in part.spec.types
        if '/' in field_type} - {NAME} | {'actionlib_msgs'}


@pytest.mark.parametrize('call, suffix', [
    ('add_message_files', '.msg'), ('add_service_files', '.srv'), ('add_action_files', '.action')])
def test_every_file_is_registered_and_every_registered_file_exists(call, suffix):
    keyword, *registered = CALLS[call]
    assert keyword == 'FILES'
    assert registered == [path.name for path in FILES if path.suffix == suffix]


def test_every_folder_holds_definitions_of_its_kind_alone():
    assert {(path.parent.name, path.suffix) for path in FILES} == {
        ('msg', '.msg'), ('srv', '.srv'), ('action', '.action')}


def test_every_package_in_use_is_found_generated_with_and_exported():
    assert set(CALLS['find_package'][3:]) == USED | {'message_generation'}
    assert set(CALLS['generate_messages'][1:]) == USED
    assert set(CALLS['catkin_package'][1:]) == USED | {'message_runtime'}


@pytest.mark.parametrize('kind, also', [
    ('build_depends', 'message_generation'),
    ('build_export_depends', 'message_runtime'),
    ('exec_depends', 'message_runtime'),
])
def test_every_package_in_use_is_declared(kind, also):
    assert {dependency.name for dependency in getattr(MANIFEST, kind)} == USED | {also}


def test_the_manifest_is_of_format_3_and_complains_of_nothing():
    warnings = []
    manifest = catkin_pkg.package.parse_package(str(PACKAGE), warnings=warnings)
    assert (manifest.package_format, warnings) == (3, [])
